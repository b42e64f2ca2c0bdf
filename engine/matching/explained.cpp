#include "matching/explained.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {

double matched_share(const RegionGraph& a, const std::vector<int>& partner) {
  double sum = 0;
  for (int i = 0; i < a.size(); ++i)
    if (partner[static_cast<size_t>(i)] >= 0) sum += a.importance(i);
  return sum;
}

double covered_share(const RegionGraph& b, const std::vector<int>& partner) {
  double sum = 0;
  for (int j = 0; j < b.size(); ++j)
    if (std::find(partner.begin(), partner.end(), j) != partner.end()) sum += b.importance(j);
  return sum;
}

double size_spread(const RegionGraph& a, const RegionGraph& b, const std::vector<int>& partner) {
  Eigen::VectorXd drawn = Eigen::VectorXd::Zero(b.size());  // area of all that goes to one region
  for (int i = 0; i < a.size(); ++i)
    if (const int j = partner[static_cast<size_t>(i)]; j >= 0) drawn(j) += a.area(i);
  double total = 0, sum = 0, squares = 0;
  for (int i = 0; i < a.size(); ++i) {
    const int j = partner[static_cast<size_t>(i)];
    if (j < 0) continue;
    const double larger = std::log(b.area(j) / drawn(j)), weight = a.importance(i);
    total += weight, sum += weight * larger, squares += weight * larger * larger;
  }
  if (total <= 0) return 1;
  return std::sqrt(std::max(0.0, squares / total - sum * sum / (total * total)));
}

}  // namespace smokemap
