#include "cairn/geometry/five_point.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "cairn/geometry/real_roots.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Polynomials in the unknowns x, y, z of E = x X + y Y + z Z + W, as coefficients of the monomials
// below. The cubic ones stand in Nistér's order: the first ten are eliminated.
using Linear = Eigen::Matrix<double, 4, 1>;
using Quadratic = Eigen::Matrix<double, 10, 1>;
using Cubic = Eigen::Matrix<double, 20, 1>;

struct Monomial {
  int x, y, z;
  constexpr bool operator==(const Monomial&) const = default;
};
constexpr Monomial kLinear[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
constexpr Monomial kQuadratic[10] = {{2, 0, 0}, {1, 1, 0}, {0, 2, 0}, {1, 0, 1}, {0, 1, 1},
                                     {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
constexpr Monomial kCubic[20] = {{3, 0, 0}, {0, 3, 0}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1},
                                 {2, 0, 0}, {0, 2, 1}, {0, 2, 0}, {1, 1, 1}, {1, 1, 0},
                                 {1, 0, 2}, {1, 0, 1}, {1, 0, 0}, {0, 1, 2}, {0, 1, 1},
                                 {0, 1, 0}, {0, 0, 3}, {0, 0, 2}, {0, 0, 1}, {0, 0, 0}};

// Where the product of monomial i of `A` and monomial j of the linear ones stands in `C`.
template <int NA, int NC>
constexpr std::array<std::array<int, 4>, NA> product_table(const Monomial (&A)[NA],
                                                           const Monomial (&C)[NC]) {
  std::array<std::array<int, 4>, NA> table{};
  for (int i = 0; i < NA; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Monomial product{A[i].x + kLinear[j].x, A[i].y + kLinear[j].y, A[i].z + kLinear[j].z};
      for (int k = 0; k < NC; ++k) {
        if (C[k] == product) table[i][j] = k;
      }
    }
  }
  return table;
}
constexpr auto kLinearTimesLinear = product_table(kLinear, kQuadratic);
constexpr auto kQuadraticTimesLinear = product_table(kQuadratic, kCubic);

// sum += sign * a * b
void add_product(const Linear& a, const Linear& b, double sign, Quadratic& sum) {
  for (int i = 0; i < 4; ++i) {
    const double s = sign * a[i];
    for (int j = 0; j < 4; ++j) sum[kLinearTimesLinear[i][j]] += s * b[j];
  }
}

void add_product(const Quadratic& a, const Linear& b, Cubic& sum) {
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 4; ++j) sum[kQuadraticTimesLinear[i][j]] += a[i] * b[j];
  }
}

using Entries = std::array<std::array<Linear, 3>, 3>;

// det E = 0 and 2 E Eᵀ E - tr(E Eᵀ) E = 0: ten cubic equations, one a row.
Eigen::Matrix<double, 10, 20> constraints(const Entries& E) {
  Eigen::Matrix<double, 10, 20> rows;
  std::array<std::array<Quadratic, 3>, 3> L;
  Quadratic half_trace = Quadratic::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      L[i][j].setZero();
      for (int k = 0; k < 3; ++k) add_product(E[i][k], E[j][k], 1, L[i][j]);
      L[j][i] = L[i][j];
    }
    half_trace += 0.5 * L[i][i];
  }
  for (int i = 0; i < 3; ++i) L[i][i] -= half_trace;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Cubic sum = Cubic::Zero();
      for (int k = 0; k < 3; ++k) add_product(L[i][k], E[k][j], sum);
      rows.row(3 * i + j) = sum;
    }
  }
  Cubic determinant = Cubic::Zero();
  for (int j = 0; j < 3; ++j) {
    const int a = (j + 1) % 3, b = (j + 2) % 3;
    Quadratic minor = Quadratic::Zero();
    add_product(E[1][a], E[2][b], 1, minor);
    add_product(E[1][b], E[2][a], -1, minor);
    add_product(minor, E[0][j], determinant);
  }
  rows.row(9) = determinant;
  return rows;
}

