#pragma once

#include <Eigen/Core>
#include <vector>

namespace cairn {

/// True landmarks and found ones, one to one.
struct Pairing {
  std::vector<int> found_of;   ///< a true one: its match, or -1
  std::vector<int> rivals;     ///< found ones without a match that could be a true one
  std::vector<int> strangers;  ///< found ones that could be none
};

/// The pairs that cost least together. `cost`: a row a true landmark, a column a found one; what
/// costs `no_pair` or more is no pair.
Pairing pair_landmarks(const Eigen::MatrixXd& cost, double no_pair);

}  // namespace cairn
