#include "cairn/geometry/camera.h"

#include <gmock/gmock.h>

#include <limits>
#include <opencv2/calib3d.hpp>

#include "cairn/geometry/error.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::Random;

// TUM RGB-D, freiburg1.
Camera freiburg1() {
  return Camera(Camera::Model::kRadialTangential, 640, 480,
                {517.306408, 516.469215, 318.643040, 255.313989},
                {0.262383, -0.953104, -0.005358, 0.002628, 1.163314});
}

// A wide fisheye: 85 degrees off the axis still project into the picture's plane.
Camera fisheye() {
  return Camera(Camera::Model::kKannalaBrandt, 512, 512, {190.978, 190.973, 254.931, 256.897},
                {0.00348, 0.000715, -0.00205, 0.000203});
}

Vector2d pixel_in(const Camera& camera, Random& random) {
  const double x = random.uniform(0, camera.width() - 1),
               y = random.uniform(0, camera.height() - 1);
  return {x, y};
}

std::string refusal(Camera::Model model, int width, int height, const Pinhole& pinhole,
                    const std::array<double, 5>& distortion = {}) {
  try {
    Camera(model, width, height, pinhole, distortion);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::kUsage);
    return error.what();
  }
  return "accepted";
}

TEST(Camera, ProjectUndoesUnprojectAllOverAFreiburgPicture) {
  const Camera camera = freiburg1();
  for (int y = 0; y < 480; y += 5) {
    for (int x = 0; x < 640; x += 5) {
      const Vector2d pixel(x, y);
      const Vector3d ray = camera.unproject(pixel);
      EXPECT_NEAR(ray.norm(), 1, 1e-12);
      EXPECT_LT((camera.project(ray * 3.7) - pixel).norm(), 1e-8) << x << ' ' << y;
    }
  }
}

TEST(Camera, UnprojectUndoesProjectUpTo85DegreesOfAFisheye) {
  const Camera camera = fisheye();
  Random random(1);
  for (double degrees = 0; degrees <= 85; degrees += 0.5) {
    const double theta = degrees * M_PI / 180, phi = random.uniform(-M_PI, M_PI);
    const Vector3d ray(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                       std::cos(theta));
    EXPECT_LT((camera.unproject(camera.project(ray * 2.5)) - ray).norm(), 1e-10) << degrees;
  }
}

TEST(Camera, ProjectsAFisheyePointBesideTheCamera) {
  const Vector2d pixel = fisheye().project({1, 0, -0.05});  // 93 degrees off the axis
  EXPECT_TRUE(pixel.allFinite());
  EXPECT_GT(pixel.x(), 500);
}

TEST(Camera, AgreesWithOpenCV) {
  Random random(2);
  for (const Camera& camera : {freiburg1(), fisheye()}) {
    const Pinhole& p = camera.pinhole();
    const cv::Matx33d K(p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1);
    const auto& d = camera.distortion();
    for (int trial = 0; trial < 50; ++trial) {
      const Vector3d X = camera.unproject(pixel_in(camera, random)) * random.uniform(1, 5);
      if (X.z() < 0.3) continue;
      const std::vector<cv::Point3d> object = {{X.x(), X.y(), X.z()}};
      const cv::Vec3d zero(0, 0, 0);
      std::vector<cv::Point2d> pixels;
      if (camera.model() == Camera::Model::kRadialTangential) {
        cv::projectPoints(object, zero, zero, K, cv::Mat(5, 1, CV_64F, const_cast<double*>(&d[0])),
                          pixels);
      } else {
        cv::fisheye::projectPoints(object, pixels, zero, zero, K,
                                   cv::Vec4d(d[0], d[1], d[2], d[3]));
      }
      EXPECT_LT((camera.project(X) - Vector2d(pixels[0].x, pixels[0].y)).norm(), 1e-9);
    }
  }
}

TEST(Camera, UndistortsToWhereThePinholeSeesTheRay) {
  Random random(3);
  const Camera camera = freiburg1();
  for (int trial = 0; trial < 50; ++trial) {
    const Vector2d pixel = pixel_in(camera, random);
    const Vector3d ray = camera.pinhole().unproject(camera.undistort(pixel)).normalized();
    EXPECT_LT((ray - camera.unproject(pixel)).norm(), 1e-12);
  }
}

TEST(Camera, DoesNotMirrorARayThatNoPinholeSees) {
  const Camera camera = fisheye();
  EXPECT_FALSE(camera.undistort(camera.project({1, 0, -0.05})).allFinite());
  EXPECT_TRUE(camera.undistort(camera.project({1, 0, 0.05})).allFinite());
}

TEST(Camera, WithoutDistortionIsThePinhole) {
  const Camera camera(Camera::Model::kRadialTangential, 640, 480, testing::kCamera);
  const Vector3d X(0.3, -0.2, 2);
  EXPECT_EQ(camera.project(X), testing::kCamera.project(X));
  EXPECT_EQ(camera.undistort({12.5, 400}), Vector2d(12.5, 400));
}

TEST(Camera, ResizedSeesTheSameRayAtTheSamePlaceOfThePicture) {
  const Camera camera = freiburg1(), half = camera.resized(320, 240);
  const Vector3d ray = camera.unproject({100, 50});
  // Pixel centres are integers, so the place of x in the picture is (x + 0.5) / width.
  EXPECT_LT((half.project(ray) - Vector2d(100.5 / 2 - 0.5, 50.5 / 2 - 0.5)).norm(), 1e-8);
}

TEST(Camera, RefusesBadCalibrationsInWords) {
  const auto model = Camera::Model::kRadialTangential;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(model, 640, 480, {-500, 500, 320, 240}), HasSubstr("fx is -500"));
  EXPECT_THAT(refusal(model, 640, 480, {500, 0, 320, 240}), HasSubstr("must be positive"));
  EXPECT_THAT(refusal(model, 640, 480, {500, 500, 700, 240}), HasSubstr("principal point"));
  EXPECT_THAT(refusal(model, 640, 480, {500, 500, nan, 240}), HasSubstr("finite"));
  EXPECT_THAT(refusal(model, 640, 480, {500, 500, 320, 240}, {0.1, nan}), HasSubstr("distortion"));
  EXPECT_THAT(refusal(model, 0, 480, {500, 500, 320, 240}), HasSubstr("too small"));
  EXPECT_EQ(refusal(model, 640, 480, {500, 500, 320, 240}), "accepted");
}

TEST(Camera, SurvivesPixelsThatAreNotNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Camera& camera : {freiburg1(), fisheye()}) {
    EXPECT_FALSE(camera.unproject({nan, 3}).allFinite());
    camera.unproject({1e300, -1e300});
    camera.project({nan, nan, 1});
    camera.project({0, 0, 0});
  }
}

}  // namespace
}  // namespace cairn
