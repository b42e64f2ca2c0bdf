#pragma once

#include <gmock/gmock.h>

#include "geometry/pose2.hpp"

namespace smokemap::test {

/// Poses are compared in metres and radians separately.
MATCHER_P3(IsNear, pose, metres, radians, "is near the pose") {
  const double away = (arg.translation() - pose.translation()).norm();
  const double turned = std::abs(wrap_angle(arg.heading() - pose.heading()));
  *result_listener << "is " << away << " m and " << turned << " rad away";
  return away <= metres && turned <= radians;
}

MATCHER_P2(IsNearPoint, point, metres, "is near the point") {
  *result_listener << "is " << (arg - point).norm() << " away";
  return (arg - point).norm() <= metres;
}

}  // namespace smokemap::test
