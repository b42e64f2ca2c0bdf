#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "maps/merged_map.hpp"

namespace smokemap::server {

// The live map as browsers get it: a palette of 16 codes, cut into tiles of 128 x 128 cells, two cells a byte (low
// nibble first, row 0 = lowest y), deflated once a version and shared by all browsers. A tile is addressed by where it
// lies in `map`, so a growing grid means new tiles and never a resize.

constexpr int kTileCells = 128;
constexpr std::size_t kTileBytes = kTileCells * kTileCells / 2;

/// Cell codes; 1..6 free (1 = surest), 7..13 occupied (13 = surest).
constexpr std::uint8_t kCodeUnknown = 0, kCodePlanOnly = 14, kCodeGone = 15;

/// Percent of OccupancyGrid -> code. 50 % is as good as nothing known: 0.
std::uint8_t occupancy_code(std::int8_t percent);

struct TileKey {
  int x = 0;
  int y = 0;
  auto operator<=>(const TileKey&) const = default;
};

using PackedTile = std::array<std::uint8_t, kTileBytes>;

std::uint8_t code_at(const PackedTile& tile, int column, int row);

/// Sensed occupancy with the plan over it: walls of the plan where nothing was seen are kCodePlanOnly, walls that the
/// plan has but the building has not are kCodeGone (unless something occupied is there). The sensed grid may have any
/// frame; a finer one keeps its most occupied cell. Cost: O(cells of the sensed grid).
std::map<TileKey, PackedTile> merged_tiles(const OccupancyGrid& sensed, const MergedMap& merged, double resolution_m);

/// One version of a tile, ready to be sent.
struct EncodedTile {
  TileKey key;
  std::uint32_t version = 0;
  bool uniform = false;
  std::uint8_t value = 0;  ///< of a uniform tile
  std::string deflated;    ///< deflate-raw of the packed cells; empty for a uniform tile
  std::size_t wire_bytes() const { return 14 + deflated.size(); }
};

EncodedTile encode_tile(TileKey key, std::uint32_t version, const PackedTile& cells);

using TileTable = std::map<TileKey, std::shared_ptr<const EncodedTile>>;

/// Remembers the cells last encoded and encodes only what changed.
class TileEncoder {
 public:
  /// Tiles that vanished become unknown; they are never forgotten, so that a browser that was away hears of it.
  /// @return true if anything changed; `version` is then the version of what changed
  bool update(const std::map<TileKey, PackedTile>& tiles, std::uint32_t version);
  const TileTable& table() const { return table_; }

 private:
  std::map<TileKey, PackedTile> cells_;
  TileTable table_;
};

struct MapFrameHeader {
  std::uint32_t epoch = 0;
  std::uint64_t seq = 0;  ///< the point to resume from: every change up to it has been sent
  double server_ms = 0;
};

/// Type 1: tiles.
std::string map_frame(const MapFrameHeader& header, const std::vector<std::shared_ptr<const EncodedTile>>& tiles);
/// Type 2: end of the snapshot.
std::string end_of_snapshot_frame(const MapFrameHeader& header);

/// What a map frame says, for tests and tools. kCorrupt for anything that map_frame does not write.
struct DecodedTile {
  TileKey key;
  std::uint32_t version = 0;
  PackedTile cells{};
};
struct DecodedFrame {
  MapFrameHeader header;
  int type = 0;
  std::vector<DecodedTile> tiles;
};
Result<DecodedFrame> decode_map_frame(std::string_view text);

}  // namespace smokemap::server
