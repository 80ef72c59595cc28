#include "bench_ellipsoids.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "cairn/map/stopwatch.h"
#include "cairn/optimization/object_fit.h"
#include "cairn/synthetic/ellipsoid_trial.h"
#include "commands.h"
#include "interrupt.h"

namespace cairn::app {
namespace {

constexpr double kSpansDeg[] = {8, 15, 30, 60, 90};
constexpr double kEdgeSigma = 2.5;    // pixels; more than the noise, for what boxes get wrong
constexpr double kLost = 0.1;         // an overlap below counts as failure
constexpr double kUnboundedAxis = 5;  // metres, as is the distance from where it should be
constexpr double kVanishedAxis = 1e-6;

struct Form {
  const char* name;
  FactorForm form;
  ObjectPrior prior;
};

const Form kForms[] = {
    {"paper", FactorForm::kPaper, {}},
    {"robust, size prior",
     FactorForm::kRobust,
     {.usual = EllipsoidTrial::kUsualAxis, .sigma_size = 0.5, .sigma_shape = 0}},
    {"robust, shape + weak size prior",
     FactorForm::kRobust,
     {.usual = EllipsoidTrial::kUsualAxis, .sigma_size = 1, .sigma_shape = 0.4}},
};

struct NamedWorld {
  TrialWorld world;
  const char* name;
};
constexpr NamedWorld kWorlds[] = {{TrialWorld::kClean, "clean"},
                                  {TrialWorld::kOutliers, "outliers"},
                                  {TrialWorld::kTruncated, "truncated"},
                                  {TrialWorld::kDisplaced, "displaced"}};

// All trials of one span, world and form.
struct Cell {
  double span_deg = 0;
  const char *world = "", *form = "";
  std::vector<double> overlaps, milliseconds;

  double failures() const {
    const auto lost =
        std::count_if(overlaps.begin(), overlaps.end(), [](double v) { return v < kLost; });
    return overlaps.empty() ? 0 : double(lost) / double(overlaps.size());
  }
};

// Between two values it goes in a line; 0 of none.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double place = share * double(values.size() - 1);
  const auto below = std::size_t(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - double(below)) * (values[above] - values[below]);
}

double overlap(const Ellipsoid& truth, const Ellipsoid& fitted) {
  const Eigen::Vector3d& axes = fitted.semi_axes;
  const bool bounded = fitted.T.is_finite() && axes.allFinite() &&
                       axes.maxCoeff() <= kUnboundedAxis && axes.minCoeff() >= kVanishedAxis &&
                       fitted.centre().norm() <= kUnboundedAxis;
  return bounded ? intersection_over_union(truth, fitted) : 0;
}

void run_trial(const EllipsoidTrial& trial, const Form& form, Cell& cell) {
  std::vector<BoxView> views;
  for (const EllipsoidTrial::View& v : trial.views) {
    views.push_back({v.T_cw, v.box, v.cut, kEdgeSigma, v.score});
  }
  ObjectFitOptions options;
  options.form = form.form;
  const Stopwatch watch;
  const ObjectFit fit =
      fit_object(trial.start, views, EllipsoidTrial::kPinhole, form.prior, options);
  const double ms = watch.milliseconds();
  cell.overlaps.push_back(overlap(trial.truth, fit.ellipsoid));
  cell.milliseconds.push_back(ms);
}

nlohmann::json to_json(const Cell& cell) {
  return {{"span_deg", cell.span_deg},
          {"world", cell.world},
          {"form", cell.form},
          {"trials", cell.overlaps.size()},
          {"iou_median", quantile(cell.overlaps, 0.5)},
          {"iou_p10", quantile(cell.overlaps, 0.1)},
          {"failures", cell.failures()},
          {"median_ms", quantile(cell.milliseconds, 0.5)}};
}

void print_row(const Cell& cell) {
  std::printf("%4.0f  %-10s %-32s %7.3f / %.3f %10.1f %10.3f\n", cell.span_deg, cell.world,
              cell.form, quantile(cell.overlaps, 0.5), quantile(cell.overlaps, 0.1),
              100 * cell.failures(), quantile(cell.milliseconds, 0.5));
  std::fflush(stdout);
}

}  // namespace

int bench_ellipsoids(int seeds, bool json) {
  nlohmann::json rows = nlohmann::json::array();
  if (!json) {
    std::printf("ellipsoids fitted to boxes of %d known cameras, %d trials a row\n\n",
                EllipsoidTrial::kViews, seeds);
    std::printf("%4s  %-10s %-32s %15s %10s %10s\n", "span", "boxes", "form", "IoU, 10th p.",
                "lost, %", "ms a fit");
  }
  for (const double span : kSpansDeg) {
    for (const NamedWorld& world : kWorlds) {
      for (const Form& form : kForms) {
        Cell cell{span, world.name, form.name, {}, {}};
        for (int seed = 1; seed <= seeds && !interrupted(); ++seed) {
          run_trial(make_ellipsoid_trial(std::uint64_t(seed), span, world.world), form, cell);
        }
        if (interrupted()) break;
        rows.push_back(to_json(cell));
        if (!json) print_row(cell);
      }
    }
  }
  if (json) {
    std::printf("%s\n", nlohmann::json{{"subject", "ellipsoids"}, {"rows", rows}}.dump(2).c_str());
  }
  return interrupted() ? kInterrupted : kDone;
}

}  // namespace cairn::app
