#include "maps/radar_image.hpp"

#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

struct RadarRow {
  double azimuth_rad, seconds, range_min_m, resolution_m;
};

RadarRow radar_row(std::span<const float> rows, int width, int row) {
  const float* head = rows.data() + static_cast<std::ptrdiff_t>(row) * width;
  return {head[0], head[1], head[2], head[3]};
}

Result<Ok> check_rows(std::span<const float> rows, int height, int width) {
  if (height < 2 || height > kMostRadarAzimuths || width <= kRadarRowHeader || width > kMostRadarBins + kRadarRowHeader)
    return fail(Errc::kCorrupt,
                "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " is no radar sweep");
  if (rows.size() != static_cast<std::size_t>(height) * static_cast<std::size_t>(width))
    return fail(Errc::kCorrupt, "radar picture of another length than its size says");
  return Ok{};
}

}  // namespace

std::vector<float> to_radar_rows(const RadarSweep& sweep) {
  std::vector<float> rows;
  const auto bins = static_cast<std::size_t>(sweep.bins);
  rows.reserve(static_cast<std::size_t>(sweep.azimuths) * (bins + kRadarRowHeader));
  for (int i = 0; i < sweep.azimuths; ++i) {
    rows.push_back(static_cast<float>(sweep.azimuth_min_rad + i * sweep.azimuth_increment_rad));
    rows.push_back(static_cast<float>(sweep.duration_s * i / sweep.azimuths));
    rows.push_back(static_cast<float>(sweep.range_min_m));
    rows.push_back(static_cast<float>(sweep.range_resolution_m));
    const auto first = sweep.power.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(i) * bins);
    rows.insert(rows.end(), first, first + static_cast<std::ptrdiff_t>(bins));
  }
  return rows;
}

Result<RadarSweep> from_radar_rows(std::span<const float> rows, int height, int width) {
  if (auto sized = check_rows(rows, height, width); !sized) return sized.error();
  const RadarRow first = radar_row(rows, width, 0);
  const RadarRow last = radar_row(rows, width, height - 1);
  RadarSweep sweep;
  sweep.azimuths = height;
  sweep.bins = width - kRadarRowHeader;
  sweep.azimuth_min_rad = first.azimuth_rad;
  sweep.azimuth_increment_rad = (last.azimuth_rad - first.azimuth_rad) / (height - 1);
  sweep.duration_s = (last.seconds - first.seconds) * height / (height - 1);
  sweep.range_min_m = first.range_min_m;
  sweep.range_resolution_m = first.resolution_m;
  if (!(std::abs(sweep.azimuth_increment_rad) > 1e-6) || !(std::abs(sweep.azimuth_increment_rad) < kPi))
    return fail(Errc::kCorrupt, "radar rows without a usable step of azimuth");
  sweep.power.reserve(static_cast<std::size_t>(height) * static_cast<std::size_t>(sweep.bins));
  double before_s = first.seconds;
  for (int i = 0; i < height; ++i) {
    const RadarRow row = radar_row(rows, width, i);
    const double expected_rad = sweep.azimuth_min_rad + i * sweep.azimuth_increment_rad;
    if (!(std::abs(row.azimuth_rad - expected_rad) <= 0.1 * std::abs(sweep.azimuth_increment_rad)))
      return fail(Errc::kCorrupt, "radar rows are not evenly spaced in azimuth");
    if (!(row.seconds >= before_s)) return fail(Errc::kCorrupt, "radar rows run backwards in time");
    if (row.range_min_m != first.range_min_m || row.resolution_m != first.resolution_m)
      return fail(Errc::kCorrupt, "radar rows differ in their range scale");
    before_s = row.seconds;
    const auto bins = rows.subspan(static_cast<std::size_t>(i) * static_cast<std::size_t>(width) + kRadarRowHeader,
                                   static_cast<std::size_t>(sweep.bins));
    sweep.power.insert(sweep.power.end(), bins.begin(), bins.end());
  }
  if (auto sound = check(sweep); !sound) return sound.error();
  return sweep;
}

Result<Ok> check(const RadarSweep& sweep) {
  if (sweep.azimuths < 1 || sweep.azimuths > kMostRadarAzimuths || sweep.bins < 1 || sweep.bins > kMostRadarBins)
    return fail(Errc::kCorrupt, "radar sweep without usable size");
  if (sweep.power.size() != static_cast<std::size_t>(sweep.azimuths) * static_cast<std::size_t>(sweep.bins))
    return fail(Errc::kCorrupt, "radar sweep of another length than its size says");
  if (!(sweep.range_resolution_m > 0) || !std::isfinite(sweep.range_resolution_m) || !std::isfinite(sweep.range_min_m))
    return fail(Errc::kCorrupt, "radar sweep without a usable range scale");
  if (!std::isfinite(sweep.azimuth_min_rad) || !std::isfinite(sweep.azimuth_increment_rad) ||
      sweep.azimuth_increment_rad == 0)
    return fail(Errc::kCorrupt, "radar sweep without a usable azimuth");
  if (!(sweep.duration_s >= 0) || !std::isfinite(sweep.duration_s) || !sweep.T_robot_radar.is_finite())
    return fail(Errc::kCorrupt, "radar sweep with a pose or time that is not finite");
  for (const float power : sweep.power)
    if (!std::isfinite(power)) return fail(Errc::kCorrupt, "radar sweep with power that is not finite");
  return Ok{};
}

}  // namespace smokemap
