#include <gmock/gmock.h>

#include "cairn/datasets/depth_registration.h"
#include "cairn/datasets/sequence.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kColour =
    "color: {width: 64, height: 48, fx: 50, fy: 50, cx: 31.5, cy: 23.5}\n";

// Four pictures, 0.1 s apart, from 100 s on.
class MeasuredDepth : public testing::Test {
 protected:
  void SetUp() override {
    std::string list;
    for (int i = 0; i < 4; ++i) {
      const std::string name = "rgb/" + std::to_string(i) + ".png";
      write_picture(folder_ / name, i);
      list += std::to_string(100 + 0.1 * i) + " " + name + "\n";
    }
    folder_.write("rgb.txt", list);
    folder_.write("calibration.yaml", kColour);
    std::filesystem::create_directories(folder_ / "depth");
  }

  void write_depth(const std::string& name, int steps, cv::Size size = {64, 48}) {
    cv::imwrite((folder_ / name).string(), cv::Mat(size, CV_16UC1, cv::Scalar(steps)));
  }

  Sequence open(bool depth = true) {
    OpenOptions options;
    options.depth = depth;
    return open_sequence(folder_.path().string(), options);
  }

  std::vector<SourceFrame> frames(bool depth = true) {
    const Sequence sequence = open(depth);
    std::vector<SourceFrame> all;
    for (SourceFrame frame; sequence.frames->next(frame);) {
      EXPECT_THAT(frame.problem, IsEmpty());
      all.push_back(frame);
      frame.depth = cv::Mat();
    }
    return all;
  }

  TempFolder folder_;
};

TEST_F(MeasuredDepth, IsReadInMetresOnlyOnRequest) {
  write_depth("depth/a.png", 10000);
  folder_.write("depth.txt", "# list\n100 depth/a.png\n");
  const SourceFrame frame = frames()[0];
  ASSERT_EQ(frame.depth.type(), CV_32F);
  ASSERT_EQ(frame.depth.size(), frame.image.size());
  EXPECT_EQ(frame.depth.at<float>(7, 9), 2.F);
  EXPECT_THAT(frame.depth_problem, IsEmpty());

  std::filesystem::remove(folder_ / "depth.txt");
  const SourceFrame mono = frames(false)[0];
  EXPECT_TRUE(mono.depth.empty());
  EXPECT_THAT(mono.depth_problem, IsEmpty());
}

TEST_F(MeasuredDepth, BelongsToTheNearestPictureWithinTwentyMilliseconds) {
  for (int i = 1; i <= 4; ++i) write_depth("depth/" + std::to_string(i) + ".png", 1000 * i);
  folder_.write("depth.txt",
                "100.319 depth/4.png\n99.985 depth/1.png\n100.01 depth/2.png\n100.121 depth/3.png\n"
                "x depth/1.png\n");
  const auto all = frames();
  EXPECT_FLOAT_EQ(all[0].depth.at<float>(0, 0), 0.4F);
  EXPECT_TRUE(all[1].depth.empty());
  EXPECT_THAT(all[1].depth_problem, AllOf(HasSubstr("1.png"), HasSubstr("within 0.02 s")));
  EXPECT_TRUE(all[2].depth.empty());
  EXPECT_FLOAT_EQ(all[3].depth.at<float>(0, 0), 0.8F);
}

TEST_F(MeasuredDepth, ThatCannotBeUsedIsSaidAndLeftOut) {
  folder_.write("depth/cut.png", "\x89PNG\r\n\x1a\n");
  write_depth("depth/small.png", 5000, {32, 24});
  write_picture(folder_ / "depth/colour.png", 1);
  folder_.write("depth.txt",
                "100 depth/cut.png\n100.1 depth/none.png\n100.2 depth/small.png\n"
                "100.3 depth/colour.png\n");
  const auto all = frames();
  const char* const sentences[] = {"cut.png: the picture is cut off",
                                   "none.png: the file is missing",
                                   "small.png: the depth picture is 32x24, and the calibration",
                                   "colour.png: this is no depth picture"};
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(all[i].depth.empty());
    EXPECT_FALSE(all[i].image.empty());
    EXPECT_THAT(all[i].depth_problem, HasSubstr(sentences[i]));
  }
}

TEST_F(MeasuredDepth, ThatIsNotThereIsAnErrorAtTheStart) {
  EXPECT_THAT(error_of(Error::Kind::kInput, [&] { open(); }),
              AllOf(HasSubstr("depth.txt"), HasSubstr("missing")));
  folder_.write("depth.txt", "# nothing\n");
  EXPECT_THAT(error_of(Error::Kind::kInput, [&] { open(); }), HasSubstr("no depth picture"));
  std::filesystem::remove(folder_ / "rgb.txt");
  EXPECT_THAT(error_of(Error::Kind::kInput, [&] { open(); }),
              HasSubstr("the layout images has no measured depth"));
}

