#pragma once

#include <functional>

#include "maps/correspondence.hpp"

namespace smokemap {

/// Carries points of one map to another: a PointTransfer, its inverse, the deformation of a plan.
using PointWay = std::function<Transferred(const Point2&)>;

/// Goes on from a place on a second map to a third, with the errors of both ways: the second way is asked around the
/// place, as far as the first may be wrong, and what comes out scattered adds to its own error (unscented transform:
/// Julier and Uhlmann 1997). Confidences multiply: both rooms must be right. Where the second way has no place, there
/// is none, for its reason.
Transferred carry_on(const Transferred& first, const PointWay& second);

/// First one way, then the other: sketch -> layout -> map.
PointWay chained(PointWay first, PointWay second);

}  // namespace smokemap