// Polynomials in z alone, ascending. An entry of Nistér's 3x3 matrix B has degree 4 at most.
using Quartic = std::array<double, 5>;
using Degree10 = std::array<double, 11>;

// Row e - z f of B, from two rows of the reduced system (eq. 20-25 of the paper).
std::array<Quartic, 3> eliminate(const Eigen::Matrix<double, 10, 1>& e,
                                 const Eigen::Matrix<double, 10, 1>& f) {
  std::array<Quartic, 3> row{};
  for (int block = 0; block < 3; ++block) {
    const int first = 3 * block, n = block < 2 ? 3 : 4;  // z^(n-1) ... 1
    for (int i = 0; i < n; ++i) {
      row[block][n - 1 - i] += e[first + i];
      row[block][n - i] -= f[first + i];
    }
  }
  return row;
}

double evaluate(const Quartic& p, double z) {
  return p[0] + z * (p[1] + z * (p[2] + z * (p[3] + z * p[4])));
}

Degree10 determinant(const std::array<std::array<Quartic, 3>, 3>& B) {
  Degree10 det{};
  for (int r = 0; r < 3; ++r) {
    const Quartic &a0 = B[(r + 1) % 3][0], &a1 = B[(r + 1) % 3][1];
    const Quartic &b0 = B[(r + 2) % 3][0], &b1 = B[(r + 2) % 3][1];
    std::array<double, 7> minor{};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) minor[i + j] += a0[i] * b1[j] - a1[i] * b0[j];
    }
    for (int i = 0; i < 7; ++i) {
      for (int j = 0; j < 5; ++j) det[i + j] += minor[i] * B[r][2][j];
    }
  }
  return det;
}

// (x, y, 1) up to scale: the null vector of B(z), from the best conditioned pair of rows.
Vector3d null_vector(const std::array<std::array<Quartic, 3>, 3>& B, double z) {
  Matrix3d M;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) M(i, j) = evaluate(B[i][j], z);
    M.row(i).normalize();
  }
  Vector3d best = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3d v = M.row(i).cross(M.row((i + 1) % 3));
    if (v.squaredNorm() > best.squaredNorm()) best = v;
  }
  return best;
}

}  // namespace

EssentialCandidates five_point(const std::array<Vector3d, 5>& rays1,
                               const std::array<Vector3d, 5>& rays2) {
  Eigen::Matrix<double, 9, 5> equations;  // row-major E
  for (int i = 0; i < 5; ++i) {
    for (int r = 0; r < 3; ++r) equations.block<3, 1>(3 * r, i) = rays2[i][r] * rays1[i];
  }
  const Eigen::Matrix<double, 9, 9> Q =
      Eigen::HouseholderQR<Eigen::Matrix<double, 9, 5>>(equations).householderQ();
  const Eigen::Matrix<double, 9, 4> basis = Q.rightCols<4>();
  Entries E;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) E[r][c] = basis.row(3 * r + c);
  }
  const Eigen::Matrix<double, 10, 20> A = constraints(E);
  const Eigen::Matrix<double, 10, 10> reduced =
      A.leftCols<10>().partialPivLu().solve(A.rightCols<10>());
  if (!reduced.allFinite()) return {};
  const std::array<std::array<Quartic, 3>, 3> B = {eliminate(reduced.row(4), reduced.row(5)),
                                                   eliminate(reduced.row(6), reduced.row(7)),
                                                   eliminate(reduced.row(8), reduced.row(9))};

  EssentialCandidates found;
  const RealRoots roots = real_roots(determinant(B));
  for (int i = 0; i < roots.count; ++i) {
    const double z = roots.values[i];
    const Vector3d xy1 = null_vector(B, z);
    if (!(std::abs(xy1.z()) > 1e-12)) continue;
    const Eigen::Vector4d weights(xy1.x() / xy1.z(), xy1.y() / xy1.z(), z, 1.0);
    const Eigen::Matrix<double, 9, 1> e = (basis * weights).normalized();
    if (!e.allFinite()) continue;
    found.matrices[found.count++] =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(e.data());
  }
  return found;
}

}  // namespace cairn
