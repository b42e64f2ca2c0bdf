#pragma once

#include <random>

#include "simulation/plan_picture.hpp"

namespace smokemap {

/// Takes a picture of `picture.sheet` with a hand-held camera: perspective, uneven light, glare, noise. Sets `photo`
/// and `homography`.
void photograph(const PlanPictureParams& params, std::mt19937_64& random, PlanPicture& picture);

}  // namespace smokemap
