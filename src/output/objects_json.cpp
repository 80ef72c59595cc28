#include "cairn/output/objects_json.h"

#include <nlohmann/json.hpp>

#include "cairn/output/atomic_file.h"

namespace cairn {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json rows(const Eigen::Matrix3d& m) { return {list(m.row(0)), list(m.row(1)), list(m.row(2))}; }

void add_ellipsoid(const Ellipsoid& ellipsoid, Json& json) {
  const Eigen::Quaterniond& q = ellipsoid.T.rotation();
  json["center"] = list(ellipsoid.centre());
  json["rotation"] = {q.x(), q.y(), q.z(), q.w()};
  json["semi_axes"] = list(ellipsoid.semi_axes);
}

}  // namespace

void write_objects(const std::filesystem::path& file, std::span<const MappedObject> objects) {
  Json root;
  root["objects"] = Json::array();
  for (const MappedObject& object : objects) {
    Json json;
    json["id"] = object.id;
    json["class"] = object.class_name;
    json["score"] = object.score;
    add_ellipsoid(object.ellipsoid, json);
    json["covariance"] = rows(object.covariance);
    json["reference"]["time"] = object.reference_time;
    add_ellipsoid(object.in_reference, json["reference"]);
    json["points"] = object.points;
    json["sightings"] = object.sightings;
    json["keyframes"] = object.seen;
    json["support"] = object.plane < 0 ? Json(nullptr) : Json(object.plane);
    root["objects"].push_back(std::move(json));
  }
  // A card may call its classes as it likes.
  write_file(file, root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace cairn
