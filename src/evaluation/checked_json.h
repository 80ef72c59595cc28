#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cairn {

/// A value in a JSON file that knows where it stands, so that what is wrong with it can be said in
/// a sentence: "world.json: objects[3].center: ...". Every getter throws Error(kInput).
class CheckedJson {
 public:
  /// Reads a file. `what` it should be, with an article, and what to do where it is not there:
  /// "the ground truth of a world; `cairn synth` writes it".
  static CheckedJson read(const std::filesystem::path& file, const std::string& what);

  bool has(const std::string& key) const;  ///< and it is not null
  CheckedJson at(const std::string& key) const;
  std::vector<CheckedJson> list() const;

  double number() const;  ///< finite
  int integer() const;
  std::string text() const;
  std::vector<double> numbers(std::size_t count) const;  ///< exactly so many, finite
  Eigen::Vector3d vector3() const;
  Eigen::Vector3d unit_vector() const;  ///< normalised; refuses what is far from unit length
  Eigen::Vector3d lengths() const;      ///< three positive numbers
  Eigen::Quaterniond rotation() const;  ///< [qx, qy, qz, qw], of about unit length
  std::vector<Eigen::Vector3d> points() const;
  std::vector<Eigen::Vector3d> outline() const;  ///< points, three at least

  [[noreturn]] void refuse(const std::string& why) const;

 private:
  CheckedJson(std::string where, nlohmann::json value)
      : where_(std::move(where)), value_(std::move(value)) {}

  std::string where_;  // "world.json: objects[3].center"
  nlohmann::json value_;
};

}  // namespace cairn
