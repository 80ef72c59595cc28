#include "cairn/evaluation/found_landmarks.h"

#include "cairn/evaluation/checked_json.h"

namespace cairn {

std::vector<FoundObject> read_found_objects(const std::filesystem::path& file) {
  const auto json =
      CheckedJson::read(file, "the objects of a run, which `cairn run` writes with po and full");
  std::vector<FoundObject> objects;
  for (const CheckedJson& value : json.at("objects").list()) {
    FoundObject object;
    object.id = value.at("id").integer();
    object.class_name = value.at("class").text();
    object.score = value.at("score").number();
    object.ellipsoid = {SE3(value.at("rotation").rotation(), value.at("center").vector3()),
                        value.at("semi_axes").lengths()};
    objects.push_back(object);
  }
  return objects;
}

std::vector<FoundPlane> read_found_planes(const std::filesystem::path& file) {
  const auto json = CheckedJson::read(
      file, "the planes of a run, which `cairn run` writes with pp, ppm and full");
  std::vector<FoundPlane> planes;
  for (const CheckedJson& value : json.at("planes").list()) {
    FoundPlane plane;
    plane.id = value.at("id").integer();
    plane.label = value.at("label").text();
    plane.normal = value.at("normal").unit_vector();
    plane.d = value.at("d").number();
    plane.outline = value.at("outline").outline();
    planes.push_back(plane);
  }
  return planes;
}

FoundObject aligned(const FoundObject& object, const TrajectoryAlignment& alignment) {
  FoundObject result = object;
  result.ellipsoid = {alignment * object.ellipsoid.T, alignment.scale * object.ellipsoid.semi_axes};
  return result;
}

FoundPlane aligned(const FoundPlane& plane, const TrajectoryAlignment& alignment) {
  FoundPlane result = plane;
  result.normal = alignment.T.rotation() * plane.normal;
  result.d = alignment.scale * plane.d - result.normal.dot(alignment.T.translation());
  for (Eigen::Vector3d& corner : result.outline) corner = alignment * corner;
  return result;
}

}  // namespace cairn
