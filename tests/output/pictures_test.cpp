#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <random>

#include "cairn/output/chart.h"
#include "cairn/output/ellipsoid_outline.h"
#include "cairn/output/label_colour.h"
#include "cairn/output/outline_projection.h"
#include "cairn/output/overlay.h"
#include "cairn/output/plots.h"
#include "cairn/output/video_file.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::HasSubstr;

// Pixels that are nearly of this colour.
int count_of(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat mask;
  cv::inRange(picture, colour - cv::Scalar::all(6), colour + cv::Scalar::all(6), mask);
  return cv::countNonZero(mask);
}

PlotScene room() {
  PlotScene scene;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const double a = 0.02 * i;
    const Eigen::Vector3d t(2 * std::cos(a), 0.1 * std::sin(5 * a), 1.5 * std::sin(a));
    scene.estimate.push_back({100 + i / 30.0, SE3(so3_exp({0, a, 0}), t)});
    scene.truth.push_back(
        {100 + i / 30.0,
         SE3(so3_exp({0, a, 0}), t + 0.03 * Eigen::Vector3d(unit(random), unit(random), 0))});
    if (i % 20 == 0) scene.keyframes.push_back(scene.estimate.back());
  }
  for (int i = 0; i < 4000; ++i) {
    const double y = unit(random);
    scene.points.push_back({4 * unit(random), y, i % 2 == 0 ? 3.0 : 3 * unit(random)});
  }
  scene.points.push_back({1e6, 1e6, -1e6});
  scene.view = PlanView::first_camera();
  scene.title = "room";
  return scene;
}

// A folder to look at what the tests draw, if a person names one.
void show(const char* name, const cv::Mat& picture) {
  if (const char* folder = std::getenv("CAIRN_TEST_PICTURES")) {
    write_png(std::filesystem::path(folder) / name, picture);
  }
}

TEST(NiceTicks, AreRoundAndWithinTheRange) {
  EXPECT_THAT(nice_ticks(0, 1, 5),
              testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT(nice_ticks(-3.2, 7.9, 4), testing::ElementsAre(0.0, 5.0));
  EXPECT_EQ(nice_ticks(2, 2, 4).size(), 1u);
}

TEST(PlanView, FindsUpFromTheCameras) {
  EXPECT_EQ(PlanView::from_cameras({{0, SE3()}}).up_name, "-y");
  EXPECT_EQ(PlanView::from_cameras({{0, SE3()}}).forward_name, "z");
  // A camera that looks along +y of a world with z up, tilted down a little.
  const SE3 level(so3_exp({-M_PI / 2 - 0.3, 0, 0}), Eigen::Vector3d::Zero());
  const PlanView view = PlanView::from_cameras({{0, level}});
  EXPECT_EQ(view.up_name, "z");
  EXPECT_EQ(view.right_name, "x");
  EXPECT_EQ(view.forward_name, "y");
  EXPECT_TRUE(view.right.cross(view.forward).isApprox(view.up));
  EXPECT_EQ(PlanView::from_cameras({}).up_name, "-y");
}

TEST(Plots, ShowEstimateAndTruth) {
  const PlotScene scene = room();
  const cv::Mat plot = draw_trajectory_plot(scene);
  show("trajectory.png", plot);
  EXPECT_GT(count_of(plot, colours::kEstimate), 500);
  EXPECT_GT(count_of(plot, colours::kTruth), 3000);
  PlotScene without = scene;
  without.truth.clear();
  // Smoothed letters have some of this grey, too.
  EXPECT_LT(count_of(draw_trajectory_plot(without), colours::kTruth), 1000);
}

TEST(Plots, LeaveWildPointsOutOfTheMap) {
  const PlotScene scene = room();
  const cv::Mat plot = draw_map_plot(scene);
  show("map.png", plot);
  // The path of 2 m by 1.5 m would be a dot beside a point at a thousand kilometres.
  EXPECT_GT(count_of(plot, colours::kAccent), 500);
}

TEST(Plots, ShowTheErrorOverTime) {
  std::vector<double> times, errors;
  for (int i = 0; i < 200; ++i) {
    times.push_back(i / 10.0 + (i > 100 ? 5 : 0));
    errors.push_back(0.02 + 0.01 * std::sin(i / 9.0));
  }
  const cv::Mat plot = draw_error_plot(times, errors, "room");
  show("error.png", plot);
  EXPECT_GT(count_of(plot, colours::kEstimate), 300);
}

TEST(Plots, TakeScenesWithNothingInThem) {
  EXPECT_FALSE(draw_trajectory_plot({}).empty());
  EXPECT_FALSE(draw_map_plot({}).empty());
  EXPECT_FALSE(draw_error_plot({}, {}, "").empty());
  PlotScene still;
  still.estimate = still.keyframes = {{1e9, SE3()}};
  still.points = {{0, 0, 0}};
  EXPECT_FALSE(draw_trajectory_plot(still).empty());
  EXPECT_FALSE(draw_map_plot(still).empty());
}

TEST(WritePng, WritesAPictureThatReadsBack) {
  TempFolder folder;
  write_png(folder / "a.png", test_picture(3));
  EXPECT_EQ(cv::norm(cv::imread((folder / "a.png").string()), test_picture(3)), 0);
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { write_png(folder / "b.png", {}); }),
              HasSubstr("b.png"));
}

