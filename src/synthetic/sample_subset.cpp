#include "cairn/synthetic/sample_subset.h"

#include <cmath>

namespace cairn {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

// Metres off the surface: over itself, and over posters that hang on it.
constexpr float kLift = 2e-3f;
constexpr float kEnough = 0.3f;  // weight of a chosen sample that speaks for another one
constexpr float kTurn = 0.8f;    // cosine between normals from which on they have no weight

}  // namespace

std::vector<Sample> samples_of(const Mesh& mesh) {
  std::vector<Vector3f> middle(mesh.vertices.size(), Vector3f::Zero());
  std::vector<int> count(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) {
    const Vector3f centroid =
        (mesh.vertices[t.a].position + mesh.vertices[t.b].position + mesh.vertices[t.c].position) /
        3;
    for (const auto i : {t.a, t.b, t.c}) middle[i] += centroid, ++count[i];
  }
  std::vector<Sample> samples(mesh.vertices.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& vertex = mesh.vertices[i];
    Vector3f at = vertex.position;
    if (count[i] > 0) at += 0.1f * (middle[i] / float(count[i]) - at);
    samples[i] = {at + kLift * vertex.normal, vertex.normal};
  }
  return samples;
}

SampleSubset::SampleSubset(const std::vector<Sample>& samples, float spacing)
    : reach_(2 * spacing) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    float nearest = 0;
    visit(samples[i], [&](std::size_t, float weight) { nearest = std::max(nearest, weight); });
    if (nearest >= kEnough) continue;
    cells_[key(cell(samples[i].position))].emplace_back(std::uint32_t(chosen_.size()), samples[i]);
    chosen_.push_back(std::uint32_t(i));
  }
}

Vector3i SampleSubset::cell(const Vector3f& position) const {
  return (position / reach_).array().floor().cast<int>();
}

std::uint64_t SampleSubset::key(const Vector3i& cell) {
  const auto part = [](int i) { return std::uint64_t(i) & 0x1FFFFF; };
  return part(cell.x()) << 42 | part(cell.y()) << 21 | part(cell.z());
}

float SampleSubset::weight(const Sample& a, const Sample& b) const {
  const Vector3f between = a.position - b.position;
  const float near = 1 - between.norm() / reach_;
  const float level = 1 - std::abs(b.normal.dot(between)) / (0.15f * reach_);
  const float alike = (a.normal.dot(b.normal) - kTurn) / (1 - kTurn);
  return near > 0 && level > 0 && alike > 0 ? near * level * alike : 0;
}

}  // namespace cairn
