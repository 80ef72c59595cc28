#include "cairn/synthetic/scene.h"

#include <gtest/gtest.h>

#include <set>

#include "cairn/geometry/error.h"
#include "cairn/synthetic/ray_caster.h"
#include "cairn/synthetic/surface_planes.h"
#include "cairn/synthetic/tessellation.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// The distance to the nearest surface among many directions.
float clearance(const RayCaster& caster, const Vector3d& at) {
  float nearest = 1e9f;
  for (int i = 0; i < 100; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 100, angle = 2.39996323 * i, r = std::sqrt(1 - z * z);
    const RayHit hit = caster.cast(
        at.cast<float>(), Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>());
    if (hit.found()) nearest = std::min(nearest, hit.distance);
  }
  return nearest;
}

void expect_free_path(const Scene& scene) {
  const std::vector<Mesh> meshes = placed_meshes(scene);
  const RayCaster caster(meshes);
  Vector3d last = scene.path(0).translation();
  for (double t = 0; t < scene.duration; t += 0.1) {
    const Vector3d at = scene.path(t).translation();
    EXPECT_GT(clearance(caster, at), 0.2f) << "at " << t << " s";
    const Vector3d step = at - last;
    if (step.norm() > 1e-6) {
      const RayHit hit = caster.cast(last.cast<float>(), step.cast<float>());
      EXPECT_TRUE(!hit.found() || hit.distance > 1) << "at " << t << " s";
    }
    last = at;
  }
}

void expect_smooth_path(const Scene& scene) {
  const double dt = 1 / scene.fps;
  for (double t = dt; t < scene.duration - dt; t += 5 * dt) {
    const SE3 before = scene.path(t).inverse() * scene.path(t - dt);
    const SE3 after = scene.path(t).inverse() * scene.path(t + dt);
    EXPECT_LT(so3_log(after.rotation()).norm() / dt, 1.5) << "radians a second, at " << t;
    EXPECT_LT((before.translation() + after.translation()).norm() / (dt * dt), 6)
        << "metres a second squared, at " << t;
  }
}

void expect_flat_planes(const Scene& scene) {
  EXPECT_FALSE(scene.planes.empty());
  for (const WorldPlane& plane : scene.planes) {
    EXPECT_NEAR(plane.normal.norm(), 1, 1e-9);
    Vector3d area = Vector3d::Zero();
    for (std::size_t i = 0; i < plane.outline.size(); ++i) {
      EXPECT_NEAR(plane.normal.dot(plane.outline[i]) + plane.d, 0, 1e-4);
      area += plane.outline[i].cross(plane.outline[(i + 1) % plane.outline.size()]);
    }
    EXPECT_GT(area.dot(plane.normal), 0) << "the outline runs the wrong way around";
  }
}

class AnyScene : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(AnyScene, HasAFreeAndSmoothPathAndFlatPlanes) {
  const auto [name, seed] = GetParam();
  const Scene scene = make_scene(parse_scene_kind(name), std::uint64_t(seed));
  expect_free_path(scene);
  expect_smooth_path(scene);
  expect_flat_planes(scene);
}

// Also a surface that nobody sees from its open side would be missing in the truth.
TEST_P(AnyScene, ShowsASurfaceOnTheOpenSideOfEveryPlane) {
  const auto [name, seed] = GetParam();
  const Scene scene = make_scene(parse_scene_kind(name), std::uint64_t(seed));
  const std::vector<Mesh> meshes = placed_meshes(scene);
  const RayCaster caster(meshes);
  const SurfacePlanes surfaces(scene, meshes);
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const WorldPlane& plane = scene.planes[i];
    bool seen = false;
    for (std::size_t k = 0; k + 2 < plane.outline.size() && !seen; ++k) {
      for (const double share : {0.05, 0.2, 0.35, 0.5}) {  // of the way into a triangle of corners
        const Vector3d X = plane.outline[0] + share * (plane.outline[k + 1] - plane.outline[0]) +
                           share * (plane.outline[k + 2] - plane.outline[0]);
        const Vector3d above = X + 2e-3 * plane.normal;
        seen |= surfaces.plane_of(caster.cast(above.cast<float>(),
                                              Vector3d(-plane.normal).cast<float>())) == int(i);
      }
    }
    EXPECT_TRUE(seen) << "nothing lies on plane " << i << ", a " << plane.label;
  }
}

// How often an outline runs around a point of its plane: 0 means outside.
double turns_around(const WorldPlane& plane, const Vector3d& point) {
  double angle = 0;
  for (std::size_t i = 0; i < plane.outline.size(); ++i) {
    const Vector3d a = plane.outline[i] - point;
    const Vector3d b = plane.outline[(i + 1) % plane.outline.size()] - point;
    angle += std::atan2(a.cross(b).dot(plane.normal), a.dot(b));
  }
  return std::round(angle / (2 * M_PI));
}

