#include "cairn/synthetic/world.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <set>

#include "cairn/geometry/error.h"
#include "cairn/synthetic/object_truth.h"

namespace cairn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr BakeOptions kQuick{.cell = 0.5f, .finest_cell = 0.15f};

const World& desk() {
  static const World world(make_scene(SceneKind::kDesk, 1), kQuick);
  return world;
}

Camera small_camera(bool distorted = true) {
  return default_camera(SceneKind::kDesk, 160, 120, distorted);
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

RayHit cast(const World& world, const Camera& camera, const SE3& T_wc, int x, int y) {
  const Vector3d ray = T_wc.rotation() * camera.unproject({x, y});
  return world.caster().cast(T_wc.translation().cast<float>(), ray.cast<float>());
}

TEST(World, SameSeedSameBytesWithAnyNumberOfThreads) {
  const Camera camera = small_camera();
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const World again(make_scene(SceneKind::kDesk, 1), kQuick);
  EXPECT_TRUE(same_bytes(again.render(camera, 2.5), [&] {
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    return desk().render(camera, 2.5);
  }()));
  const SE3 T_wc = again.scene().path(2.5);
  EXPECT_TRUE(same_bytes(again.truth(camera, T_wc).depth, desk().truth(camera, T_wc).depth));
  EXPECT_FALSE(same_bytes(again.render(camera, 2.5), again.render(camera, 2.6)));
}

TEST(World, FullyLitAndAtFullSizeTwoThreadsGiveTheBytesOfOne) {
  const Camera camera = default_camera(SceneKind::kDesk, 640, 480, true);
  const auto rendered = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return World(make_scene(SceneKind::kDesk, 2)).render(camera, 1);
  };
  EXPECT_TRUE(same_bytes(rendered(1), rendered(2)));
}

// Pixels by which `picture` shows things elsewhere than `reference`, in the mean.
Vector2d shift(const cv::Mat& picture, const cv::Mat& reference) {
  Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
  Vector2d g = Vector2d::Zero();
  for (int y = 1; y + 1 < reference.rows; ++y) {
    for (int x = 1; x + 1 < reference.cols; ++x) {
      const auto grey = [](const cv::Mat& of, int column, int row) {
        return double(of.at<cv::Vec3f>(row, column)[1]);
      };
      const Vector2d slope(0.5 * (grey(reference, x + 1, y) - grey(reference, x - 1, y)),
                           0.5 * (grey(reference, x, y + 1) - grey(reference, x, y - 1)));
      H += slope * slope.transpose();
      g += slope * (grey(reference, x, y) - grey(picture, x, y));
    }
  }
  return H.inverse() * g;
}

TEST(World, FewSamplesShowThingsWhereManyDo) {
  const Camera camera = default_camera(SceneKind::kDesk, 320, 240, false);
  Vector2d mean = Vector2d::Zero();
  constexpr int kViews = 4;
  for (int view = 0; view < kViews; ++view) {
    const auto seen = [&](int samples) {
      RenderOptions options;
      options.exposure = 0;
      options.samples = samples;
      return desk().render_light(camera, 0.5 + 1.3 * view, options);
    };
    mean += shift(seen(4), seen(100)) / kViews;
  }
  // Edges alone, of which four samples see little, give 0.01 to 0.02 in single views.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.03) << mean.transpose();
}

