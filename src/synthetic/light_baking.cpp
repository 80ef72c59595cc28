#include "cairn/synthetic/light_baking.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "cairn/synthetic/ray_caster.h"
#include "cairn/synthetic/tessellation.h"

namespace cairn {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kPacket = RayCaster::kPacket;
constexpr int kGrid = 8;        // shadow rays a light: kGrid x kGrid
constexpr int kGather = 48;     // rays for what comes from other surfaces
constexpr float kLift = 1e-3f;  // metres off the surface, so that it does not shade itself

// Where the light of a vertex is taken: a little off the surface and towards the middle of the
// triangles around it, because corners of things lie in the corners of others.
struct Sample {
  Vector3f position, normal;
};

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

// Evenly spread, weighted by the cosine to +z (a spiral; Vogel 1979 on the unit disc, lifted), and
// sorted so that those of one packet are neighbours.
std::array<Vector3f, kGather> gather_directions() {
  std::array<Vector3f, kGather> directions;
  for (int i = 0; i < kGather; ++i) {
    const float r2 = (float(i) + 0.5f) / kGather, angle = 2.39996323f * float(i);
    const float r = std::sqrt(r2);
    directions[std::size_t(i)] = {r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - r2)};
  }
  std::ranges::sort(directions, {}, [](const Vector3f& d) { return std::atan2(d.y(), d.x()); });
  return directions;
}

class Baker {
 public:
  Baker(const Scene& scene, const BakeOptions& options, std::vector<Mesh> meshes)
      : scene_(scene), options_(options), coarse_(std::move(meshes)), caster_(make_caster()) {
    for (const Mesh& mesh : coarse_) {
      std::vector<Colour> albedo;
      for (const Material& material : mesh.materials) {
        albedo.push_back(material.texture ? material.colour.cwiseProduct(mean_of(material.texture))
                                          : material.colour);
      }
      albedo_.push_back(std::move(albedo));
    }
    for (const Mesh& mesh : coarse_) {
      const auto samples = samples_of(mesh);
      std::vector<Colour> light(samples.size());
      each(samples.size(), [&](std::size_t i) { light[i] = direct(samples[i]); });
      direct_.push_back(std::move(light));
    }
  }

  // Splits edges whose ends differ, and goes on where what was found in their middle was not what
  // lies between their ends: where it was, interpolation does as well.
  void refine(std::size_t thing, Mesh& mesh, std::vector<Colour>& light) const {
    mesh = coarse_[thing];
    light = direct_[thing];
    const auto samples = samples_of(mesh);
    each(samples.size(), [&](std::size_t i) { light[i] += gathered(samples[i]); });
    std::vector<char> rough(light.size(), 1);
    while (true) {
      const std::size_t before = light.size();
      const auto split = split_edges(mesh, [&](std::uint32_t i, std::uint32_t j) {
        const float length = (mesh.vertices[i].position - mesh.vertices[j].position).norm();
        return length > 2 * options_.finest_cell && (rough[i] || rough[j]) &&
               differs(light[i], light[j]);
      });
      if (split.empty()) return;
      light_from(mesh, light, before);
      rough.assign(light.size(), 0);
      for (std::size_t k = 0; k < split.size(); ++k) {
        const auto [i, j] = split[k];
        if (differs(light[before + k], 0.5f * (light[i] + light[j]))) {
          rough[i] = rough[j] = rough[before + k] = 1;
        }
      }
    }
  }

 private:
  RayCaster make_caster() {
    for (Mesh& mesh : coarse_) tessellate(mesh, options_.cell);
    return RayCaster(coarse_);
  }

