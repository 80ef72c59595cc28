#include "cairn/evaluation/checked_json.h"

#include <cmath>
#include <fstream>

#include "cairn/geometry/error.h"

namespace cairn {

CheckedJson CheckedJson::read(const std::filesystem::path& file, const std::string& what) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw Error(Error::Kind::kInput, file.string() + ": cannot be read as " + what);
  }
  auto value = nlohmann::json::parse(stream, nullptr, false);
  if (value.is_discarded() || !value.is_object()) {
    throw Error(Error::Kind::kInput,
                file.string() + ": is no JSON object, as it should be as " + what);
  }
  return {file.string(), std::move(value)};
}

void CheckedJson::refuse(const std::string& why) const {
  throw Error(Error::Kind::kInput, where_ + ": " + why);
}

bool CheckedJson::has(const std::string& key) const {
  return value_.is_object() && value_.contains(key) && !value_.at(key).is_null();
}

CheckedJson CheckedJson::at(const std::string& key) const {
  if (!has(key)) refuse("\"" + key + "\" is missing; write the file again");
  const bool root = where_.find(": ") == std::string::npos;
  return {where_ + (root ? ": " : ".") + key, value_.at(key)};
}

std::vector<CheckedJson> CheckedJson::list() const {
  if (!value_.is_array()) refuse("is no list");
  std::vector<CheckedJson> items;
  for (std::size_t i = 0; i < value_.size(); ++i) {
    items.push_back({where_ + "[" + std::to_string(i) + "]", value_[i]});
  }
  return items;
}

double CheckedJson::number() const {
  if (!value_.is_number() || !std::isfinite(value_.get<double>())) {
    refuse(value_.dump() + " is not a finite number");
  }
  return value_.get<double>();
}

int CheckedJson::integer() const {
  const double value = number();
  if (value != std::round(value) || std::abs(value) > 1e9) refuse(value_.dump() + " is no integer");
  return int(value);
}

std::string CheckedJson::text() const {
  if (!value_.is_string()) refuse(value_.dump() + " is no text");
  return value_.get<std::string>();
}

std::vector<double> CheckedJson::numbers(std::size_t count) const {
  const auto items = list();
  if (items.size() != count) {
    refuse(std::to_string(items.size()) + " numbers in place of " + std::to_string(count));
  }
  std::vector<double> values;
  values.reserve(count);
  for (const CheckedJson& item : items) values.push_back(item.number());
  return values;
}

Eigen::Vector3d CheckedJson::vector3() const { return Eigen::Vector3d(numbers(3).data()); }

Eigen::Vector3d CheckedJson::unit_vector() const {
  const Eigen::Vector3d v = vector3();
  if (!(std::abs(v.norm() - 1) < 1e-3)) refuse(value_.dump() + " is not of unit length");
  return v.normalized();
}

Eigen::Vector3d CheckedJson::lengths() const {
  Eigen::Vector3d v = vector3();
  if (!(v.minCoeff() > 0)) refuse(value_.dump() + " are not three positive lengths");
  return v;
}

Eigen::Quaterniond CheckedJson::rotation() const {
  const auto q = numbers(4);
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (!(std::abs(rotation.norm() - 1) < 1e-3)) {
    refuse(value_.dump() + " is no unit quaternion [qx, qy, qz, qw]");
  }
  return rotation.normalized();
}

std::vector<Eigen::Vector3d> CheckedJson::points() const {
  std::vector<Eigen::Vector3d> points;
  for (const CheckedJson& item : list()) points.push_back(item.vector3());
  return points;
}

std::vector<Eigen::Vector3d> CheckedJson::outline() const {
  const std::vector<Eigen::Vector3d> corners = points();
  if (corners.size() < 3) refuse("an outline has three corners at least");
  return corners;
}

}  // namespace cairn
