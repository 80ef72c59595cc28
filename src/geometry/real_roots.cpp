#include "cairn/geometry/real_roots.h"

#include <cmath>
#include <utility>

namespace cairn {
namespace {

using Coefficients = std::array<double, kMaxPolynomialDegree + 1>;

double evaluate(const Coefficients& c, int degree, double x) {
  double value = c[degree];
  for (int i = degree - 1; i >= 0; --i) value = value * x + c[i];
  return value;
}

// Value and slope in one Horner pass.
std::pair<double, double> evaluate_slope(const Coefficients& c, int degree, double x) {
  double value = c[degree], slope = 0;
  for (int i = degree - 1; i >= 0; --i) {
    slope = slope * x + value;
    value = value * x + c[i];
  }
  return {value, slope};
}

// The one root in [lo, hi], where the polynomial changes its sign: Newton's steps, and bisection
// whenever a step would leave the bracket.
double root_in_bracket(const Coefficients& c, int degree, double lo, double hi, bool rising) {
  double x = 0.5 * (lo + hi);
  for (int i = 0; i < 60; ++i) {
    const auto [value, slope] = evaluate_slope(c, degree, x);
    if (value == 0) return x;
    if ((value > 0) == rising) {
      hi = x;
    } else {
      lo = x;
    }
    double next = x - value / slope;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (std::abs(next - x) < 1e-15) return next;
    x = next;
  }
  return x;
}

// Roots in [-1, 1], ascending.
RealRoots roots_in_unit_interval(const Coefficients& c, int degree) {
  std::array<Coefficients, kMaxPolynomialDegree + 1> derivatives;  // by degree
  derivatives[degree] = c;
  for (int k = degree - 1; k >= 1; --k) {
    for (int i = 0; i <= k; ++i) derivatives[k][i] = derivatives[k + 1][i + 1] * (i + 1);
  }
  RealRoots critical;
  for (int k = 1; k <= degree; ++k) {
    RealRoots found;
    double lo = -1, at_lo = evaluate(derivatives[k], k, lo);
    for (int i = 0; i <= critical.count; ++i) {
      const double hi = i < critical.count ? critical.values[i] : 1.0;
      const double at_hi = evaluate(derivatives[k], k, hi);
      if ((at_lo < 0 && at_hi >= 0) || (at_lo > 0 && at_hi <= 0)) {
        if (found.count < k) {
          found.values[found.count++] = root_in_bracket(derivatives[k], k, lo, hi, at_lo < 0);
        }
      }
      lo = hi;
      at_lo = at_hi;
    }
    critical = found;
  }
  return critical;
}

}  // namespace

RealRoots real_roots(std::span<const double> coefficients) {
  int degree = static_cast<int>(coefficients.size()) - 1;
  double largest = 0;
  for (const double c : coefficients) {
    if (!std::isfinite(c)) return {};
    largest = std::max(largest, std::abs(c));
  }
  while (degree > 0 && std::abs(coefficients[degree]) <= 1e-300 * largest) --degree;
  if (degree < 1 || degree > kMaxPolynomialDegree) return {};

  Coefficients forward{}, backward{};
  for (int i = 0; i <= degree; ++i) {
    forward[i] = coefficients[i] / largest;
    backward[degree - i] = forward[i];
  }
  RealRoots roots = roots_in_unit_interval(forward, degree);
  const RealRoots reciprocals = roots_in_unit_interval(backward, degree);
  for (int i = 0; i < reciprocals.count && roots.count < degree; ++i) {
    const double r = reciprocals.values[i];
    if (r != 0 && std::abs(r) < 1) roots.values[roots.count++] = 1 / r;
  }
  return roots;
}

}  // namespace cairn
