#include "cairn/synthetic/object_truth.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> spread_points(const Mesh& mesh, int count, std::uint64_t seed) {
  std::vector<double> area = {0};
  for (const auto& t : mesh.triangles) {
    const auto& a = mesh.vertices[t.a].position;
    const auto cross =
        (mesh.vertices[t.b].position - a).cross(mesh.vertices[t.c].position - a).norm();
    area.push_back(area.back() + 0.5 * double(cross));
  }
  Sampler sampler(seed);
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    // One point in each of `count` equal shares of the surface.
    const double at = (i + sampler.uniform()) / count * area.back();
    const auto after = std::upper_bound(area.begin() + 1, area.end() - 1, at);
    const auto& t = mesh.triangles[std::size_t(after - area.begin() - 1)];
    const double root = std::sqrt(sampler.uniform()), v = sampler.uniform();
    points.push_back((1 - root) * mesh.vertices[t.a].position.cast<double>() +
                     root * (1 - v) * mesh.vertices[t.b].position.cast<double>() +
                     root * v * mesh.vertices[t.c].position.cast<double>());
  }
  return points;
}

}  // namespace

std::vector<ObjectTruth> object_truths(const Scene& scene, int points) {
  std::vector<ObjectTruth> truths;
  for (std::size_t i = 0; i < scene.things.size(); ++i) {
    if (!scene.things[i].is_object) continue;
    truths.emplace_back();
    truths.back().thing = int(i);
  }
  tbb::parallel_for(std::size_t(0), truths.size(), [&](std::size_t i) {
    ObjectTruth& truth = truths[i];
    const WorldThing& thing = scene.things[std::size_t(truth.thing)];
    const Mesh& mesh = thing.model.mesh;
    std::vector<Vector3d> vertices;
    for (const auto& vertex : mesh.vertices) vertices.push_back(vertex.position.cast<double>());
    // In the model's frame, so that its axes are named alike for all things of a class.
    truth.ellipsoid = minimum_enclosing_ellipsoid(vertices).value();
    truth.ellipsoid.centre = thing.T_wo * truth.ellipsoid.centre;
    truth.ellipsoid.rotation = thing.T_wo.rotation() * truth.ellipsoid.rotation;
    truth.up = thing.T_wo.rotation() * Vector3d::UnitZ();
    truth.surface_points =
        spread_points(mesh, points, scene.seed * 100003 + std::uint64_t(truth.thing));
    for (Vector3d& X : truth.surface_points) X = thing.T_wo * X;
  });
  return truths;
}

}  // namespace cairn
