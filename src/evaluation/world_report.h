#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cairn/evaluation/object_metrics.h"
#include "cairn/evaluation/plane_metrics.h"

namespace cairn {

struct WorldEvaluationOptions {
  ObjectMetricsOptions objects;
  PlaneMetricsOptions planes;
};

/// How a run's objects and planes compare with those of a known world.
struct WorldReport {
  std::optional<ObjectMetrics> objects;  ///< none where the run left no objects.json
  std::optional<PlaneMetrics> planes;    ///< none where it left no planes.json
  std::vector<std::string> notes;        ///< why a part is not given, a sentence each
};

/// Reads objects.json and planes.json of the run. `alignment`: what the trajectory got. Throws
/// Error(kInput) where a file that is there cannot be understood.
WorldReport evaluate_world(const std::filesystem::path& world, const std::filesystem::path& run,
                           const TrajectoryAlignment& alignment,
                           const WorldEvaluationOptions& options = {});

/// The keys of the contract: objects.{found, missed, duplicated, false, wrong_class, ignored,
/// centre_error, iou, outline_iou, axis_error, rotation_deg} and planes.{precision, recall,
/// angle_deg, offset, correct, missed, duplicated, false}; "objects" or "planes" is null where it
/// is not given. Null as well where there is no figure.
nlohmann::json to_json(const WorldReport& report);

/// A table for people.
std::string to_table(const WorldReport& report);

}  // namespace cairn