cv::Scalar bgr(const Rgb& colour) {
  return {double(colour.z()), double(colour.y()), double(colour.x())};
}

TEST(LabelColour, IsOneForSurfacesThatAreAlikeAndAnotherForThoseThatAreNot) {
  EXPECT_EQ(label_colour("floor"), label_colour("road"));
  EXPECT_EQ(label_colour("plane"), label_colour("")) << "labels that nobody knows";
  const std::vector<std::string> kinds = {"wall",    "floor", "ceiling", "table",
                                          "cabinet", "door",  "anything"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t k = i + 1; k < kinds.size(); ++k) {
      EXPECT_NE(label_colour(kinds[i]), label_colour(kinds[k])) << kinds[i] << ", " << kinds[k];
    }
  }
}

// A camera with a bent lens at the origin, and a rectangle across its axis.
class ProjectedOutline : public testing::Test {
 protected:
  static std::vector<Eigen::Vector3d> rectangle(double half, double z) {
    return {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  }
  const Camera camera{
      Camera::Model::kRadialTangential, 640, 480, {500, 500, 319.5, 239.5}, {-0.2, 0.05}};
};

TEST_F(ProjectedOutline, GoesThroughItsCornersAndAlongItsEdges) {
  const auto pixels = project_outline(rectangle(1, 4), SE3(), camera);
  ASSERT_GT(pixels.size(), 4u);
  for (const Eigen::Vector3d& x : std::vector<Eigen::Vector3d>{{1, 1, 4}, {1, 0, 4}, {-1, 1, 4}}) {
    const Eigen::Vector2d at = camera.project(x);
    double nearest = 1e9;
    for (const cv::Point2f& p : pixels) {
      nearest = std::min(nearest, std::hypot(p.x - at.x(), p.y - at.y()));
    }
    EXPECT_LT(nearest, 1e-3);
  }
}

TEST_F(ProjectedOutline, IsCutJustOutsideOfThePicture) {
  // A floor from behind the camera to far in front of it, and a wall that fills the picture.
  const std::vector<Eigen::Vector3d> floor = {{-9, 1, -5}, {9, 1, -5}, {9, 1, 50}, {-9, 1, 50}};
  for (const auto& outline : {floor, rectangle(100, 4)}) {
    const auto pixels = project_outline(outline, SE3(), camera);
    ASSERT_FALSE(pixels.empty());
    for (const cv::Point2f& p : pixels) {
      EXPECT_TRUE(std::abs(p.x - 320) < 400 && std::abs(p.y - 240) < 300) << p;
      const bool inside = p.x > 0 && p.x < 639 && p.y > 0 && p.y < 479;
      EXPECT_TRUE(!inside || outline == floor) << "no cut is seen: " << p;
    }
  }
}

TEST_F(ProjectedOutline, IsEmptyBehindTheCameraAndBesideThePicture) {
  EXPECT_TRUE(project_outline(rectangle(1, -4), SE3(), camera).empty());
  const SE3 aside(Eigen::Quaterniond::Identity(), {20, 0, 0});
  EXPECT_TRUE(project_outline(rectangle(1, 4), aside, camera).empty());
  EXPECT_TRUE(project_outline({}, SE3(), camera).empty());
}

// Points on the surface of an ellipsoid show inside of its outline, and some on it.
TEST_F(ProjectedOutline, OfAnEllipsoidIsWhereItsSurfaceEnds) {
  const Ellipsoid ellipsoid{SE3(so3_exp({0.5, 0.3, 0}), {0.3, -0.2, 3}), {0.5, 0.3, 0.2}};
  const SE3 T_cw(so3_exp({0, 0.1, 0}), {0.1, 0, 0.2});
  const auto outline = project_ellipsoid(ellipsoid, T_cw, camera);
  ASSERT_GT(outline.size(), 12u);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double deepest = -1e9, nearest = 1e9;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d u =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Vector2f at =
        camera.project(T_cw * (ellipsoid.T * ellipsoid.semi_axes.cwiseProduct(u))).cast<float>();
    const double inside = cv::pointPolygonTest(outline, {at.x(), at.y()}, true);
    deepest = std::max(deepest, inside);
    nearest = std::min(nearest, inside);
  }
  EXPECT_GT(nearest, -1) << "pixels: nothing lies outside, but for the polygon's corners";
  EXPECT_LT(nearest, 1) << "the outline is no larger than the ellipsoid";
  EXPECT_GT(deepest, 20);
}

