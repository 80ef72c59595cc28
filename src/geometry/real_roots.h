#pragma once

#include <array>
#include <span>

namespace cairn {

constexpr int kMaxPolynomialDegree = 10;

/// The real roots of a polynomial, up to `kMaxPolynomialDegree`.
struct RealRoots {
  std::array<double, kMaxPolynomialDegree> values{};
  int count = 0;
};

/// All real roots of odd multiplicity of c[0] + c[1] x + ... + c[n] x^n. Between two neighbouring
/// roots of its derivative a polynomial is monotonic, so the roots of the derivatives, from the
/// lowest degree up, bracket every root; each is polished by Newton's method inside its bracket.
/// Roots beyond [-1, 1] are found as reciprocals, which keeps all powers small. Coefficients that
/// are not finite give no roots.
RealRoots real_roots(std::span<const double> coefficients);

}  // namespace cairn
