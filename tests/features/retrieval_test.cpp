#include "cairn/features/retrieval.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "cairn/features/orb_extractor.h"
#include "textures.h"

namespace cairn {
namespace {

using Id = KeyframeRetrieval::Id;

Features features_of(const cv::Mat& image) {
  OrbExtractor extractor({});
  Features features;
  extractor.extract(image, features);
  return features;
}

Features textured(unsigned seed) { return features_of(random_texture({480, 360}, seed)); }

/// The same scene moved by some pixels.
Features textured_and_moved(unsigned seed) {
  const cv::Mat image = random_texture({480, 360}, seed);
  const cv::Mat move = (cv::Mat_<double>(2, 3) << 0.99, 0.05, 6.3, -0.05, 0.99, 11.8);
  cv::Mat moved;
  cv::warpAffine(image, moved, move, image.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
  return features_of(moved);
}

TEST(KeyframeRetrieval, FindsTheSceneAgain) {
  KeyframeRetrieval retrieval;
  for (Id id = 0; id < 20; ++id) retrieval.add(id, textured(id));
  for (Id id = 0; id < 20; ++id) {
    const auto found = retrieval.query(textured_and_moved(id), 3);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].id, id);
    const float next = found.size() > 1 ? found[1].score : 0;
    EXPECT_GT(found[0].score, 2 * next);
  }
}

TEST(KeyframeRetrieval, ForgetsWhatIsRemovedAndKeepsTheRest) {
  KeyframeRetrieval retrieval, never_had_them;
  std::vector<Features> scenes;
  for (unsigned seed = 0; seed < 8; ++seed) scenes.push_back(textured(seed));
  // Enough to make the index compact itself.
  for (Id id = 0; id < 200; ++id) retrieval.add(id, scenes[id % scenes.size()]);
  for (Id id = 0; id < 200; ++id) {
    if (id % 8 == 3) {
      never_had_them.add(id, scenes[3]);
    } else {
      retrieval.remove(id);
    }
  }
  EXPECT_EQ(retrieval.size(), 25U);
  EXPECT_FALSE(retrieval.contains(4));
  EXPECT_TRUE(retrieval.contains(3));
  const auto found = retrieval.query(scenes[3], 100);
  ASSERT_EQ(found.size(), 25U);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].id, 8 * i + 3);
  EXPECT_EQ(never_had_them.query(scenes[3], 100).size(), found.size());
  retrieval.remove(12345);
  retrieval.clear();
  EXPECT_EQ(retrieval.size(), 0U);
  EXPECT_TRUE(retrieval.query(scenes[3], 100).empty());
}

TEST(KeyframeRetrieval, ReplacesAPictureThatIsAddedAgain) {
  KeyframeRetrieval retrieval;
  retrieval.add(7, textured(1));
  retrieval.add(7, textured(2));
  retrieval.add(8, textured(3));
  EXPECT_EQ(retrieval.size(), 2U);
  EXPECT_EQ(retrieval.query(textured(2), 1).at(0).id, 7U);
  EXPECT_LT(retrieval.query(textured(2), 9).size(), 3U);
}

TEST(KeyframeRetrieval, TakesPicturesWithoutFeatures) {
  KeyframeRetrieval retrieval;
  EXPECT_TRUE(retrieval.query({}, 5).empty());
  retrieval.add(1, {});
  retrieval.add(2, textured(1));
  EXPECT_TRUE(retrieval.query({}, 5).empty());
  EXPECT_EQ(retrieval.query(textured(1), 5).size(), 1U);
}

TEST(KeyframeRetrieval, FindsFramesOfARealRoomThatAreNearInTime) {
  const char* const given = std::getenv("CAIRN_DATA");
  const std::filesystem::path data = given != nullptr ? given : CAIRN_SOURCE_DIR "/../shared/data";
  const auto pictures = data / "redkitchen" / "rgb";
  if (!std::filesystem::is_directory(pictures)) {
    GTEST_SKIP() << "no pictures in " << pictures << "; set CAIRN_DATA to the data folder";
  }
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(pictures)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  constexpr std::size_t kEvery = 10;
  KeyframeRetrieval retrieval;
  const auto features_at = [&](std::size_t i) {
    return features_of(cv::imread(files[i], cv::IMREAD_GRAYSCALE));
  };
  for (std::size_t i = 0; i < files.size(); i += kEvery) {
    retrieval.add(static_cast<Id>(i), features_at(i));
  }
  int near = 0, asked = 0;
  for (std::size_t i = 2; i < files.size(); i += 5 * kEvery) {
    const auto found = retrieval.query(features_at(i), 1);
    ASSERT_FALSE(found.empty());
    near += std::abs(static_cast<int>(found[0].id) - static_cast<int>(i)) <= 3 * int(kEvery);
    ++asked;
  }
  EXPECT_GT(asked, 3);
  EXPECT_GE(near, 0.9 * asked);
  EXPECT_LT(retrieval.memory() / retrieval.size(), 20U * 1024 + (5U << 20) / retrieval.size());
}

}  // namespace
}  // namespace cairn
