#include "cairn/evaluation/pairing.h"

#include "cairn/geometry/assignment.h"

namespace cairn {

Pairing pair_landmarks(const Eigen::MatrixXd& cost, double no_pair) {
  Pairing pairing{.found_of = assign(cost), .rivals = {}, .strangers = {}};
  std::vector<char> matched(std::size_t(cost.cols()), 0);
  for (std::size_t i = 0; i < pairing.found_of.size(); ++i) {
    int& j = pairing.found_of[i];
    if (j >= 0 && cost(Eigen::Index(i), j) >= no_pair) j = -1;
    if (j >= 0) matched[std::size_t(j)] = 1;
  }
  for (int j = 0; j < int(cost.cols()); ++j) {
    if (matched[std::size_t(j)]) continue;
    const bool could = cost.rows() > 0 && cost.col(j).minCoeff() < no_pair;
    (could ? pairing.rivals : pairing.strangers).push_back(j);
  }
  return pairing;
}

}  // namespace cairn
