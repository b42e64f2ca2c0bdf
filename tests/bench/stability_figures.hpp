#pragma once

#include <string>

#include "core/result.hpp"

namespace smokemap::bench {

/// FOLDER/<set>/<map>/map.png, at most a dozen maps a set, read again with a pixel of noise on their walls, turned by a
/// quarter and turned by seven degrees: strict score of the new regions with those of the map as it is for truth.
Result<Ok> print_stability(const std::string& folder);

}  // namespace smokemap::bench
