#include "cairn/evaluation/world_report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace cairn {
namespace {

namespace fs = std::filesystem;

nlohmann::json number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

// "  name           value unit", or a dash where there is no figure.
std::string line(const char* name, const std::optional<double>& value, int decimals,
                 const char* unit, double factor = 1) {
  char text[160];
  if (value) {
    std::snprintf(text, sizeof text, "  %-14s %8.*f %s\n", name, decimals, factor * *value, unit);
  } else {
    std::snprintf(text, sizeof text, "  %-14s        -\n", name);
  }
  return text;
}

nlohmann::json objects_json(const ObjectMetrics& metrics) {
  return {{"found", metrics.found},
          {"missed", metrics.missed},
          {"duplicated", metrics.duplicated},
          {"false", metrics.false_objects},
          {"wrong_class", metrics.wrong_class},
          {"ignored", metrics.ignored},
          {"centre_error", number(metrics.centre_error)},
          {"iou", number(metrics.iou)},
          {"outline_iou", number(metrics.outline_iou)},
          {"axis_error", number(metrics.axis_error)},
          {"rotation_deg", number(metrics.rotation_deg)}};
}

nlohmann::json planes_json(const PlaneMetrics& metrics) {
  return {{"precision", number(metrics.precision)},
          {"recall", number(metrics.recall)},
          {"angle_deg", number(metrics.angle_deg)},
          {"offset", number(metrics.offset)},
          {"correct", metrics.correct},
          {"missed", metrics.missed},
          {"duplicated", metrics.duplicated},
          {"false", metrics.false_planes}};
}

}  // namespace

WorldReport evaluate_world(const fs::path& world, const fs::path& run,
                           const TrajectoryAlignment& alignment,
                           const WorldEvaluationOptions& options) {
  const WorldTruth truth = read_world(world);
  WorldReport report;
  if (const fs::path file = run / "objects.json"; fs::exists(file)) {
    report.objects = object_metrics(truth.objects, aligned(read_found_objects(file), alignment),
                                    options.objects);
  } else {
    report.notes.push_back(file.string() + " is not there, so objects are not judged");
  }
  if (const fs::path file = run / "planes.json"; fs::exists(file)) {
    report.planes =
        plane_metrics(truth.planes, aligned(read_found_planes(file), alignment), options.planes);
  } else {
    report.notes.push_back(file.string() + " is not there, so planes are not judged");
  }
  return report;
}

nlohmann::json to_json(const WorldReport& report) {
  return {{"objects", report.objects ? objects_json(*report.objects) : nlohmann::json()},
          {"planes", report.planes ? planes_json(*report.planes) : nlohmann::json()},
          {"notes", report.notes}};
}

std::string to_table(const WorldReport& report) {
  char text[200];
  std::string table;
  if (report.objects) {
    const ObjectMetrics& m = *report.objects;
    std::snprintf(text, sizeof text,
                  "  objects        %8zu found of %zu (%zu with a wrong class), %zu duplicated, "
                  "%zu false\n",
                  m.found, m.found + m.missed, m.wrong_class, m.duplicated, m.false_objects);
    table += text + line("  centre error", m.centre_error, 4, "m   (median)") +
             line("  3D IoU", m.iou, 3, "    (median, with what encloses it)") +
             line("    of outlines", m.outline_iou, 3, "    (median, with what has its outlines)") +
             line("  axis error", m.axis_error, 1, "%   (median)", 100) +
             line("  rotation", m.rotation_deg, 2, "deg (median, up to symmetry)");
  }
  if (report.planes) {
    const PlaneMetrics& m = *report.planes;
    std::snprintf(text, sizeof text,
                  "  planes         %8zu found of %zu, %zu duplicated, %zu false\n", m.correct,
                  m.correct + m.missed, m.duplicated, m.false_planes);
    table += text + line("  precision", m.precision, 1, "%", 100) +
             line("  recall", m.recall, 1, "%", 100) +
             line("  angle", m.angle_deg, 2, "deg (median)") +
             line("  offset", m.offset, 4, "m   (median)");
  }
  for (const std::string& note : report.notes) table += "  (" + note + ")\n";
  return table;
}

}  // namespace cairn
