#pragma once

#include <Eigen/Core>
#include <vector>

namespace cairn {

/// The one-to-one assignment of rows to columns with the least total cost: for each row its column,
/// or -1 for the rows that are left over where there are more rows than columns (all columns have
/// a row then). Costs are finite. Shortest augmenting paths (Jonker and Volgenant, Computing 1987),
/// O(min² · max).
///
/// A pair that must not be is given the largest cost and dropped from the result by the caller.
std::vector<int> assign(const Eigen::MatrixXd& cost);

}  // namespace cairn