TEST(World, DepthReprojectsBetweenFrames) {
  const Camera camera = small_camera();
  const SE3 T_wa = desk().scene().path(3), T_wb = desk().scene().path(3.4);
  ASSERT_GT((T_wa.translation() - T_wb.translation()).norm(), 0.02);
  const FrameTruth a = desk().truth(camera, T_wa), b = desk().truth(camera, T_wb);
  int compared = 0;
  for (int y = 0; y < 120; y += 3) {
    for (int x = 0; x < 160; x += 3) {
      const double depth = double(a.depth.at<float>(y, x));
      if (depth == 0) continue;
      const Vector3d ray = camera.unproject({x, y});
      const Vector3d X_w = T_wa * Vector3d(ray * depth / ray.z());
      // Seen from b, the same surface point is met where a's depth says.
      const Vector3d X_b = T_wb.inverse() * X_w;
      const Vector2d pixel = camera.project(X_b);
      if (pixel.x() < 1 || pixel.y() < 1 || pixel.x() > 158 || pixel.y() > 118) continue;
      const Vector3d towards = X_w - T_wb.translation();
      const RayHit hit = desk().caster().cast(T_wb.translation().cast<float>(),
                                              towards.normalized().cast<float>());
      ASSERT_TRUE(hit.found());
      if (double(hit.distance) < towards.norm() - 0.003) continue;  // hidden from there
      const Vector3d X_hit = T_wb.translation() + towards.normalized() * double(hit.distance);
      // Back in a, in pixels.
      EXPECT_LT((camera.project(T_wa.inverse() * X_hit) - Vector2d(x, y)).norm(), 0.1);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(cv::countNonZero(b.depth), 160 * 120 * 95 / 100);
}

TEST(World, TruthAgreesWithRayCasts) {
  const Camera camera = small_camera();
  const SE3 T_wc = desk().scene().path(1);
  const FrameTruth truth = desk().truth(camera, T_wc);
  for (int y = 2; y < 120; y += 7) {
    for (int x = 2; x < 160; x += 7) {
      const RayHit hit = cast(desk(), camera, T_wc, x, y);
      ASSERT_EQ(truth.instances.at<std::uint16_t>(y, x), hit.thing + 1);
      if (!hit.found()) continue;
      const auto& name = desk().scene().things[std::size_t(hit.thing)].model.class_name;
      EXPECT_EQ(desk().labels()[truth.labels.at<std::uint8_t>(y, x)], name);
      EXPECT_EQ(truth.planes.at<std::uint16_t>(y, x), desk().plane_of(hit) + 1);
      const cv::Vec3d n = truth.normals.at<cv::Vec3f>(y, x);
      const Vector3d normal(n[0], n[1], n[2]);
      EXPECT_NEAR(normal.norm(), 1, 1e-4);
      if (truth.planes.at<std::uint16_t>(y, x) == 0) continue;
      // On a plane the normal is the plane's, towards the camera.
      const auto& plane = desk().scene().planes[std::size_t(desk().plane_of(hit))];
      EXPECT_GT(normal.dot(T_wc.rotation().conjugate() * plane.normal), 0.99999);
      EXPECT_LT(normal.dot(camera.unproject({x, y})), 0);
    }
  }
}

TEST(World, PlanesFitTheDepthWithinAMillimetre) {
  const Camera camera = small_camera();
  std::set<int> seen;
  for (const double t : {0.0, 3.0, 6.0}) {
    const SE3 T_wc = desk().scene().path(t);
    const FrameTruth truth = desk().truth(camera, T_wc);
    for (const PlaneView& view : truth.visible_planes) {
      int pixels = 0;
      for (int y = 0; y < 120; ++y) {
        for (int x = 0; x < 160; ++x) {
          if (truth.planes.at<std::uint16_t>(y, x) != view.plane + 1) continue;
          ++pixels;
          const Vector3d ray = camera.unproject({x, y});
          const Vector3d X_c = ray * double(truth.depth.at<float>(y, x)) / ray.z();
          ASSERT_LT(std::abs(view.parameters.head<3>().dot(X_c) + view.parameters[3]), 1e-3);
        }
      }
      EXPECT_EQ(pixels, view.pixels);
      seen.insert(view.plane);
    }
  }
  EXPECT_GE(seen.size(), 3u);
}

TEST(World, BoxesHoldWhatMasksAndSurfacesShow) {
  const Camera camera = small_camera();
  const auto truths = object_truths(desk().scene());
  int checked = 0;
  for (const double t : {0.0, 4.0}) {
    const SE3 T_wc = desk().scene().path(t);
    const FrameTruth truth = desk().truth(camera, T_wc);
    for (const ObjectView& view : truth.objects) {
      const cv::Mat mask = truth.instances == view.thing + 1;
      const cv::Rect tight = cv::boundingRect(mask);
      EXPECT_EQ(cv::countNonZero(mask), view.pixels);
      EXPECT_EQ(view.visible_box.x0, tight.x - 0.5);
      EXPECT_EQ(view.visible_box.y1, tight.y + tight.height - 0.5);
      EXPECT_GE(view.visible_box.x0, view.amodal_box.x0 - 0.51);
      EXPECT_LE(view.visible_box.y1, view.amodal_box.y1 + 0.51);
      EXPECT_LE(view.visible, 1);
      const auto object = std::ranges::find(truths, view.thing, &ObjectTruth::thing);
      for (const Vector3d& X : object->surface_points) {
        const Vector3d X_c = T_wc.inverse() * X;
        if (view.truncated || X_c.z() < 0.1) continue;
        const Vector2d p = camera.project(X_c);
        EXPECT_GT(p.x(), view.amodal_box.x0 - 0.01);
        EXPECT_LT(p.y(), view.amodal_box.y1 + 0.01);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 2000);
}

TEST(World, EllipsoidsEncloseTheSurfacesOfTheirObjects) {
  const Scene& scene = desk().scene();
  const auto truths = object_truths(scene);
  EXPECT_GT(truths.size(), 10u);
  for (const ObjectTruth& truth : truths) {
    const WorldThing& thing = scene.things[std::size_t(truth.thing)];
    ASSERT_EQ(truth.surface_points.size(), 500u);
    for (const Vector3d& X : truth.surface_points) EXPECT_LE(truth.ellipsoid.level(X), 1 + 1e-6);
    for (const auto& vertex : thing.model.mesh.vertices) {
      EXPECT_LE(truth.ellipsoid.level(thing.T_wo * vertex.position.cast<double>()), 1 + 1e-6);
    }
  }
}

TEST(World, ThingsStandOnTheirPlanes) {
  const Scene& scene = desk().scene();
  int supported = 0;
  for (const WorldThing& thing : scene.things) {
    if (!thing.supported_by) continue;
    const WorldPlane& plane = scene.planes[std::size_t(*thing.supported_by)];
    double lowest = 1e9;
    for (const auto& vertex : thing.model.mesh.vertices) {
      const Vector3d X = thing.T_wo * vertex.position.cast<double>();
      lowest = std::min(lowest, plane.normal.dot(X) + plane.d);
    }
    EXPECT_NEAR(lowest, 0, 1e-3) << thing.model.class_name;
    ++supported;
  }
  EXPECT_GT(supported, 5);
}

TEST(World, PartsOfTheSensorCanBeSwitchedOff) {
  const Camera camera = small_camera(false);
  RenderOptions quiet;
  quiet.exposure = 0;
  quiet.sensor = {.vignetting = 0,
                  .auto_exposure = 0,
                  .blur_px = 0,
                  .full_well = 0,
                  .read_noise = 0,
                  .mosaic = false};
  const cv::Mat base = desk().render(camera, 1, quiet);
  const auto differs = [&](const RenderOptions& options) {
    return cv::norm(base, desk().render(camera, 1, options), cv::NORM_L1) / double(base.total());
  };
  EXPECT_EQ(differs(quiet), 0);
  auto changed = quiet;
  changed.exposure = 0.05;
  EXPECT_GT(differs(changed), 0.5);
  changed = quiet, changed.readout = 0.1;
  EXPECT_GT(differs(changed), 0.5);
  changed = quiet, changed.sensor.vignetting = 0.3;
  EXPECT_GT(differs(changed), 2);
  changed = quiet, changed.sensor.full_well = 2000;
  EXPECT_GT(differs(changed), 0.5);
  changed = quiet, changed.sensor.mosaic = true;
  EXPECT_GT(differs(changed), 0.5);
  changed = quiet, changed.sensor.blur_px = 1;
  EXPECT_GT(differs(changed), 0.5);
}

}  // namespace
}  // namespace cairn
