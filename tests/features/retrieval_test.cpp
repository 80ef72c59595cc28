#include "cairn/features/retrieval.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "cairn/features/orb_extractor.h"
#include "textures.h"

namespace cairn {
namespace {

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

std::vector<SimilarPicture> ranked(const Features& wanted, const std::vector<Features>& pictures,
                                   std::size_t max_results) {
  std::vector<const Features*> pointers;
  for (const Features& picture : pictures) pointers.push_back(&picture);
  return rank_by_appearance(wanted, pointers, max_results);
}

TEST(RankByAppearance, FindsTheSceneAgain) {
  std::vector<Features> scenes;
  for (unsigned seed = 0; seed < 20; ++seed) scenes.push_back(textured(seed));
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto found = ranked(textured_and_moved(seed), scenes, 3);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].index, seed);
    const float next = found.size() > 1 ? found[1].score : 0;
    EXPECT_GT(found[0].score, 2 * next);
  }
}

TEST(RankByAppearance, PutsEqualPicturesInOrderAndKeepsToTheNumberAsked) {
  std::vector<Features> pictures;
  for (unsigned i = 0; i < 40; ++i) pictures.push_back(textured(i % 4));
  const auto found = ranked(pictures[3], pictures, 8);
  ASSERT_EQ(found.size(), 8U);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].index, 4 * i + 3);
}

TEST(RankByAppearance, TakesPicturesWithoutFeatures) {
  EXPECT_TRUE(ranked({}, {}, 5).empty());
  const std::vector<Features> pictures = {{}, textured(1)};
  EXPECT_TRUE(ranked({}, pictures, 5).empty());
  const auto found = ranked(textured(1), pictures, 5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].index, 1U);
}

TEST(RankByAppearance, FindsFramesOfARealRoomThatAreNearInTime) {
  const char* const given = std::getenv("CAIRN_DATA");
  const std::filesystem::path data = given != nullptr ? given : CAIRN_SOURCE_DIR "/../shared/data";
  const auto folder = data / "redkitchen" / "rgb";
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no pictures in " << folder << "; set CAIRN_DATA to the data folder";
  }
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  constexpr std::size_t kEvery = 10;
  std::vector<Features> pictures;
  const auto features_at = [&](std::size_t i) {
    return features_of(cv::imread(files[i], cv::IMREAD_GRAYSCALE));
  };
  for (std::size_t i = 0; i < files.size(); i += kEvery) {
    pictures.push_back(features_at(i));
  }
  int near = 0, asked = 0;
  for (std::size_t i = 2; i < files.size(); i += 5 * kEvery) {
    const auto found = ranked(features_at(i), pictures, 1);
    ASSERT_FALSE(found.empty());
    near += std::abs(static_cast<int>(found[0].index * kEvery) - static_cast<int>(i)) <=
            3 * int(kEvery);
    ++asked;
  }
  EXPECT_GT(asked, 3);
  EXPECT_GE(near, 0.9 * asked);
}

}  // namespace
}  // namespace cairn
