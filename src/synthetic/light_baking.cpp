#include "cairn/synthetic/light_baking.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "cairn/synthetic/ray_caster.h"
#include "cairn/synthetic/sample_subset.h"
#include "cairn/synthetic/tessellation.h"

namespace cairn {
namespace {

using Eigen::Vector3f;

constexpr int kPacket = RayCaster::kPacket;
// Where gathered light differs by less, in contrasts, its middle is the mean: that is far less
// wrong than the ends differ.
constexpr float kSmooth = 3;
constexpr int kGrid = 8;     // shadow rays a light: kGrid x kGrid
constexpr int kGather = 40;  // rays for what comes from other surfaces

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
    const auto samples = samples_of(mesh);
    std::vector<Colour> gathered = gathered_sparsely(samples);
    light = direct_[thing];
    for (std::size_t i = 0; i < light.size(); ++i) light[i] += gathered[i];
    std::vector<char> rough(light.size(), 1);
    while (true) {
      const std::size_t before = light.size();
      const auto split = split_edges(mesh, [&](std::uint32_t i, std::uint32_t j) {
        const float length = (mesh.vertices[i].position - mesh.vertices[j].position).norm();
        return length > 2 * options_.finest_cell && (rough[i] || rough[j]) &&
               differs(light[i], light[j]);
      });
      if (split.empty()) return;
      light_middles(mesh, split, light, gathered);
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

  // Lights the vertices that are new in the middle of edges. What comes from other surfaces changes
  // slowly: mostly it is what lies between the ends.
  void light_middles(const Mesh& mesh,
                     const std::vector<std::pair<std::uint32_t, std::uint32_t>>& split,
                     std::vector<Colour>& light, std::vector<Colour>& gathered) const {
    const std::size_t before = light.size();
    const auto samples = samples_of(mesh);
    light.resize(samples.size());
    gathered.resize(samples.size());
    each(split.size(), [&](std::size_t k) {
      const auto [i, j] = split[k];
      const Sample& sample = samples[before + k];
      const Colour off = (gathered[i] - gathered[j]).cwiseAbs();
      const bool even = off.maxCoeff() < kSmooth * options_.contrast *
                                             (0.5f * (light[i] + light[j]).maxCoeff() + 0.1f);
      gathered[before + k] = even ? Colour(0.5f * (gathered[i] + gathered[j])) : gather(sample);
      light[before + k] = direct(sample) + gathered[before + k];
    });
  }

  // For all samples of a thing, but with rays only for some; the others take it from those around
  // them that face the same way (after Ward's irradiance cache, 1988).
  std::vector<Colour> gathered_sparsely(const std::vector<Sample>& samples) const {
    const SampleSubset subset(samples, options_.finest_cell);
    std::vector<Colour> at_chosen(subset.chosen().size()), gathered(samples.size());
    each(at_chosen.size(),
         [&](std::size_t k) { at_chosen[k] = gather(samples[subset.chosen()[k]]); });
    each(samples.size(), [&](std::size_t i) {
      Colour sum = Colour::Zero();
      float total = 0;
      subset.visit(samples[i], [&](std::size_t k, float weight) {
        sum += weight * at_chosen[k];
        total += weight;
      });
      gathered[i] = total > 0 ? Colour(sum / total) : Colour::Zero();
    });
    return gathered;
  }

  Colour direct(const Sample& sample) const {
    Colour sum = Colour::Zero();
    for (const AreaLight& light : scene_.lights) sum += light.radiance * seen(sample, light);
    return sum;
  }

  // The integral over the light of both cosines over r² and pi: without shadows from the first
  // rays' ends, times the share that is seen. A quarter of the rays first; where they agree that
  // all is seen or nothing is, the others are spared.
  float seen(const Sample& sample, const AreaLight& light) const {
    constexpr int kFirst = 2;  // packets
    const Vector3f cross = light.u.cross(light.v);
    const float area = 4 * cross.norm();
    const Vector3f light_normal = cross / (0.25f * area);
    float all = 0, open = 0, unshadowed = 0;
    bool blocked = false;
    for (int p = 0; p < kGrid; ++p) {
      RayCaster::Packet packet;
      std::array<float, kPacket> weight{};
      float sum = 0;
      // A row each, and columns such that any packet is spread evenly, and the first two together.
      for (int row = 0; row < kGrid; ++row) {
        const auto k = std::size_t(row);
        const int column = (3 * row + 4 * p + p / 2) % kGrid;
        const float a = (float(column) + 0.5f) * 2 / kGrid - 1;
        const float b = (float(row) + 0.5f) * 2 / kGrid - 1;
        const Vector3f to = light.centre + a * light.u + b * light.v - sample.position;
        const float r2 = to.squaredNorm();
        weight[k] =
            std::max(0.f, sample.normal.dot(to)) * std::max(0.f, -light_normal.dot(to)) / (r2 * r2);
        packet.origin[k] = sample.position;
        packet.direction[k] = to;
        packet.active[k] = weight[k] > 0;
        sum += weight[k];
      }
      if (sum > 0) {
        const auto free = caster_.free(packet);
        for (std::size_t k = 0; k < kPacket; ++k) open += free[k] ? weight[k] : 0;
        for (std::size_t k = 0; k < kPacket; ++k) blocked |= packet.active[k] && !free[k];
      }
      all += sum;
      if (p + 1 < kFirst) continue;
      if (p + 1 == kFirst) unshadowed = all / (kFirst * kPacket);
      if (open == 0 || !blocked) break;
    }
    return all > 0 ? open / all * unshadowed * area / float(M_PI) : 0;
  }

  Colour gather(const Sample& sample) const {
    static const std::array<Vector3f, kGather> kDirections = gather_directions();
    const Vector3f& n = sample.normal;
    const Vector3f x =
        (std::abs(n.z()) < 0.9f ? Vector3f::UnitZ() : Vector3f::UnitX()).cross(n).normalized();
    const Vector3f y = n.cross(x);
    Colour sum = Colour::Zero();
    for (int first = 0; first < kGather; first += kPacket) {
      RayCaster::Packet packet;
      std::array<RayHit, kPacket> hits;
      packet.coherent = false;
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