TEST_F(MeasuredDepth, OfACameraOfItsOwnIsScaledAndPutIntoTheColourPicture) {
  folder_.write("calibration.yaml",
                std::string(kColour) +
                    "depth:\n  {width: 32, height: 24, fx: 25, fy: 25, cx: 15.5, cy: 11.5,\n   "
                    "scale: 1000, T_color_depth: [1,0,0,0.1, 0,1,0,0, 0,0,1,0.5, 0,0,0,1]}\n");
  write_depth("depth/a.png", 2000, {32, 24});
  write_depth("depth/b.png", 65535, {32, 24});
  folder_.write("depth.txt", "100 depth/a.png\n100.1 depth/b.png\n");
  const auto all = frames();
  ASSERT_EQ(all[0].depth.size(), cv::Size(64, 48));
  EXPECT_EQ(all[0].depth.at<float>(24, 31), 2.5F);
  // Half a metre further away, what filled the picture leaves a rim.
  EXPECT_EQ(all[0].depth.at<float>(24, 1), 0.F);
  EXPECT_EQ(cv::countNonZero(all[1].depth), 0) << "65535 is no measurement";
}

TEST_F(MeasuredDepth, CalibrationWithMistakesIsRefused) {
  folder_.write("depth.txt", "100 depth/a.png\n");
  const auto refusal = [&](const std::string& depth) {
    folder_.write("calibration.yaml", kColour + depth);
    return error_of(Error::Kind::kUsage, [&] { open(); });
  };
  EXPECT_THAT(refusal("depth: {scale: 0}\n"), HasSubstr("calibration.yaml: scale of depth"));
  EXPECT_THAT(refusal("depth: {T_color_depth: [1, 2]}\n"), HasSubstr("sixteen numbers"));
  EXPECT_THAT(refusal("depth: {T_color_depth: [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}\n"),
              HasSubstr("must begin with a rotation"));
  EXPECT_THAT(refusal("depth: {fx: 50}\n"), HasSubstr("fy is missing"));
}

// A slanted plane before a coarse depth camera that is turned and moved.
TEST(DepthRegistration, ShowsAPlaneWithoutHolesWhereTheColourCameraSeesIt) {
  const Camera colour(Camera::Model::kRadialTangential, 320, 240, {260, 260, 160, 120},
                      {0.1, -0.2, 0.001, 0.002, 0});
  const Camera depth(Camera::Model::kRadialTangential, 160, 120, {110, 110, 80, 60});
  const SE3 T_color_depth = SE3::exp((Vector6d() << 0.05, -0.01, 0.02, 0.02, 0.01, 0).finished());
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, 0.3, -1).normalized();  // colour's frame
  const double distance = 2;
  const auto depth_along = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    return (-distance - normal.dot(origin)) / normal.dot(ray);
  };
  cv::Mat_<float> metres(120, 160);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const Eigen::Vector3d ray = depth.unproject({double(u), double(v)});
      metres(v, u) = float(
          depth_along(T_color_depth.translation(), T_color_depth.rotation() * (ray / ray.z())));
    }
  }
  const cv::Mat_<float> seen = DepthRegistration(colour, depth, T_color_depth)(metres);
  ASSERT_EQ(seen.size(), cv::Size(320, 240));
  double error = 0;
  int pixels = 0;
  for (int v = 20; v < 220; ++v) {
    for (int u = 20; u < 300; ++u) {
      ASSERT_GT(seen(v, u), 0) << u << " " << v;
      const Eigen::Vector3d ray = colour.unproject({double(u), double(v)});
      const double truth = depth_along(Eigen::Vector3d::Zero(), ray / ray.z());
      EXPECT_NEAR(seen(v, u) / truth, 1, 0.015) << "a depth pixel is a step";
      error += seen(v, u) / truth - 1;
      ++pixels;
    }
  }
  EXPECT_NEAR(error / pixels, 0, 0.001);
}

TEST(DepthRegistration, ShowsTheNearestOfSeveralAndNothingBehindIt) {
  const Camera camera(Camera::Model::kRadialTangential, 64, 48, {50, 50, 31.5, 23.5});
  cv::Mat_<float> metres(48, 64, 4.F);
  metres(cv::Rect(20, 10, 10, 10)) = 1.F;
  metres(0, 0) = std::numeric_limits<float>::quiet_NaN();
  const SE3 aside(Eigen::Quaterniond::Identity(), {0.1, 0, 0});
  const cv::Mat_<float> seen = DepthRegistration(camera, camera, aside)(metres);
  EXPECT_EQ(seen(15, 30), 1.F) << "five pixels aside";
  EXPECT_EQ(seen(15, 22), 0.F) << "the wall behind was hidden";
  EXPECT_EQ(seen(15, 40), 4.F);
  const SE3 ahead(Eigen::Quaterniond::Identity(), {0, 0, -2});
  const cv::Mat_<float> behind = DepthRegistration(camera, camera, ahead)(metres);
  EXPECT_EQ(behind(15, 25), 0.F);
  EXPECT_EQ(behind(40, 40), 2.F);
}

}  // namespace
}  // namespace cairn
