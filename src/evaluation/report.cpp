// How an evaluation is shown: JSON for scripts, a table for people.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cairn/evaluation/evaluation.h"

namespace cairn {
namespace {

nlohmann::json number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json relative(const RelativeError& error) {
  return {{"translation", number(error.translation)},
          {"rotation_deg", number(error.rotation_deg)},
          {"pairs", error.pairs}};
}

template <typename... Values>
std::string line(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string relative_line(const char* name, const RelativeError& error) {
  if (!error.translation) return line("  RPE %-9s  -         (no such pair of poses)\n", name);
  return line("  RPE %-9s  %8.4f m  %7.3f deg  (%zu pairs)\n", name, *error.translation,
              *error.rotation_deg, error.pairs);
}

}  // namespace

nlohmann::json to_json(const EvaluationReport& report) {
  return {{"pairs", report.pairs},
          {"frames_with_groundtruth", report.frames_with_truth},
          {"coverage", report.coverage},
          {"align", to_string(report.options.alignment)},
          {"scale", report.scale},
          {"scale_error", number(report.scale_error)},
          {"scale_sigma", number(report.scale_sigma)},
          {"ate",
           {{"rmse", report.ate.rmse},
            {"median", report.ate.median},
            {"max", report.ate.max},
            {"mean", report.ate.mean}}},
          {"rpe",
           {{"frame", relative(report.frame)},
            {"second", relative(report.second)},
            {"metre", relative(report.metre)}}}};
}

std::string to_table(const EvaluationReport& report) {
  std::string table;
  table += line("  pairs          %8zu\n", report.pairs);
  table += line("  coverage       %8.1f %%  of %zu frames with ground truth\n",
                100 * report.coverage, report.frames_with_truth);
  table += line("  scale          %8.4f    (%s)\n", report.scale,
                report.options.alignment == Alignment::kSim3  ? "sim3 alignment"
                : report.options.alignment == Alignment::kSE3 ? "se3 alignment: not fitted"
                                                              : "no alignment");
  if (report.scale_error) {
    table += line("  scale error    %8.2f %%", 100 * *report.scale_error);
    if (report.scale_sigma) {
      table += line("  (the run's own sigma: %.2f %%)", 100 * *report.scale_sigma);
    }
    table += "\n";
  }
  table += line("  ATE RMSE       %8.4f m\n", report.ate.rmse);
  table += line("  ATE median     %8.4f m\n", report.ate.median);
  table += line("  ATE max        %8.4f m\n", report.ate.max);
  table += relative_line("1 frame", report.frame);
  table += relative_line("1 s", report.second);
  table += relative_line("1 m", report.metre);
  return table;
}

}  // namespace cairn
