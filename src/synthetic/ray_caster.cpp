#include "cairn/synthetic/ray_caster.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <limits>
#include <vector>

namespace cairn {
namespace {

using Eigen::Vector3f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

RayHit hit_of(const RTCRayHit& result) {
  RayHit hit;
  if (result.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.distance = result.ray.tfar;
  hit.thing = std::int32_t(result.hit.geomID);
  hit.triangle = result.hit.primID;
  hit.u = result.hit.u, hit.v = result.hit.v;
  hit.normal = {result.hit.Ng_x, result.hit.Ng_y, result.hit.Ng_z};
  return hit;
}

RayHit cast_in(RTCScene scene, const Vector3f& origin, const Vector3f& direction, float nearest) {
  RTCRayHit query{};
  query.ray.org_x = origin.x(), query.ray.org_y = origin.y(), query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x(), query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tnear = nearest;
  query.ray.tfar = kInfinity;
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
  return hit_of(query);
}

// Fills an RTCRay8 and its mask of active rays.
template <typename Ray>
void fill(Ray& ray, int* valid, const RayCaster::Packet& packet, float farthest) {
  for (int i = 0; i < RayCaster::kPacket; ++i) {
    valid[i] = packet.active[i] ? -1 : 0;
    ray.org_x[i] = packet.origin[i].x(), ray.org_y[i] = packet.origin[i].y();
    ray.org_z[i] = packet.origin[i].z();
    ray.dir_x[i] = packet.direction[i].x(), ray.dir_y[i] = packet.direction[i].y();
    ray.dir_z[i] = packet.direction[i].z();
    ray.tnear[i] = packet.nearest;
    ray.tfar[i] = farthest;
    ray.time[i] = 0;
    ray.mask[i] = ~0u;
    ray.id[i] = unsigned(i);
    ray.flags[i] = 0;
  }
}

}  // namespace

struct RayCaster::Impl {
  RTCDevice device = nullptr;
  RTCScene all = nullptr;
  std::vector<RTCScene> single;

  explicit Impl(std::span<const Mesh> meshes) {
    device = rtcNewDevice(nullptr);
    // One thread builds: the tree, and with it the order of ties, must not depend on how many there
    // are. It still takes well under a second. (A device with "threads=1" would keep all of TBB in
    // this process to one thread.)
    tbb::task_arena(1).execute([&] { build(meshes); });
  }

  void build(std::span<const Mesh> meshes) {
    all = rtcNewScene(device);
    rtcSetSceneFlags(all, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const Mesh& mesh = meshes[i];
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                 mesh.vertices.data(), 0, sizeof(Mesh::Vertex),
                                 mesh.vertices.size());
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                 mesh.triangles.data(), 0, sizeof(Mesh::Triangle),
                                 mesh.triangles.size());
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(all, geometry, unsigned(i));
      single.push_back(rtcNewScene(device));
      rtcAttachGeometryByID(single.back(), geometry, unsigned(i));
      rtcCommitScene(single.back());
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(all);
  }

  ~Impl() {
    for (RTCScene scene : single) rtcReleaseScene(scene);
    rtcReleaseScene(all);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
};

RayCaster::RayCaster(std::span<const Mesh> meshes) : impl_(std::make_unique<Impl>(meshes)) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

RayHit RayCaster::cast(const Vector3f& origin, const Vector3f& direction, float nearest) const {
  return cast_in(impl_->all, origin, direction, nearest);
}

RayHit RayCaster::cast_at(std::int32_t thing, const Vector3f& origin,
                          const Vector3f& direction) const {
  return cast_in(impl_->single[std::size_t(thing)], origin, direction, 0);
}

void RayCaster::cast(const Packet& rays, std::array<RayHit, kPacket>& hits) const {
  alignas(32) int valid[kPacket];
  RTCRayHit8 query;
  fill(query.ray, valid, rays, kInfinity);
  for (int i = 0; i < kPacket; ++i) {
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (rays.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, impl_->all, &context, &query);
  for (int i = 0; i < kPacket; ++i) {
    const bool found = rays.active[i] && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    hits[i].thing = found ? std::int32_t(query.hit.geomID[i]) : RayHit::kNothing;
    hits[i].triangle = query.hit.primID[i];
    hits[i].distance = query.ray.tfar[i];
    hits[i].u = query.hit.u[i], hits[i].v = query.hit.v[i];
    hits[i].normal = {query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]};
  }
}

std::array<bool, RayCaster::kPacket> RayCaster::free(const Packet& segments) const {
  alignas(32) int valid[kPacket];
  RTCRay8 query;
  fill(query, valid, segments, 1.0f);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, impl_->all, &context, &query);
  std::array<bool, kPacket> free{};
  for (int i = 0; i < kPacket; ++i) free[i] = segments.active[i] && query.tfar[i] >= 0;
  return free;
}

}  // namespace cairn
