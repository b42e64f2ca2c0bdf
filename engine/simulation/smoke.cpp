#include "simulation/smoke.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"
#include "core/expect.hpp"

namespace smokemap {

Result<Ok> SmokeParams::validate() const {
  return ParamCheck("SmokeParams")
      .in_range("cell_m", cell_m, 0.05, 5)
      .in_range("diffusion_m2ps", diffusion_m2ps, 0, 10)
      .in_range("decay_per_s", decay_per_s, 0, 1)
      .result();
}

SmokeField::SmokeField(const SegmentWorld& world, const SmokeParams& params, std::vector<SmokeSource> sources)
    : params_(params), sources_(std::move(sources)) {
  ENGINE_EXPECT(params.validate().ok());
  frame_ = frame_around(world.low(), world.high(), params.cell_m, params.cell_m);
  extinction_.assign(frame_.cell_count(), 0.0);
  next_ = extinction_;
  read_walls(world);
}

void SmokeField::read_walls(const SegmentWorld& world) {
  open_.assign(frame_.cell_count(), 0);
  for (int y = 0; y < frame_.height_cells; ++y)
    for (int x = 0; x < frame_.width_cells; ++x) {
      const Point2 here = frame_.center_of({x, y});
      std::uint8_t open = 0;
      if (x + 1 < frame_.width_cells && world.sees(here, frame_.center_of({x + 1, y}))) open |= 1;
      if (y + 1 < frame_.height_cells && world.sees(here, frame_.center_of({x, y + 1}))) open |= 2;
      open_[frame_.index({x, y})] = open;
    }
}

void SmokeField::advance(double seconds) {
  if (empty() || seconds <= 0) return;
  const double stable =
      params_.diffusion_m2ps > 0 ? 0.2 * params_.cell_m * params_.cell_m / params_.diffusion_m2ps : seconds;
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / std::min(stable, 1.0))));
  for (int i = 0; i < steps; ++i) {
    add_sources(seconds / steps);
    diffuse(seconds / steps);
  }
}

void SmokeField::add_sources(double seconds) {
  for (const SmokeSource& source : sources_) {
    const Cell low = frame_.cell_of(source.p - Point2(source.radius_m, source.radius_m));
    const Cell high = frame_.cell_of(source.p + Point2(source.radius_m, source.radius_m));
    for (int y = std::max(low.y, 0); y <= std::min(high.y, frame_.height_cells - 1); ++y)
      for (int x = std::max(low.x, 0); x <= std::min(high.x, frame_.width_cells - 1); ++x) {
        if ((frame_.center_of({x, y}) - source.p).norm() > source.radius_m) continue;
        double& here = extinction_[frame_.index({x, y})];
        here = std::max(here, std::min(here + source.rate_per_m_s * seconds, source.ceiling_per_m));
      }
  }
}

void SmokeField::diffuse(double seconds) {
  const double share = params_.diffusion_m2ps * seconds / (params_.cell_m * params_.cell_m);
  const double keep = std::exp(-params_.decay_per_s * seconds);
  next_ = extinction_;
  const auto width = static_cast<std::size_t>(frame_.width_cells);
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (open_[i] & 1) {
      const double flow = share * (extinction_[i] - extinction_[i + 1]);
      next_[i] -= flow;
      next_[i + 1] += flow;
    }
    if (open_[i] & 2) {
      const double flow = share * (extinction_[i] - extinction_[i + width]);
      next_[i] -= flow;
      next_[i + width] += flow;
    }
  }
  for (double& value : next_) value *= keep;
  extinction_.swap(next_);
}

double SmokeField::extinction_at(const Point2& p) const {
  if (empty()) return 0;
  const Cell cell = frame_.cell_of(p);
  return frame_.contains(cell) ? extinction_[frame_.index(cell)] : 0;
}

void SmokeField::set_extinction(const Point2& p, double per_m) {
  const Cell cell = frame_.cell_of(p);
  ENGINE_EXPECT(!empty() && frame_.contains(cell) && per_m >= 0);
  extinction_[frame_.index(cell)] = per_m;
}

void SmokeField::trace(const Point2& origin, const Point2& direction, double range_m,
                       std::vector<SmokePiece>& pieces) const {
  pieces.clear();
  if (empty()) return;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double enter = 0, leave = range_m;
  const Point2 size(frame_.width_cells * frame_.resolution_m, frame_.height_cells * frame_.resolution_m);
  for (int axis = 0; axis < 2; ++axis) {
    const double from = origin[axis] - frame_.origin[axis], speed = direction[axis];
    if (speed == 0) {
      if (from < 0 || from > size[axis]) return;
      continue;
    }
    enter = std::max(enter, std::min(-from / speed, (size[axis] - from) / speed));
    leave = std::min(leave, std::max(-from / speed, (size[axis] - from) / speed));
  }
  if (enter >= leave) return;
  Cell cell = frame_.cell_of(origin + enter * direction);
  cell = {std::clamp(cell.x, 0, frame_.width_cells - 1), std::clamp(cell.y, 0, frame_.height_cells - 1)};
  const auto border = [&](int axis, int index) {
    if (direction[axis] == 0) return kInfinite;
    const double edge = frame_.origin[axis] + (index + (direction[axis] > 0 ? 1 : 0)) * frame_.resolution_m;
    return (edge - origin[axis]) / direction[axis];
  };
  for (double at = enter; at < leave && frame_.contains(cell);) {
    const double next_x = border(0, cell.x), next_y = border(1, cell.y);
    const double exit = std::min({next_x, next_y, leave});
    const double extinction = extinction_[frame_.index(cell)];
    if (extinction > 0 && exit > at) pieces.push_back({at, exit, extinction});
    at = std::max(at, exit);
    if (next_x < next_y)
      cell.x += direction.x() > 0 ? 1 : -1;
    else
      cell.y += direction.y() > 0 ? 1 : -1;
  }
}

double SmokeField::optical_depth(const Point2& origin, const Point2& direction, double range_m) const {
  std::vector<SmokePiece> pieces;
  trace(origin, direction, range_m, pieces);
  double depth = 0;
  for (const SmokePiece& piece : pieces) depth += (piece.to_m - piece.from_m) * piece.extinction_per_m;
  return depth;
}

}  // namespace smokemap
