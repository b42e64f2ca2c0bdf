#include "layout/doors.hpp"

#include <utility>

#include "layout/median.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kDoorsToKnow = 3;

}  // namespace

std::vector<double> door_widths(const LayoutMap& map) {
  std::vector<double> widths;
  for (const auto& o : map.openings)
    if (o.kind == OpeningKind::kDoor) widths.push_back(o.gap_px.length());
  return widths;
}

std::optional<double> usual_door_width(std::vector<double> widths) {
  if (widths.size() < kDoorsToKnow) return std::nullopt;
  return median_of(std::move(widths));
}

}  // namespace smokemap
