#pragma once

#include <vector>

#include "matching/region_graph.hpp"

namespace smokemap {

// What an answer leaves unexplained. `partner`: of every region of a, by label - 1; -1 = none.

/// Share of a, by importance, that goes to some region of b.
double matched_share(const RegionGraph& a, const std::vector<int>& partner);

/// Share of b, by importance, that some region of a goes to.
double covered_share(const RegionGraph& b, const std::vector<int>& partner);

/// Standard deviation, by importance, of the logarithm of how much larger partners are than what was drawn of them; 1
/// if nothing has a partner. A drawing has one scale: who mistakes rooms for others finds some of them far too large
/// beside some far too small. Regions that go to one together are measured together.
double size_spread(const RegionGraph& a, const RegionGraph& b, const std::vector<int>& partner);

}  // namespace smokemap