TEST_P(AnyScene, StandsThingsOnTheirPlanesAndNotBesideThem) {
  const auto [name, seed] = GetParam();
  const Scene scene = make_scene(parse_scene_kind(name), std::uint64_t(seed));
  for (const WorldThing& thing : scene.things) {
    if (!thing.supported_by) continue;
    const WorldPlane& plane = scene.planes[std::size_t(*thing.supported_by)];
    Vector3d middle = Vector3d::Zero();
    double lowest = std::numeric_limits<double>::infinity();
    for (const Mesh::Vertex& vertex : thing.model.mesh.vertices) {
      const Vector3d at = thing.T_wo * Vector3d(vertex.position.cast<double>());
      lowest = std::min(lowest, plane.normal.dot(at) + plane.d);
      middle += at / double(thing.model.mesh.vertices.size());
    }
    EXPECT_NEAR(lowest, 0, 0.002) << thing.model.class_name << " on " << plane.label;
    middle -= (plane.normal.dot(middle) + plane.d) * plane.normal;
    EXPECT_EQ(turns_around(plane, middle), 1) << thing.model.class_name << " on " << plane.label;
  }
}

Eigen::AlignedBox3f bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Mesh::Vertex& vertex : mesh.vertices) box.extend(vertex.position);
  return box;
}

// Does an edge of `mesh`, made a hundredth smaller so that things may touch, pass through a surface
// of the thing?
bool pierces(const Mesh& mesh, const RayCaster& caster, std::int32_t thing) {
  const Vector3f middle = bounds(mesh).center();
  const auto smaller = [&](std::uint32_t i) {
    return Vector3f(middle + 0.99f * (mesh.vertices[i].position - middle));
  };
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Mesh::Triangle& t) {
    const std::array<std::uint32_t, 4> corners = {t.a, t.b, t.c, t.a};
    for (int i = 0; i < 3; ++i) {
      if (corners[i] > corners[i + 1]) continue;  // the neighbour's
      const Vector3f from = smaller(corners[i]), along = smaller(corners[i + 1]) - from;
      const RayHit hit = caster.cast_at(thing, from, along);
      if (hit.found() && hit.distance < 1) return true;
    }
    return false;
  });
}

TEST_P(AnyScene, HasNoObjectInsideAnotherThing) {
  const auto [name, seed] = GetParam();
  const Scene scene = make_scene(parse_scene_kind(name), std::uint64_t(seed));
  const std::vector<Mesh> meshes = placed_meshes(scene);
  const RayCaster caster(meshes);
  for (std::size_t a = 0; a < meshes.size(); ++a) {
    if (!scene.things[a].is_object) continue;
    const Eigen::AlignedBox3f box = bounds(meshes[a]);
    for (std::size_t b = 0; b < meshes.size(); ++b) {
      if (a == b || !box.intersects(bounds(meshes[b]))) continue;
      EXPECT_FALSE(pierces(meshes[a], caster, std::int32_t(b)))
          << scene.things[a].model.class_name << " and " << b << " "
          << scene.things[b].model.class_name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AnyScene,
                         testing::Combine(testing::Values("desk", "room", "corridor", "street"),
                                          testing::Range(0, 6)));

TEST(Scene, RoomEndsWhereItBegan) {
  const Scene scene = make_scene(SceneKind::kRoom, 5);
  const SE3 gap = scene.path(0).inverse() * scene.path(scene.duration);
  EXPECT_LT(gap.translation().norm(), 0.01);
  EXPECT_LT(so3_log(gap.rotation()).norm(), 0.01);
  EXPECT_GT((scene.path(0).translation() - scene.path(scene.duration / 2).translation()).norm(), 1);
}

TEST(Scene, SeedsDiffer) {
  std::set<std::pair<float, float>> bottles, lamps;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scene scene = make_scene(SceneKind::kDesk, seed);
    lamps.insert({scene.lights[0].radiance.x(), scene.lights[1].radiance.x()});
    for (const WorldThing& thing : scene.things) {
      if (thing.model.class_name != "bottle") continue;
      Eigen::AlignedBox3f box;
      for (const auto& vertex : thing.model.mesh.vertices) box.extend(vertex.position);
      EXPECT_TRUE(bottles.insert({box.sizes().x(), box.sizes().z()}).second)
          << "seed " << seed << " has a bottle of another one";
    }
  }
  EXPECT_EQ(lamps.size(), 6u);
}

TEST(Scene, OnlyTheLowestBookOfAPileStandsOnAPlane) {
  int above = 0;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    for (const WorldThing& thing : make_scene(SceneKind::kDesk, seed).things) {
      if (!thing.is_object || thing.supported_by) continue;
      EXPECT_EQ(thing.model.class_name, "book");
      ++above;
    }
  }
  EXPECT_GE(above, 1);
}

TEST(Scene, UnknownNameIsOneSentence) {
  try {
    parse_scene_kind("garden");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::kUsage);
    EXPECT_NE(std::string(error.what()).find("garden"), std::string::npos);
  }
}

TEST(Tessellation, KeepsAreaAndBoundsEdges) {
  Mesh mesh = make_model("book", 3).mesh;
  const auto area = [&] {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
      const Vector3f& a = mesh.vertices[t.a].position;
      sum +=
          double((mesh.vertices[t.b].position - a).cross(mesh.vertices[t.c].position - a).norm());
    }
    return sum;
  };
  const double before = area();
  tessellate(mesh, 0.03f);
  EXPECT_NEAR(area(), before, 1e-5 * before);
  for (const auto& t : mesh.triangles) {
    EXPECT_LE((mesh.vertices[t.a].position - mesh.vertices[t.b].position).norm(), 0.03f);
  }
}

}  // namespace
}  // namespace cairn
