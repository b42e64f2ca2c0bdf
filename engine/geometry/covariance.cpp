#include "geometry/covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace smokemap {
namespace {

template <typename Matrix>
Result<Matrix> sqrt_information_of(const Matrix& covariance) {
  if (!covariance.allFinite() || !covariance.isApprox(covariance.transpose(), 1e-9))
    return fail(Errc::kDegenerate, "covariance is not finite and symmetric");
  const Eigen::LLT<Matrix> covariance_llt(covariance);
  if (covariance_llt.info() != Eigen::Success) return fail(Errc::kDegenerate, "covariance is not positive definite");
  const Eigen::LLT<Matrix> information_llt(covariance.inverse());
  if (information_llt.info() != Eigen::Success) return fail(Errc::kDegenerate, "covariance cannot be inverted");
  return Matrix(information_llt.matrixU());
}

}  // namespace

Result<Eigen::Matrix2d> sqrt_information(const Eigen::Matrix2d& covariance) { return sqrt_information_of(covariance); }
Result<Eigen::Matrix3d> sqrt_information(const Eigen::Matrix3d& covariance) { return sqrt_information_of(covariance); }

Ellipse ellipse(const Eigen::Matrix2d& covariance) {
  const double a = covariance(0, 0), b = covariance(0, 1), d = covariance(1, 1);
  const double mean = 0.5 * (a + d), spread = std::hypot(0.5 * (a - d), b);
  return {std::sqrt(std::max(0.0, mean + spread)), std::sqrt(std::max(0.0, mean - spread)),
          0.5 * std::atan2(2 * b, a - d)};
}

}  // namespace smokemap
