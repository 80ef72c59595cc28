#include "cairn/perception/plane_detectors.h"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>
#include <set>

#include "cairn/geometry/error.h"
#include "cairn/perception/recorded_perception.h"
#include "network_folder.h"
#include "room_maps.h"

namespace cairn {
namespace {

using testing::angle_deg;
using ::testing::HasSubstr;
using testing::kRoomCamera;
using testing::kTinyInput;
using testing::nearest_plane;
using testing::NetworkFolder;
using testing::RoomMaps;
using testing::TinyOnnx;

const cv::Size kGrid(128, 96), kPicture(640, 480);
const std::vector<std::string> kLabels = {"", "wall", "floor", "ceiling"};

// The room as networks without errors would see it.
struct SeenRoom {
  cv::Mat_<cv::Vec3f> rays = viewing_rays(kRoomCamera, kGrid);
  RoomMaps room{rays};
  SceneMaps maps{room.depth, {}, labels(), ""};
  cv::Mat bgr{kPicture, CV_8UC3, cv::Scalar::all(128)};

  cv::Mat_<uchar> labels() const {
    const uchar of_owner[] = {0, 1, 1, 1, 2, 3};
    cv::Mat_<uchar> result(kGrid);
    for (int i = 0; i < kGrid.area(); ++i)
      result(i / kGrid.width, i % kGrid.width) =
          of_owner[room.owner(i / kGrid.width, i % kGrid.width)];
    return result;
  }
  std::vector<DetectedPlane> detect() const {
    return planes_of_maps(maps, kLabels, rays, bgr, NetworkPlaneOptions());
  }
};

double iou(const cv::Mat& a, const cv::Mat& b) {
  return double(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

void expect_room(const std::vector<DetectedPlane>& found, double max_angle_deg) {
  const RoomMaps truth(viewing_rays(kRoomCamera, kPicture));
  std::set<std::size_t> which;
  for (const DetectedPlane& plane : found) {
    const std::size_t i = nearest_plane(truth, plane.plane);
    EXPECT_LT(angle_deg(plane.plane, truth.planes[i]), max_angle_deg);
    EXPECT_NEAR(plane.plane[3] / truth.planes[i][3], 1, 0.01);
    EXPECT_EQ(plane.mask.size(), kPicture);
    EXPECT_GT(iou(plane.mask, truth.owner == int(i + 1)), 0.8);
    EXPECT_GT(plane.score, 0);
    EXPECT_LE(plane.score, 1);
    EXPECT_TRUE(which.insert(i).second);
  }
  EXPECT_EQ(which.size(), 5u);
}

TEST(NetworkPlanes, AreThoseOfAnExactRoom) {
  const SeenRoom seen;
  const auto found = seen.detect();
  expect_room(found, 1);
  for (const DetectedPlane& plane : found) {
    const std::size_t i = nearest_plane(seen.room, plane.plane);
    EXPECT_EQ(plane.label, i < 3 ? "wall" : i == 3 ? "floor" : "ceiling");
  }
}

TEST(NetworkPlanes, AreFoundByColourWithoutLabels) {
  SeenRoom seen;
  seen.maps.labels.release();
  const RoomMaps large(viewing_rays(kRoomCamera, kPicture));
  for (int i = 1; i <= 5; ++i) {
    seen.bgr.setTo(cv::Scalar(40 * i, 255 - 30 * i, 60 * (i % 3)), large.owner == i);
  }
  const auto found = seen.detect();
  expect_room(found, 1);
  for (const DetectedPlane& plane : found) EXPECT_EQ(plane.label, "plane");
}

TEST(NetworkPlanes, AreRefusedWhereNormalsSayOtherwise) {
  SeenRoom seen;
  const Eigen::Matrix3f R =
      Eigen::AngleAxisf(0.5f, Eigen::Vector3f(1, 1, 1).normalized()).toRotationMatrix();
  seen.maps.normals = cv::Mat_<cv::Vec3f>(kGrid);
  for (int v = 0; v < kGrid.height; ++v) {
    for (int u = 0; u < kGrid.width; ++u) {
      const Eigen::Vector3f n =
          R * seen.room.planes[seen.room.owner(v, u) - 1u].head<3>().cast<float>();
      seen.maps.normals(v, u) = {n.x(), n.y(), n.z()};
    }
  }
  EXPECT_TRUE(seen.detect().empty());
}

TEST(NetworkPlanes, AreNoneWhereNoLabelIsPlanarOrNothingIsKnown) {
  SeenRoom seen;
  seen.maps.labels = cv::Mat_<uchar>(kGrid, uchar(0));
  EXPECT_TRUE(seen.detect().empty());
  seen.maps.labels = seen.labels();
  seen.maps.depth = cv::Mat_<float>(kGrid, 0.f);
  EXPECT_TRUE(seen.detect().empty());
}

TEST(NetworkPlanes, AreTheSameEachTime) {
  const SeenRoom seen;
  const auto first = seen.detect(), second = seen.detect();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].plane, second[i].plane);
    EXPECT_EQ(cv::countNonZero(first[i].mask != second[i].mask), 0);
  }
}

TEST(NetworkPlanes, DropAPictureWhoseNetworkFails) {
  const NetworkFolder folder;
  TinyOnnx(24, 32).maps("depth", {-1, 0, 0}, {200}, "Sqrt").write(folder.path() / "tiny.onnx");
  PlaneDetectorSources sources;
  sources.network_cards = {folder.write("card.yaml", testing::depth_card()).string()};
  sources.models = folder.path();
  const auto detector = make_plane_detector("network", kRoomCamera, sources);
  const DetectedFrame bad =
      detector->detect({cv::Mat(kPicture, CV_8UC3, cv::Scalar(0, 0, 255)), {}, 3.5});
  EXPECT_EQ(bad.timestamp, 3.5);
  EXPECT_THAT(bad.problem, HasSubstr("not finite"));
  EXPECT_TRUE(bad.planes.empty());
  const DetectedFrame good =
      detector->detect({cv::Mat(kPicture, CV_8UC3, cv::Scalar(0, 0, 90)), {}, 4});
  EXPECT_EQ(good.problem, "");
  EXPECT_EQ(good.depth.type(), CV_32F);
  EXPECT_EQ(good.sigma_scale, NetworkCard().factor_sigma);
}

TEST(RgbdPlanes, AreThoseOfAnExactRoom) {
  const RoomMaps room(viewing_rays(kRoomCamera, {320, 240}));
  const auto detector = make_plane_detector("rgbd", kRoomCamera);
  const cv::Mat bgr(kPicture, CV_8UC3, cv::Scalar());
  expect_room(detector->detect({bgr, room.depth, 0}).planes, 0.5);
}

TEST(RgbdPlanes, AreNotOnASphere) {
  const auto rays = viewing_rays(kRoomCamera, kGrid);
  cv::Mat_<float> depth(kGrid, 0.f);
  for (int v = 0; v < kGrid.height; ++v) {
    for (int u = 0; u < kGrid.width; ++u) {
      const cv::Vec3f r = rays(v, u);  // |z r - (0, 0, 2)| = 0.7
      const float a = r.dot(r), D = 16 - 4 * a * (4 - 0.49f);
      if (D > 0) depth(v, u) = (4 - std::sqrt(D)) / (2 * a);
    }
  }
  const auto detector = make_plane_detector("rgbd", kRoomCamera);
  for (const DetectedPlane& plane : detector->detect({{}, depth, 0}).planes) {
    EXPECT_LT(cv::countNonZero(plane.mask), 0.3 * cv::countNonZero(depth));
  }
}

// Half of the corners at the rim of a thing fall on what is behind it.
TEST(RgbdPlanes, ComeWithDepthThatSaysNothingWhereItJumps) {
  cv::Mat_<float> depth(480, 640, 4.F);
  depth(cv::Rect(200, 200, 100, 100)) = 2.F;
  depth(cv::Rect(500, 0, 20, 480)) = 0.F;
  const DetectedFrame frame = make_plane_detector("rgbd", kRoomCamera)->detect({{}, depth, 0});
  ASSERT_EQ(frame.depth.size(), depth.size());
  EXPECT_EQ(frame.depth.at<float>(250, 250), 2.F);
  EXPECT_EQ(frame.depth.at<float>(100, 100), 4.F);
  EXPECT_EQ(frame.depth.at<float>(250, 201), 0.F);
  EXPECT_EQ(frame.depth.at<float>(250, 198), 0.F);
  EXPECT_EQ(frame.depth.at<float>(250, 498), 0.F);
}

TEST(RgbdPlanes, NeedDepthOfThePicturesShape) {
  const auto detector = make_plane_detector("rgbd", kRoomCamera);
  EXPECT_THAT(detector->detect({}).problem, HasSubstr("no measured depth"));
  EXPECT_THAT(detector->detect({{}, cv::Mat(480, 640, CV_16U), 0}).problem, HasSubstr("metres"));
  EXPECT_THAT(detector->detect({{}, cv::Mat(480, 480, CV_32F), 0}).problem, HasSubstr("shape"));
}

TEST(PlanenetPlanes, AreDecodedWithTheirMasks) {
  const NetworkFolder folder;
  // A plane two metres ahead where the picture is red, one below where it is green, an empty slot
  // where it is blue, none elsewhere.
  TinyOnnx(24, 32)
      .rows("planes", {0, 0, 200, 0, 100, 0, 0, 0, 0})
      .maps("masks", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, {-100, -100, -100, 0})
      .write(folder.path() / "tiny.onnx");
  PlaneDetectorSources sources;
  sources.models = folder.path();
  sources.planenet_card = folder
                              .write("card.yaml",
                                     "name: p\nkind: planes\nfile: tiny.onnx\noutput: planes\n"
                                     "masks: masks\nunit: 0.01\n" +
                                         kTinyInput)
                              .string();
  const auto detector = make_plane_detector("planenet", kRoomCamera, sources);
  cv::Mat picture(kPicture, CV_8UC3, cv::Scalar());
  picture.colRange(0, 200) = cv::Scalar(0, 0, 255);
  picture.colRange(200, 400) = cv::Scalar(0, 255, 0);
  picture.colRange(400, 600) = cv::Scalar(255, 0, 0);
  const DetectedFrame frame = detector->detect({picture, {}, 1});
  ASSERT_EQ(frame.planes.size(), 2u);
  for (const DetectedPlane& plane : frame.planes) {
    const bool ahead = plane.plane[2] < -0.5;
    EXPECT_LT((plane.plane - (ahead ? Eigen::Vector4d(0, 0, -1, 2) : Eigen::Vector4d(0, -1, 0, 1)))
                  .norm(),
              1e-5);
    cv::Mat truth(kPicture, CV_8U, cv::Scalar());
    truth.colRange(ahead ? 0 : 200, ahead ? 200 : 400) = 255;
    EXPECT_GT(iou(plane.mask, truth), 0.9);
  }
}

TEST(PlanenetPlanes, RefuseOtherCardsAndShapes) {
  const NetworkFolder folder;
  const auto refusal = [&](const std::string& card) {
    PlaneDetectorSources sources;
    sources.models = folder.path();
    sources.planenet_card = folder.write("card.yaml", card).string();
    try {
      make_plane_detector("planenet", kRoomCamera, sources);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  TinyOnnx(24, 32)
      .rows("planes", {0, 0, 1, 0, 1, 0})
      .maps("masks", std::vector<float>(12, 0.f), {0, 0, 0, 0})
      .maps("depth", {0, 0, 0}, {1})
      .write(folder.path() / "tiny.onnx");
  EXPECT_THAT(refusal(testing::depth_card()), HasSubstr("kind must be planes"));
  EXPECT_THAT(refusal("name: p\nkind: planes\nfile: tiny.onnx\noutput: planes\nmasks: masks\n"
                      "unit: 1\n" +
                      kTinyInput),
              HasSubstr("a map for each of the 2 planes"));
}

TEST(RecordedPlanes, AreThoseOfTheNearestFrame) {
  const NetworkFolder folder;
  std::string lines;
  for (const double time : {2.0, 1.0}) {
    DetectedFrame frame;
    frame.timestamp = time;
    frame.planes.resize(1);
    frame.planes[0].plane = {0, 0, -1, time};
    frame.objects.push_back({{0, 0, 9, 9}, "cup", 0.5, {}, {}});
    lines += to_json_line(frame) + "\n";
  }
  PlaneDetectorSources sources;
  sources.recorded = folder.write("perception.jsonl", lines);
  const auto detector = make_plane_detector("recorded", kRoomCamera, sources);
  const auto offset = [&](double time) {
    const DetectedFrame frame = detector->detect({{}, {}, time});
    EXPECT_EQ(frame.timestamp, time);
    EXPECT_EQ(frame.objects.size(), frame.planes.size());
    return frame.planes.empty() ? 0 : frame.planes[0].plane[3];
  };
  EXPECT_EQ(offset(1.0), 1);
  EXPECT_EQ(offset(2.004), 2);
  EXPECT_EQ(offset(0.997), 1);
  EXPECT_EQ(offset(1.996), 2);
  EXPECT_EQ(offset(1.5), 0);
  EXPECT_EQ(offset(9), 0);
}

TEST(PlaneDetectors, AreMadeByNameAndNeedTheirSources) {
  const auto refusal = [](const std::string& kind, const PlaneDetectorSources& sources = {}) {
    try {
      make_plane_detector(kind, kRoomCamera, sources);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal("lidar"), HasSubstr("give network, rgbd, planenet or recorded"));
  EXPECT_THAT(refusal("planenet"), HasSubstr("needs a card"));
  EXPECT_THAT(refusal("recorded"), HasSubstr("needs a file"));
  EXPECT_EQ(refusal("rgbd"), "");
  PlaneDetectorSources sources;
  sources.network_cards = {"no_such_card"};
  EXPECT_THAT(refusal("network", sources), HasSubstr("no network card \"no_such_card\""));
}

}  // namespace
}  // namespace cairn
