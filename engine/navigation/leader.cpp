#include "navigation/leader.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace smokemap {

Result<Ok> LeaderParams::validate() const {
  return ParamCheck("LeaderParams")
      .in_range("least_ahead_m", least_ahead_m, 0.5, 100)
      .in_range("ahead_m", ahead_m, least_ahead_m, 100)
      .in_range("renew_m", renew_m, 0.1, ahead_m)
      .in_range("end_renew_m", end_renew_m, 0.01, renew_m)
      .in_range("patience", patience, 1, 100)
      .result();
}

std::optional<Pose2> Leader::next(const Path& path, const Pose2& T_map_robot, std::optional<double> heading_rad,
                                  Errand errand) {
  if (!end_ || (*end_ - path.points.back()).norm() > params_.renew_m) {  // another goal
    failures_ = 0;
    ahead_m_ = params_.ahead_m;
  }
  end_ = path.points.back();
  const bool failed = told_ && errand == Errand::kGivenUp;
  if (failed) {
    ++failures_;
    ahead_m_ = std::max(params_.least_ahead_m, ahead_m_ / 2);
  } else if (told_ && errand == Errand::kDone) {
    failures_ = 0;
    ahead_m_ = params_.ahead_m;
  }
  if (gave_up()) return std::nullopt;
  const Point2& here = T_map_robot.translation();
  Pose2 place = pose_ahead(path, here, ahead_m_);
  const bool is_end = progress_on(path, here).remaining_m <= ahead_m_;
  if (is_end && heading_rad) place = Pose2(place.translation(), *heading_rad);
  const double moved_m = told_ ? (place.translation() - told_->translation()).norm() : 0;
  const bool holds = told_ && errand == Errand::kUnderWay && is_end == told_end_ &&
                     moved_m < (is_end ? params_.end_renew_m : params_.renew_m);
  const bool stands_there = told_ && errand == Errand::kDone && is_end == told_end_ && moved_m < params_.end_renew_m;
  if (holds || stands_there) return std::nullopt;
  told_ = place;
  told_end_ = is_end;
  return place;
}

}  // namespace smokemap
