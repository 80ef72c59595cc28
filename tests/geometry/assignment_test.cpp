#include "cairn/geometry/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "scene.h"

namespace cairn {
namespace {

double total(const Eigen::MatrixXd& cost, const std::vector<int>& column_of) {
  double sum = 0;
  for (int i = 0; i < cost.rows(); ++i) sum += column_of[i] < 0 ? 0 : cost(i, column_of[i]);
  return sum;
}

// Over all ways to give the rows (not more than columns) different columns.
double least_total(const Eigen::MatrixXd& cost) {
  std::vector<int> columns(cost.cols());
  std::iota(columns.begin(), columns.end(), 0);
  double best = 1e300;
  do {
    best = std::min(best, total(cost, columns));
  } while (std::next_permutation(columns.begin(), columns.end()));
  return best;
}

TEST(Assign, CostsAsLittleAsTheBestOfAllPermutations) {
  testing::Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const int rows = random.below(6) + 1, columns = rows + random.below(3);
    Eigen::MatrixXd cost(rows, columns);
    // Every third: whole numbers, so that there are ties; costs may be negative.
    for (double& c : cost.reshaped()) {
      c = trial % 3 == 0 ? random.below(4) : random.uniform(-5, 5);
    }
    EXPECT_NEAR(total(cost, assign(cost)), least_total(cost), 1e-12);
    const Eigen::MatrixXd tall = cost.transpose();
    EXPECT_NEAR(total(tall, assign(tall)), least_total(cost), 1e-12);
  }
}

TEST(Assign, GivesEveryColumnToOneRowAtMostAndLeavesOnlyRowsThatAreTooMany) {
  testing::Random random(2);
  for (const auto& [rows, columns] : {std::pair{20, 30}, {30, 20}, {25, 25}}) {
    Eigen::MatrixXd cost(rows, columns);
    for (double& c : cost.reshaped()) c = random.uniform(0, 1);
    std::vector<int> used(columns, 0);
    int assigned = 0;
    for (const int j : assign(cost)) {
      if (j >= 0) ++used[j], ++assigned;
    }
    EXPECT_EQ(assigned, std::min(rows, columns));
    EXPECT_EQ(*std::max_element(used.begin(), used.end()), 1);
  }
}

TEST(Assign, TakesEmptyTables) {
  EXPECT_TRUE(assign(Eigen::MatrixXd(0, 3)).empty());
  EXPECT_EQ(assign(Eigen::MatrixXd(2, 0)), std::vector<int>({-1, -1}));
}

}  // namespace
}  // namespace cairn
