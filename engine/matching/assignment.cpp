#include "matching/assignment.hpp"

#include <algorithm>
#include <limits>

namespace smokemap {
namespace {

/// Augments a partial assignment by one row along the cheapest path. `column_of`-style arrays are 1-based; column 0 is
/// the place from which the new row enters.
class PathSolver {
 public:
  explicit PathSolver(const Eigen::MatrixXd& cost)
      : cost_(cost),
        size_(static_cast<int>(cost.rows())),
        row_price_(static_cast<std::size_t>(size_) + 1, 0),
        column_price_(static_cast<std::size_t>(size_) + 1, 0),
        row_at_(static_cast<std::size_t>(size_) + 1, 0) {}

  std::vector<int> solve() {
    for (int row = 1; row <= size_; ++row) enter(row);
    std::vector<int> column_of(static_cast<size_t>(size_), -1);
    for (int column = 1; column <= size_; ++column) column_of[at(row_at_, column) - 1] = column - 1;
    return column_of;
  }

 private:
  static size_t at(const std::vector<int>& values, int i) {
    return static_cast<size_t>(values[static_cast<size_t>(i)]);
  }

  void enter(int row) {
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<double> slack(row_price_.size(), infinite);
    std::vector<int> came_from(row_price_.size(), 0);
    std::vector<char> visited(row_price_.size(), 0);
    row_at_[0] = row;
    int column = 0;
    do {
      visited[static_cast<size_t>(column)] = 1;
      const int here = row_at_[static_cast<size_t>(column)];
      int next = 0;
      double least = infinite;
      for (int j = 1; j <= size_; ++j) {
        const auto jj = static_cast<size_t>(j);
        if (visited[jj]) continue;
        const double reduced = cost_(here - 1, j - 1) - row_price_[static_cast<size_t>(here)] - column_price_[jj];
        if (reduced < slack[jj]) slack[jj] = reduced, came_from[jj] = column;
        if (slack[jj] < least) least = slack[jj], next = j;
      }
      for (size_t j = 0; j < visited.size(); ++j) {
        if (visited[j])
          row_price_[static_cast<size_t>(row_at_[j])] += least, column_price_[j] -= least;
        else
          slack[j] -= least;
      }
      column = next;
    } while (row_at_[static_cast<size_t>(column)] != 0);
    while (column != 0) {
      const int before = came_from[static_cast<size_t>(column)];
      row_at_[static_cast<size_t>(column)] = row_at_[static_cast<size_t>(before)];
      column = before;
    }
  }

  const Eigen::MatrixXd& cost_;
  int size_;
  std::vector<double> row_price_, column_price_;
  std::vector<int> row_at_;  ///< row assigned to each column
};

}  // namespace

std::vector<int> best_assignment(const Eigen::MatrixXd& gain) {
  const Eigen::Index size = std::max(gain.rows(), gain.cols());
  Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(size, size);
  cost.topLeftCorner(gain.rows(), gain.cols()) = -gain.cwiseMax(0.0);
  std::vector<int> column_of = PathSolver(cost).solve();
  column_of.resize(static_cast<size_t>(gain.rows()));
  for (size_t row = 0; row < column_of.size(); ++row) {
    int& column = column_of[row];
    if (column >= gain.cols() || gain(static_cast<Eigen::Index>(row), column) <= 0) column = -1;
  }
  return column_of;
}

}  // namespace smokemap
