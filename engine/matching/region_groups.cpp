#include "matching/region_groups.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace smokemap {

std::vector<RegionGroup> group_pairs(const std::vector<RegionPair>& pairs) {
  std::vector<RegionGroup> groups;
  const auto holds = [](const std::vector<int>& labels, int label) {
    return std::find(labels.begin(), labels.end(), label) != labels.end();
  };
  for (const RegionPair& pair : pairs) {
    if (pair.verdict == Verdict::kRejected) continue;
    RegionGroup joined{{pair.label_a}, {pair.label_b}, pair.confidence};
    std::vector<RegionGroup> others;
    for (RegionGroup& group : groups) {
      if (!holds(group.labels_a, pair.label_a) && !holds(group.labels_b, pair.label_b)) {
        others.push_back(std::move(group));
        continue;
      }
      joined.labels_a.insert(joined.labels_a.end(), group.labels_a.begin(), group.labels_a.end());
      joined.labels_b.insert(joined.labels_b.end(), group.labels_b.begin(), group.labels_b.end());
      joined.confidence = std::min(joined.confidence, group.confidence);
    }
    others.push_back(std::move(joined));
    groups = std::move(others);
  }
  for (RegionGroup& group : groups)
    for (std::vector<int>* labels : {&group.labels_a, &group.labels_b}) {
      std::sort(labels->begin(), labels->end());
      labels->erase(std::unique(labels->begin(), labels->end()), labels->end());
    }
  std::sort(groups.begin(), groups.end(),
            [](const RegionGroup& one, const RegionGroup& two) { return one.labels_a < two.labels_a; });
  return groups;
}

}  // namespace smokemap
