// The shipped cards on recorded pictures; skipped where networks or pictures are not there.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cairn/perception/plane_detectors.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

// $`variable`, or shared/`name` beside the project.
fs::path folder_of(const char* variable, const std::string& name) {
  if (const char* folder = std::getenv(variable)) return folder;
  return fs::path(CAIRN_SOURCE_DIR).parent_path() / "shared" / name;
}

fs::path models() { return folder_of("CAIRN_MODELS", "models"); }
fs::path kitchen() { return folder_of("CAIRN_DATA", "data") / "redkitchen"; }

#define SKIP_WITHOUT_FILES()                                                            \
  if (!fs::exists(models() / "meter_xxs_nyu_192x256.onnx") || !fs::exists(kitchen())) { \
    GTEST_SKIP() << "no networks in " << models() << " or no pictures in " << kitchen() \
                 << "; set CAIRN_MODELS and CAIRN_DATA to the folders of both";         \
  }

// redkitchen's calibration.yaml.
const Camera kColour(Camera::Model::kRadialTangential, 640, 480, {525, 525, 320, 240});
const Pinhole kDepth{146.25, 146.25, 80, 60};

NetworkCard card(const std::string& name) { return read_network_card(find_card(name), models()); }
cv::Mat picture(const std::string& time) {
  return cv::imread((kitchen() / "rgb" / (time + ".jpg")).string());
}

// What the networks' reference decoder (check_models.py beside them, OpenCV 4.6) says of this
// picture: METER's metres on its own grid, shares of the picture that MOSAIC gives to labels.
TEST(RealPictures, DepthIsThatOfTheReferenceDecoder) {
  SKIP_WITHOUT_FILES();
  const NetworkCard meter = card("meter_xxs_nyu");
  SceneNetwork network({meter});
  const cv::Mat depth = network.look(picture("0.633333"), {64, 48}).depth / meter.factor;
  EXPECT_NEAR(cv::mean(depth)[0], 3.0200, 0.003);
  EXPECT_NEAR(depth.at<float>(24, 32), 2.4261, 0.005);
  EXPECT_NEAR(depth.at<float>(5, 5), 3.6439, 0.005);
  double least, most;
  cv::minMaxLoc(depth, &least, &most);
  EXPECT_NEAR(least, 1.6107, 0.005);
  EXPECT_NEAR(most, 5.3971, 0.01);
}

TEST(RealPictures, LabelsAreThoseOfTheReferenceDecoder) {
  SKIP_WITHOUT_FILES();
  const NetworkCard mosaic = card("mosaic_ade20k31");
  SceneNetwork network({mosaic});
  const cv::Mat labels = network.look(picture("0.633333"), {640, 480}).labels;
  const auto share = [&](const std::string& name) {
    const auto at = std::find(mosaic.labels.begin(), mosaic.labels.end(), name);
    return cv::countNonZero(labels == int(at - mosaic.labels.begin())) / (640. * 480);
  };
  EXPECT_NEAR(share("wall"), 0.2535, 0.002);
  EXPECT_NEAR(share("floor"), 0.2307, 0.002);
  EXPECT_NEAR(share("cabinet"), 0.1589, 0.002);
  EXPECT_NEAR(share("table"), 0.2883, 0.002);
  EXPECT_NEAR(share("chair"), 0.0387, 0.002);
}

// Measured depth on the detector's grid, brought to the colour camera by the focal lengths only:
// the offset between the two lenses is not published.
OrganizedCloud measured_cloud(const std::string& time) {
  const cv::Mat raw =
      cv::imread((kitchen() / "depth" / (time + ".png")).string(), cv::IMREAD_UNCHANGED);
  OrganizedCloud cloud{viewing_rays(kColour, {128, 96}), cv::Mat_<float>(96, 128, 0.f), {}};
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 128; ++u) {
      const Eigen::Vector2d p = kDepth.project(cloud.ray(v, u));
      const cv::Point pixel(cvRound(p.x()), cvRound(p.y()));
      if (!cv::Rect({0, 0}, raw.size()).contains(pixel)) continue;
      cloud.depth(v, u) = float(raw.at<std::uint16_t>(pixel) / 5000.0);
    }
  }
  return cloud;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Median of measured / predicted depth in a picture.
double scale_of(const OrganizedCloud& measured, const cv::Mat_<float>& predicted) {
  std::vector<double> ratios;
  for (int i = 0; i < predicted.rows * predicted.cols; ++i) {
    const float z = measured.depth(i / predicted.cols, i % predicted.cols);
    if (z > 0) ratios.push_back(z / predicted(i / predicted.cols, i % predicted.cols));
  }
  return ratios.empty() ? 0 : median(ratios);
}

struct Comparison {
  int planes = 0, compared = 0;
  std::vector<double> angles_deg, offsets, in_sigmas;
};

void compare(const DetectedFrame& frame, const std::string& time, Comparison& result) {
  const OrganizedCloud measured = measured_cloud(time);
  const double scale = scale_of(measured, frame.depth);
  PlaneHypothesisOptions sensor;
  sensor.noise = {0.01, 0.005};
  result.planes += int(frame.planes.size());
  for (const DetectedPlane& plane : frame.planes) {
    cv::Mat small;
    cv::resize(plane.mask, small, {128, 96}, 0, 0, cv::INTER_AREA);
    GridRegion all = region_of_mask(small > 127), known;
    for (const cv::Point& p : all) {
      if (measured.depth(p) > 0) known.push_back(p);
    }
    if (known.size() < all.size() / 2) continue;
    const auto truth = fit_region(measured, known, sensor);
    if (!truth || truth->inlier_share < 0.6) continue;
    Eigen::Vector3d ray = Eigen::Vector3d::Zero();
    for (const cv::Point& p : known) ray += measured.ray(p.y, p.x) / double(known.size());
    Eigen::Vector4d scaled = plane.plane;
    scaled[3] *= scale;
    const double cosine = scaled.head<3>().dot(truth->plane.head<3>());
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    ++result.compared;
    result.angles_deg.push_back(angle * 180 / M_PI);
    result.in_sigmas.push_back(angle / plane.sigma_angle);
    result.offsets.push_back(relative_offset(scaled, truth->plane, ray));
  }
}

TEST(RealPictures, PlanesAgreeWithMeasuredDepth) {
  SKIP_WITHOUT_FILES();
  PlaneDetectorSources sources;
  sources.models = models();
  const auto detector = make_plane_detector("network", kColour, sources);
  Comparison result;
  for (const std::string time : {"0.633333", "4.800000", "8.000000", "10.633333", "13.133333",
                                 "16.000000", "20.633333", "24.000000", "29.800000", "32.000000"}) {
    const DetectedFrame frame = detector->detect({picture(time), {}, std::stod(time)});
    EXPECT_EQ(frame.problem, "");
    compare(frame, time, result);
    if (time == "0.633333" || time == "13.133333" || time == "29.800000") {
      EXPECT_GE(frame.planes.size(), 2u) << time;
    }
  }
  ASSERT_GE(result.compared, 5);
  std::cout << result.planes << " planes, " << result.compared << " compared: median angle "
            << median(result.angles_deg) << " deg, median offset " << 100 * median(result.offsets)
            << " % of the depth, median of angle / sigma " << median(result.in_sigmas) << "\n";
  EXPECT_LT(median(result.angles_deg), 30);
  EXPECT_LT(median(result.offsets), 0.2);
}

}  // namespace
}  // namespace cairn