TEST_F(ProjectedOutline, OfAnEllipsoidAroundOrBehindTheCameraIsEmpty) {
  EXPECT_TRUE(project_ellipsoid({SE3(), {1, 1, 1}}, SE3(), camera).empty());
  const SE3 behind(Eigen::Quaterniond::Identity(), {0, 0, -4});
  EXPECT_TRUE(project_ellipsoid({behind, {1, 1, 1}}, SE3(), camera).empty());
}

TEST(Overlay, DrawsBoxesThinlyAndObjectsWithTheirNames) {
  const cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(100, 100, 100));
  FrameOverlay overlay;
  overlay.boxes.push_back({50, 60, 150, 160});
  overlay.objects.push_back({"cup", {{300, 200}, {400, 200}, {400, 300}, {300, 300}}});
  overlay.objects.push_back({"a name at the border", {{600, 2}, {639, 2}, {639, 40}}});
  overlay.objects.push_back({"nothing", {}});
  const cv::Mat drawn = draw_overlay(picture, overlay);
  show("objects.png", drawn);
  EXPECT_GT(drawn.at<cv::Vec3b>(60, 100)[0], 180) << "light, smoothed";
  EXPECT_EQ(drawn.at<cv::Vec3b>(110, 100), cv::Vec3b(100, 100, 100));
  const cv::Vec3b edge = drawn.at<cv::Vec3b>(250, 300);
  EXPECT_GT(edge[0], edge[2] + 50) << "blue, as what has no colour of its own";
  cv::Mat changed;
  cv::absdiff(drawn(cv::Rect(330, 175, 40, 22)), cv::Scalar::all(100), changed);
  EXPECT_GT(cv::norm(changed, cv::NORM_INF), 50) << "the name above";
}

TEST(Overlay, TintsMasksAndDrawsOutlinesInTheColoursOfTheirLabels) {
  const cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(100, 100, 100));
  FrameOverlay overlay;
  overlay.masks.push_back({"floor", cv::Mat::zeros(480, 640, CV_8U)});
  overlay.masks[0].inside.rowRange(300, 480).setTo(255);
  overlay.outlines.push_back({"wall", {{100, 50}, {500, 50}, {500, 200}, {100, 200}}});
  const cv::Mat drawn = draw_overlay(picture, overlay);
  show("planes.png", drawn);
  const cv::Vec3b floor = drawn.at<cv::Vec3b>(320, 20);
  const Rgb orange = label_colour("floor");
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(floor[i], 0.75 * 100 + 0.25 * orange[2 - i], 2);
  EXPECT_GT(drawn.at<cv::Vec3b>(50, 300)[0], 180) << "sky blue, smoothed";
  EXPECT_EQ(drawn.at<cv::Vec3b>(120, 300), cv::Vec3b(100, 100, 100)) << "an outline is not filled";
}

TEST(Plots, ShowPlanesInTheColoursOfTheirLabels) {
  PlotScene scene = room();
  scene.planes.push_back(
      {{{-3, 1, -2}, {3, 1, -2}, {3, 1, 2}, {-3, 1, 2}}, "floor", label_colour("floor")});
  const cv::Mat plot = draw_map_plot(scene);
  show("map_with_planes.png", plot);
  EXPECT_GT(count_of(plot, bgr(label_colour("floor"))), 800);
}

