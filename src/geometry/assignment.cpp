#include "cairn/geometry/assignment.h"

#include <cassert>
#include <limits>

namespace cairn {
namespace {

// Dual prices of a partial assignment in which every assigned pair is tight (costs its prices) and
// no pair costs less. Index 0 of columns is a stand-in: the row that is being added sits there.
class ShortestPaths {
 public:
  explicit ShortestPaths(const Eigen::MatrixXd& cost)
      : cost_(cost),
        row_price_(cost.rows() + 1, 0.0),
        column_price_(cost.cols() + 1, 0.0),
        row_of_(cost.cols() + 1, 0) {}

  // Dijkstra over columns from the new row to the nearest free column, then shifts the assignment
  // along the path. Rows and columns count from 1 here.
  void add(int row) {
    const int columns = int(cost_.cols());
    std::vector<double> distance(columns + 1, std::numeric_limits<double>::infinity());
    std::vector<int> before(columns + 1, 0);
    std::vector<char> done(columns + 1, 0);
    row_of_[0] = row;
    int at = 0;
    do {
      done[at] = 1;
      const int i = row_of_[at];
      int nearest = 0;
      double step = std::numeric_limits<double>::infinity();
      for (int j = 1; j <= columns; ++j) {
        if (done[j]) continue;
        const double reduced = cost_(i - 1, j - 1) - row_price_[i] - column_price_[j];
        if (reduced < distance[j]) distance[j] = reduced, before[j] = at;
        if (distance[j] < step) step = distance[j], nearest = j;
      }
      for (int j = 0; j <= columns; ++j) {
        if (done[j]) {
          row_price_[row_of_[j]] += step;
          column_price_[j] -= step;
        } else {
          distance[j] -= step;
        }
      }
      at = nearest;
    } while (row_of_[at] != 0);
    for (; at != 0; at = before[at]) row_of_[at] = row_of_[before[at]];
  }

  std::vector<int> column_of_rows() const {
    std::vector<int> column_of(cost_.rows(), -1);
    for (int j = 1; j <= cost_.cols(); ++j) {
      if (row_of_[j] != 0) column_of[row_of_[j] - 1] = j - 1;
    }
    return column_of;
  }

 private:
  const Eigen::MatrixXd& cost_;
  std::vector<double> row_price_, column_price_;
  std::vector<int> row_of_;
};

}  // namespace

std::vector<int> assign(const Eigen::MatrixXd& cost) {
  assert(cost.allFinite());
  if (cost.rows() > cost.cols()) {
    const std::vector<int> row_of = assign(cost.transpose());
    std::vector<int> column_of(cost.rows(), -1);
    for (std::size_t j = 0; j < row_of.size(); ++j) column_of[row_of[j]] = int(j);
    return column_of;
  }
  ShortestPaths paths(cost);
  for (int i = 1; i <= cost.rows(); ++i) paths.add(i);
  return paths.column_of_rows();
}

}  // namespace cairn
