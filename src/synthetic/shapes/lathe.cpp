#include "cairn/synthetic/shapes/lathe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/synthetic/shapes/curve.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Eigen::Vector2f at(const ProfilePoint& p) { return {p.r, p.z}; }

// Outward normal of the piece from `a` to `b`, in the plane of the profile.
Eigen::Vector2f outward(const ProfilePoint& a, const ProfilePoint& b) {
  const Eigen::Vector2f along = at(b) - at(a);
  return Eigen::Vector2f(along.y(), -along.x()).normalized();
}

// One run of one material that is smooth all along: a patch with its normals.
struct Strip {
  std::vector<ProfilePoint> points;
  std::vector<Eigen::Vector2f> normals;
};

std::vector<Strip> strips(std::span<const ProfilePoint> profile, float crease_deg) {
  const float least_cosine = std::cos(crease_deg * kPi / 180);
  const int pieces = int(profile.size()) - 1;
  const auto normal_of = [&](int i) { return outward(profile[i], profile[i + 1]); };
  const auto sharp = [&](int i) {  // at the point between the pieces i - 1 and i
    return i == 0 || i == pieces || normal_of(i - 1).dot(normal_of(i)) < least_cosine;
  };
  std::vector<Strip> result;
  for (int i = 0; i < pieces; ++i) {
    if (sharp(i) || profile[i].material != profile[i - 1].material) result.emplace_back();
    const auto smooth_normal = [&](int point, int piece) {
      if (sharp(point)) return normal_of(piece);
      return Eigen::Vector2f((normal_of(point - 1) + normal_of(point)).normalized());
    };
    Strip& strip = result.back();
    if (strip.points.empty()) {
      strip.points.push_back(profile[i]);
      strip.normals.push_back(smooth_normal(i, i));
    }
    strip.points.push_back(profile[i + 1]);
    strip.points.back().material = profile[i].material;
    strip.normals.push_back(smooth_normal(i + 1, i));
  }
  return result;
}

// Where each strip starts and how wide its run of one material is, to unroll the texture.
struct Run {
  float length = 0, radius = 0;
};

void add_strip(Mesh& mesh, const Strip& strip, const Run& run, float start, int segments) {
  std::vector<float> travelled{0};
  for (std::size_t i = 1; i < strip.points.size(); ++i)
    travelled.push_back(travelled.back() + (at(strip.points[i]) - at(strip.points[i - 1])).norm());
  const int rows = int(strip.points.size());
  add_patch(
      mesh, rows, segments + 1,
      [&](int row, int column) {
        const int i = rows - 1 - row;
        const float angle = 2 * kPi * float(column % segments) / float(segments) - kPi;
        const Eigen::Vector3f out(std::cos(angle), std::sin(angle), 0);
        Mesh::Vertex v;
        v.position = strip.points[i].r * out + strip.points[i].z * Eigen::Vector3f::UnitZ();
        v.normal = strip.normals[i].x() * out + strip.normals[i].y() * Eigen::Vector3f::UnitZ();
        v.uv = {2 * kPi * float(column) / float(segments) * run.radius,
                run.length - start - travelled[i]};
        return v;
      },
      strip.points.front().material);
}

}  // namespace

Mesh lathe(std::span<const ProfilePoint> profile, int segments, float crease_deg) {
  Mesh mesh;
  const std::vector<Strip> all = strips(profile, crease_deg);
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first;
    Run run;
    std::vector<float> starts;
    for (; last < all.size() &&
           all[last].points.front().material == all[first].points.front().material;
         ++last) {
      starts.push_back(run.length);
      const auto& points = all[last].points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        run.radius = std::max(run.radius, points[i].r);
        if (i > 0) run.length += (at(points[i]) - at(points[i - 1])).norm();
      }
    }
    for (std::size_t s = first; s < last; ++s)
      add_strip(mesh, all[s], run, starts[s - first], segments);
    first = last;
  }
  return mesh;
}

Profile round_profile(std::span<const ProfilePoint> profile, float radius, int steps,
                      float crease_deg) {
  const float least_cosine = std::cos(crease_deg * kPi / 180);
  Profile rounded{profile.front()};
  for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
    const Eigen::Vector2f corner = at(profile[i]);
    const Eigen::Vector2f back = at(profile[i - 1]) - corner, ahead = at(profile[i + 1]) - corner;
    if (-back.normalized().dot(ahead.normalized()) > least_cosine) {
      rounded.push_back(profile[i]);
      continue;
    }
    const float reach = std::min({radius, 0.48f * back.norm(), 0.48f * ahead.norm()});
    const Eigen::Vector2f from = corner + reach * back.normalized();
    const Eigen::Vector2f to = corner + reach * ahead.normalized();
    for (int k = 0; k <= steps; ++k) {
      const float t = float(k) / float(steps);
      const Eigen::Vector2f p = (1 - t) * (1 - t) * from + 2 * t * (1 - t) * corner + t * t * to;
      rounded.push_back({p.x(), p.y(), profile[k < steps ? i - 1 : i].material});
    }
  }
  rounded.push_back(profile.back());
  return rounded;
}

Profile smooth_profile(std::span<const ProfilePoint> profile, int steps) {
  std::vector<Eigen::Vector2f> points;
  for (const ProfilePoint& p : profile) points.push_back(at(p));
  const std::vector<Eigen::Vector2f> curve = smooth(points, steps);
  Profile result;
  for (std::size_t i = 0; i < curve.size(); ++i)
    result.push_back({std::max(0.0f, curve[i].x()), curve[i].y(), profile[i / steps].material});
  return result;
}

Mesh ball(float radius, int segments) {
  Profile profile;
  for (const float angle : evenly(-kPi / 2, kPi / 2, segments / 2 + 1))
    profile.push_back({radius * std::cos(angle), radius * (1 + std::sin(angle))});
  profile.front().r = profile.back().r = 0;
  return lathe(profile, segments);
}

}  // namespace cairn
