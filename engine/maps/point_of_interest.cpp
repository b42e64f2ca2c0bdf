#include "maps/point_of_interest.hpp"

#include <array>
#include <utility>

namespace smokemap {
namespace {

constexpr std::array<std::pair<PoiKind, const char*>, 9> kWords{{{PoiKind::kGasBottle, "gas_bottle"},
                                                                 {PoiKind::kVictim, "victim"},
                                                                 {PoiKind::kFire, "fire"},
                                                                 {PoiKind::kHazard, "hazard"},
                                                                 {PoiKind::kExit, "exit"},
                                                                 {PoiKind::kWater, "water"},
                                                                 {PoiKind::kAccess, "access"},
                                                                 {PoiKind::kShutOff, "shut_off"},
                                                                 {PoiKind::kNote, "note"}}};

}  // namespace

const char* to_string(PoiKind kind) {
  for (const auto& [k, word] : kWords)
    if (k == kind) return word;
  return "note";
}

std::optional<PoiKind> poi_kind(std::string_view word) {
  for (const auto& [kind, w] : kWords)
    if (word == w) return kind;
  return std::nullopt;
}

}  // namespace smokemap