TEST(Plots, ShowObjectsFromAboveWithTheirNames) {
  PlotScene scene = room();
  scene.points.clear();
  scene.objects.push_back({{SE3(Eigen::Quaterniond::Identity(), {0, 0.5, 0}), {0.6, 0.2, 0.4}},
                           "chair",
                           label_colour("chair")});
  const cv::Mat plot = draw_map_plot(scene);
  show("map_with_objects.png", plot);
  EXPECT_GT(count_of(plot, bgr(label_colour("chair"))), 150);
  scene.objects[0].label.clear();
  EXPECT_GT(cv::norm(plot, draw_map_plot(scene), cv::NORM_INF), 50) << "the name";
}

TEST(Overlay, MarksFeaturesAndWritesTheState) {
  FrameOverlay overlay;
  for (int i = 0; i < 40; ++i) overlay.features.push_back({20.f + 15 * i, 100, i % 2 == 0});
  overlay.state = "tracked";
  overlay.matches = 20;
  overlay.fps = 31.4;
  overlay.timestamp = 12.5;
  const cv::Mat grey(401, 641, CV_8UC1, cv::Scalar(90));
  const cv::Mat drawn = draw_overlay(grey, overlay);
  show("overlay.png", drawn);
  EXPECT_EQ(drawn.type(), CV_8UC3);
  EXPECT_EQ(drawn.cols % 2 + drawn.rows % 2, 0);
  EXPECT_GT(drawn.rows, grey.rows);
  EXPECT_GT(count_of(drawn, colours::kMapped), 50);
  EXPECT_EQ(grey.at<uchar>(100, 20), 90);  // the picture itself is not drawn on
}

TEST(WriteStrip, PutsPicturesInRows) {
  TempFolder folder;
  write_strip(folder / "strip.png", std::vector<cv::Mat>(5, test_picture(1)), 3, 100);
  const cv::Mat strip = cv::imread((folder / "strip.png").string());
  EXPECT_EQ(strip.size(), cv::Size(3 * 106 - 6, 2 * 81 - 6));
  EXPECT_THROW(write_strip(folder / "strip.png", {}, 3), Error);
  EXPECT_THROW(write_strip(folder / "strip.what", {test_picture(1)}, 3), Error);
}

TEST(VideoFile, AppearsWhenItIsFinished) {
  TempFolder folder;
  for (const char* name : {"a.avi", "a.mp4"}) {
    {
      VideoFile given_up(folder / name, 10);
      given_up.write(test_picture(0));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / name));
    VideoFile video(folder / name, 10);
    for (int i = 0; i < 12; ++i) video.write(test_picture(i));
    video.write(test_picture(12, {80, 60}));
    EXPECT_FALSE(std::filesystem::exists(folder / name));
    video.finish();
    cv::VideoCapture reader((folder / name).string());
    cv::Mat picture;
    int count = 0;
    while (reader.read(picture)) ++count;
    EXPECT_EQ(count, 13) << name;
  }
}

TEST(VideoFile, SaysWhatItCannotDo) {
  TempFolder folder;
  EXPECT_THAT(error_of(Error::Kind::kUsage, [&] { VideoFile(folder / "a.gif", 10); }),
              HasSubstr(".mp4 or .avi"));
  VideoFile nowhere(folder / "no/a.avi", 10);
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { nowhere.write(test_picture(0)); }),
              HasSubstr("no/a.avi"));
}

// Files of this process end at so many bytes, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  sighandler_t handler_;
  rlimit before_{};
};

TEST(VideoFile, ThatDoesNotFitOnTheDiskIsRefusedAndGone) {
  TempFolder folder;
  const auto write_video = [&](const std::filesystem::path& file) {
    VideoFile video(file, 10);
    for (int i = 0; i < 12; ++i) video.write(test_picture(i));
    video.finish();
  };
  for (const char* name : {"a.avi", "a.mp4"}) {
    write_video(folder / name);
    const auto size = std::filesystem::file_size(folder / name);
    std::filesystem::remove(folder / name);
    for (const auto limit : {size / 2, size - 16}) {
      const FileSizeLimit full(limit);
      EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { write_video(folder / name); }),
                  HasSubstr(std::string(name) + ": the video did not reach the disk"))
          << limit << " of " << size;
      EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    }
  }
}

}  // namespace
}  // namespace cairn
