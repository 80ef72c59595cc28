#include "cairn/output/planes_json.h"

#include <nlohmann/json.hpp>
#include <numbers>

#include "cairn/output/atomic_file.h"

namespace cairn {
namespace {

nlohmann::json list(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void write_planes(const std::filesystem::path& file, std::span<const MappedPlane> planes) {
  nlohmann::ordered_json root;
  root["planes"] = nlohmann::ordered_json::array();
  for (const MappedPlane& plane : planes) {
    nlohmann::ordered_json json;
    json["id"] = plane.id;
    json["label"] = plane.label;
    json["normal"] = list(plane.normal);
    json["d"] = plane.d;
    json["outline"] = nlohmann::ordered_json::array();
    for (const Eigen::Vector3d& corner : plane.outline)
      json["outline"].push_back(nlohmann::ordered_json(list(corner)));
    json["sigma_angle_deg"] = plane.sigma_angle * 180 / std::numbers::pi;
    json["points"] = plane.points;
    json["sightings"] = plane.sightings;
    json["keyframes"] = plane.seen;
    json["parallel"] = plane.parallel;
    json["perpendicular"] = plane.perpendicular;
    json["coplanar"] = plane.coplanar;
    root["planes"].push_back(std::move(json));
  }
  write_file(file, root.dump(1) + "\n");
}

}  // namespace cairn
