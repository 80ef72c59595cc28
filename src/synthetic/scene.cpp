#include "cairn/synthetic/scene.h"

#include "cairn/geometry/error.h"
#include "cairn/synthetic/scenes/makers.h"

namespace cairn {

Scene make_scene(SceneKind kind, std::uint64_t seed) {
  switch (kind) {
    case SceneKind::kDesk:
      return make_desk(seed);
    case SceneKind::kRoom:
      return make_room(seed);
    case SceneKind::kCorridor:
      return make_corridor(seed);
    case SceneKind::kStreet:
      break;
  }
  return make_street(seed);
}

SceneKind parse_scene_kind(const std::string& name) {
  using enum SceneKind;
  for (const auto& [known, kind] :
       {std::pair("desk", kDesk), std::pair("room", kRoom), std::pair("corridor", kCorridor),
        std::pair("street", kStreet)}) {
    if (name == known) return kind;
  }
  throw Error(Error::Kind::kUsage,
              "--scene " + name + ": there is no such scene; use desk, room, corridor or street");
}

std::vector<Mesh> placed_meshes(const Scene& scene) {
  std::vector<Mesh> meshes;
  for (const WorldThing& thing : scene.things) {
    Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
    T.linear() = thing.T_wo.matrix3().cast<float>();
    T.translation() = thing.T_wo.translation().cast<float>();
    meshes.emplace_back();
    meshes.back().append(thing.model.mesh, T);
  }
  return meshes;
}

}  // namespace cairn
