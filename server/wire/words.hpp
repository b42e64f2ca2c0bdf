#pragma once

#include <array>
#include <cstddef>

namespace smokemap::server {

// The wire's words for the values of enumerations, in their order. Words that maps have of their own (to_string) are
// not here.

inline constexpr std::array<const char*, 3> kFrameWords{"layout_px", "sketch_px", "map"};        ///< PlaceFrame
inline constexpr std::array<const char*, 3> kStrokeWords{"wall", "door", "note"};                ///< StrokeKind
inline constexpr std::array<const char*, 3> kVerdictWords{"proposed", "confirmed", "rejected"};  ///< Verdict
inline constexpr std::array<const char*, 3> kWallVerdictWords{"none", "gone", "there"};          ///< WallVerdict
inline constexpr std::array<const char*, 3> kLinkWords{"kept", "doubtful", "rejected"};          ///< LinkState
inline constexpr std::array<const char*, 3> kLinkQualityWords{"fresh", "stale", "lost"};         ///< LinkQuality
inline constexpr std::array<const char*, 2> kRegionWords{"room", "corridor"};                    ///< RegionKind

template <typename Enum, std::size_t N>
const char* word_of(const std::array<const char*, N>& words, Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? words[i] : words[0];
}

}  // namespace smokemap::server
