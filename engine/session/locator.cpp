#include "session/locator.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace smokemap {
namespace {

double spread_m(const LocalizerEstimate& e) { return std::sqrt(0.5 * (e.covariance(0, 0) + e.covariance(1, 1))); }

}  // namespace

Result<Ok> LocatorParams::validate() const {
  if (const auto valid = filter.validate(); !valid) return valid.error();
  return ParamCheck("LocatorParams")
      .in_range("witnesses", witnesses, 1, 20)
      .positive("agree_m", agree_m)
      .positive("agree_rad", agree_rad)
      .positive("sure_sigma_m", sure_sigma_m)
      .positive("sure_sigma_rad", sure_sigma_rad)
      .in_range("sure_explained", sure_explained, 0, 1)
      .in_range("sure_steps", sure_steps, 1, 1000)
      .in_range("blind_travel_m", blind_travel_m, 0, 1000)
      .in_range("worse_explained", worse_explained, 0, 1)
      .in_range("patience_steps", patience_steps, 1, 1000)
      .result();
}

Locator::Locator(const LocatorParams& params, std::uint64_t seed) : params_(params), seed_(seed) {
  ENGINE_EXPECT(params.validate().ok());
}

void Locator::set_walls(const std::vector<LocalizerWall>& walls) {
  walls_ = walls;
  for (Localizer& filter : filters_) filter.set_walls(walls);
}

void Locator::start(int filters, double needed_travel_m) {
  filters_.clear();
  for (int i = 0; i < filters; ++i) {
    filters_.emplace_back(params_.filter, seed_ * 1000 + static_cast<std::uint64_t>(i));
    filters_.back().set_walls(walls_);
  }
  travelled_m_ = 0;
  needed_travel_m_ = needed_travel_m;
  sure_steps_ = steps_ = 0;
}

void Locator::start_at(const Pose2& T_map_robot, double sigma_m, double sigma_rad) {
  start(1, 0);
  filters_.front().start_at(T_map_robot, sigma_m, sigma_rad);
}

void Locator::start_anywhere() {
  start(params_.witnesses, params_.blind_travel_m);
  for (Localizer& filter : filters_) filter.start_anywhere();
}

void Locator::step(const Pose2& T_before_after, const std::vector<Point2>& hits_robot) {
  if (!started() || !T_before_after.is_finite()) return;
  for (Localizer& filter : filters_) filter.update(T_before_after, hits_robot);
  travelled_m_ += T_before_after.translation().norm();
  sure_steps_ = sure_now() ? sure_steps_ + 1 : 0;
  if (++steps_ % params_.patience_steps == 0) restart_the_worse();
}

/// A filter that settled in a wrong place that explains most of what is seen never leaves it by itself.
void Locator::restart_the_worse() {
  double best = 0;
  for (const Localizer& filter : filters_) best = std::max(best, filter.estimate().explained);
  for (Localizer& filter : filters_)
    if (filter.estimate().explained < best - params_.worse_explained) filter.start_anywhere();
}

bool Locator::sure_now() const {
  const LocalizerEstimate first = filters_.front().estimate();
  return std::all_of(filters_.begin(), filters_.end(), [&](const Localizer& filter) {
    const LocalizerEstimate e = filter.estimate();
    const Pose2 apart = first.T_map_robot.inverse() * e.T_map_robot;
    return !e.lost && e.explained >= params_.sure_explained && spread_m(e) <= params_.sure_sigma_m &&
           std::sqrt(e.covariance(2, 2)) <= params_.sure_sigma_rad && apart.translation().norm() <= params_.agree_m &&
           std::abs(apart.heading()) <= params_.agree_rad;
  });
}

LocalizerEstimate Locator::estimate() const { return started() ? filters_.front().estimate() : LocalizerEstimate{}; }

}  // namespace smokemap