  template <typename Function>
  static void each(std::size_t count, const Function& function) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) function(i);
    });
  }

  Colour mean_of(const std::shared_ptr<const Texture>& texture) {
    for (const auto& [known, mean] : means_) {
      if (known == texture.get()) return mean;
    }
    means_.emplace_back(texture.get(), mean_colour(*texture));
    return means_.back().second;
  }

  static Colour mean_colour(const Texture& texture) {
    // In squares, which is near enough to linear light.
    Colour sum = Colour::Zero();
    int count = 0;
    for (int y = 0; y < texture.picture.rows; y += 7) {
      const auto* row = texture.picture.ptr<cv::Vec3b>(y);
      for (int x = 0; x < texture.picture.cols; x += 7, ++count) {
        for (int c = 0; c < 3; ++c) sum[c] += linear_from_srgb(float(row[x][2 - c]) / 255);
      }
    }
    return sum / float(std::max(count, 1));
  }

  // Relative to the brighter one, but not in the dark: nobody sees a tenth of nearly nothing.
  bool differs(const Colour& a, const Colour& b) const {
    return (a - b).cwiseAbs().maxCoeff() >
           options_.contrast * (std::max(a.maxCoeff(), b.maxCoeff()) + 0.1f);
  }

  void light_from(const Mesh& mesh, std::vector<Colour>& light, std::size_t first) const {
    const auto samples = samples_of(mesh);
    light.resize(samples.size());
    each(samples.size() - first, [&](std::size_t i) {
      const Sample& sample = samples[first + i];
      light[first + i] = direct(sample) + gathered(sample);
    });
  }

  Colour direct(const Sample& sample) const {
    Colour sum = Colour::Zero();
    for (const AreaLight& light : scene_.lights) sum += light.radiance * seen(sample, light);
    return sum;
  }

  // The integral over the light of both cosines over r² and pi. Half of the rays first: where they
  // agree that all is seen or nothing is, the others are spared.
  float seen(const Sample& sample, const AreaLight& light) const {
    const Vector3f cross = light.u.cross(light.v);
    const float area = 4 * cross.norm();
    const Vector3f light_normal = cross.normalized();
    float sum = 0;
    int cast = 0, open = 0;
    for (int half = 0; half < 2; ++half) {
      for (int row = half; row < kGrid; row += 2) {
        RayCaster::Packet packet;
        std::array<float, kPacket> weight{};
        for (int i = 0; i < kGrid; ++i) {
          const auto k = std::size_t(i);
          const float a = (float(i) + 0.5f) * 2 / kGrid - 1,
                      b = (float(row) + 0.5f) * 2 / kGrid - 1;
          const Vector3f to = light.centre + a * light.u + b * light.v - sample.position;
          const float r2 = to.squaredNorm(), r = std::sqrt(r2);
          weight[k] = std::max(0.f, sample.normal.dot(to) / r) *
                      std::max(0.f, -light_normal.dot(to) / r) / r2;
          packet.origin[k] = sample.position;
          packet.direction[k] = to;
          packet.active[k] = weight[k] > 0;
        }
        const auto free = caster_.free(packet);
        for (std::size_t k = 0; k < kPacket; ++k) {
          cast += packet.active[k], open += free[k];
          if (free[k]) sum += weight[k];
        }
      }
      if (half == 0 && (open == 0 || open == cast)) {
        sum *= 2;
        break;
      }
    }
    return sum * area / float(kGrid * kGrid) / float(M_PI);
  }

  Colour gathered(const Sample& sample) const {
    static const std::array<Vector3f, kGather> kDirections = gather_directions();
    const Vector3f& n = sample.normal;
    const Vector3f x =
        (std::abs(n.z()) < 0.9f ? Vector3f::UnitZ() : Vector3f::UnitX()).cross(n).normalized();
    const Vector3f y = n.cross(x);
    Colour sum = Colour::Zero();
    for (int first = 0; first < kGather; first += kPacket) {
      RayCaster::Packet packet;
      std::array<RayHit, kPacket> hits;
      for (std::size_t k = 0; k < kPacket; ++k) {
        const Vector3f& d = kDirections[std::size_t(first) + k];
        packet.origin[k] = sample.position;
        packet.direction[k] = d.x() * x + d.y() * y + d.z() * n;
        packet.active[k] = true;
      }
      caster_.cast(packet, hits);
      for (std::size_t k = 0; k < kPacket; ++k) sum += sent_back(hits[k], packet.direction[k]);
    }
    return sum / kGather;
  }

  // What comes along a ray: from a surface the light that it got from the lamps, coloured by it,
  // and ambient light, the more the farther away the surface is.
  Colour sent_back(const RayHit& hit, const Vector3f& direction) const {
    if (!hit.found()) return scene_.sky;
    const auto thing = std::size_t(hit.thing);
    const float open = hit.distance / (hit.distance + options_.openness);
    if (hit.normal.dot(direction) > 0) return Colour::Zero();  // from inside of a thing
    const auto& t = coarse_[thing].triangles[hit.triangle];
    const auto& light = direct_[thing];
    const Colour at = (1 - hit.u - hit.v) * light[t.a] + hit.u * light[t.b] + hit.v * light[t.c];
    return albedo_[thing][t.material].cwiseProduct(at) + open * scene_.ambient;
  }

  const Scene& scene_;
  const BakeOptions& options_;
  std::vector<Mesh> coarse_;
  RayCaster caster_;
  std::vector<std::pair<const Texture*, Colour>> means_;
  std::vector<std::vector<Colour>> albedo_;  // of thing and material
  std::vector<std::vector<Colour>> direct_;  // of thing and vertex of coarse_
};

}  // namespace

LitMeshes bake_light(const Scene& scene, std::vector<Mesh> meshes, const BakeOptions& options) {
  const std::size_t count = meshes.size();
  const Baker baker(scene, options, std::move(meshes));
  LitMeshes lit{std::vector<Mesh>(count), std::vector<std::vector<Colour>>(count)};
  tbb::parallel_for(std::size_t(0), count,
                    [&](std::size_t i) { baker.refine(i, lit.meshes[i], lit.light[i]); });
  return lit;
}

}  // namespace cairn
