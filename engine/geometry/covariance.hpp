#pragma once

#include <Eigen/Core>

#include "core/result.hpp"

namespace smokemap {

/// The upper triangular L^T with L L^T = covariance^-1: residual_in_sigmas = sqrt_information * residual.
/// kDegenerate unless the covariance is symmetric positive definite.
Result<Eigen::Matrix2d> sqrt_information(const Eigen::Matrix2d& covariance);
Result<Eigen::Matrix3d> sqrt_information(const Eigen::Matrix3d& covariance);

/// One standard deviation along the main axes of a 2D covariance.
struct Ellipse {
  double major_sigma_m = 0;
  double minor_sigma_m = 0;
  double heading_rad = 0;  ///< of the major axis
};
Ellipse ellipse(const Eigen::Matrix2d& covariance);

}  // namespace smokemap
