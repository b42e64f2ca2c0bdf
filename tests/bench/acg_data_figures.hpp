#pragma once

#include <string>
#include <vector>

namespace smokemap::bench {

/// Rows on real data, printed: Halmstad E5 and F5 (a plan and sensor maps of the same floor, with corners that people
/// paired) and the pixel pairs of the Oerebro plan. `data` is the folder that holds acg and floor_plans.
///
/// Halmstad: scans are cast in the sensor map along a walk through its free space; the plan is given the two pairs that
/// are farthest apart and scored on all other pairs. Oerebro: nobody kept the robot's log, so the drawing is bent until
/// its four pairs are where the published system measured them; a simulated robot drives there, the plan is given two
/// pairs and scored on the other two.
///
/// Only rows with `only` in their name.
void print_data_rows(const std::string& data, const std::string& only);
const std::vector<std::string>& data_rows();

}  // namespace smokemap::bench
