#include "cairn/synthetic/models/assembly.h"

#include <numbers>
#include <utility>

namespace cairn {

Eigen::Isometry3f at(float x, float y, float z) {
  Eigen::Isometry3f place = Eigen::Isometry3f::Identity();
  place.translation() = Eigen::Vector3f(x, y, z);
  return place;
}

Eigen::Isometry3f turned(const Eigen::Vector3f& axis, float degrees) {
  Eigen::Isometry3f place = Eigen::Isometry3f::Identity();
  place.linear() =
      Eigen::AngleAxisf(degrees * std::numbers::pi_v<float> / 180, axis.normalized()).matrix();
  return place;
}

Assembly::Assembly(std::string_view class_name, Symmetry symmetry) {
  model_.class_name = class_name;
  model_.symmetry = symmetry;
}

std::uint32_t Assembly::material(const Material& material) { return model_.mesh.add(material); }

void Assembly::add(const Mesh& part, std::initializer_list<std::uint32_t> materials,
                   const Eigen::Isometry3f& place) {
  const std::size_t first = model_.mesh.triangles.size();
  Mesh bare;
  bare.vertices = part.vertices;
  bare.triangles = part.triangles;
  for (Mesh::Triangle& t : bare.triangles) t.material = materials.begin()[t.material];
  model_.mesh.append(bare, place);
  // append() numbers materials after those that are there; these are those that are there.
  for (std::size_t i = first; i < model_.mesh.triangles.size(); ++i)
    model_.mesh.triangles[i].material = bare.triangles[i - first].material;
}

void Assembly::add(const Mesh& part, std::uint32_t material, const Eigen::Isometry3f& place) {
  add(part, {material}, place);
}

Model Assembly::finish() && {
  Eigen::AlignedBox3f bounds;
  for (const Mesh::Vertex& v : model_.mesh.vertices) bounds.extend(v.position);
  const Eigen::Vector3f origin(bounds.center().x(), bounds.center().y(), bounds.min().z());
  for (Mesh::Vertex& v : model_.mesh.vertices) v.position -= origin;
  return std::move(model_);
}

}  // namespace cairn
