#include "server/wire/tiles.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace smokemap::server {
namespace {

int floor_div(int value, int by) { return value >= 0 ? value / by : -((by - 1 - value) / by); }

/// Where single cells are painted: addresses by cell of the endless map grid.
class Canvas {
 public:
  explicit Canvas(std::map<TileKey, PackedTile>& tiles) : tiles_(tiles) {}

  template <typename Mix>
  void paint(Cell cell, const Mix& mix) {
    const TileKey key{floor_div(cell.x, kTileCells), floor_div(cell.y, kTileCells)};
    if (!current_ || key != key_) {
      current_ = &tiles_.try_emplace(key, PackedTile{}).first->second;
      key_ = key;
    }
    const int column = cell.x - key.x * kTileCells, row = cell.y - key.y * kTileCells;
    std::uint8_t& byte = (*current_)[static_cast<std::size_t>(row * kTileCells + column) / 2];
    const int shift = column % 2 == 0 ? 0 : 4;
    const auto old_code = static_cast<std::uint8_t>((byte >> shift) & 15);
    byte = static_cast<std::uint8_t>((byte & ~(15 << shift)) | (mix(old_code) << shift));
  }

 private:
  std::map<TileKey, PackedTile>& tiles_;
  PackedTile* current_ = nullptr;
  TileKey key_;
};

constexpr double kFarthest_m = 20'000;  // keeps tile numbers within 16 bits at 0.05 m

/// For every cell along one side of the sensed grid, which of ours it covers; a coarse one covers several.
std::vector<std::vector<int>> covered_cells(int count, double first, double to_cells) {
  const int repeat = std::max(1, static_cast<int>(std::ceil(to_cells - 1e-6)));
  std::vector<std::vector<int>> covered(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    for (int part = 0; part < repeat; ++part)
      covered[static_cast<std::size_t>(i)].push_back(
          static_cast<int>(std::floor(first + (i + (part + 0.5) / repeat) * to_cells)));
  return covered;
}

void paint_sensed(const OccupancyGrid& sensed, double resolution_m, Canvas& canvas) {
  const GridFrame& frame = sensed.frame();
  const double to_cells = frame.resolution_m / resolution_m;
  const auto columns = covered_cells(frame.width_cells, frame.origin.x() / resolution_m, to_cells);
  const auto rows = covered_cells(frame.height_cells, frame.origin.y() / resolution_m, to_cells);
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const std::uint8_t code = occupancy_code(sensed.cells()[y * columns.size() + x]);
      if (code == kCodeUnknown) continue;
      for (const int row : rows[y])
        for (const int column : columns[x])
          canvas.paint({column, row}, [code](std::uint8_t there) { return std::max(there, code); });
    }
}

void paint_walls(const MergedMap& merged, double resolution_m, Canvas& canvas) {
  for (const MergedWall& wall : merged.walls) {
    if (!wall.layout_wall) continue;
    const Segment2& s = wall.segment_map;
    if (!s.a.allFinite() || !s.b.allFinite() || s.a.norm() > kFarthest_m || s.b.norm() > kFarthest_m) continue;
    const bool gone = wall.state == WallState::kMissing;
    const int steps = std::max(1, static_cast<int>(std::ceil(s.length() / (0.5 * resolution_m))));
    for (int i = 0; i <= steps; ++i) {
      const Point2 p = s.a + (static_cast<double>(i) / steps) * (s.b - s.a);
      const Cell cell{static_cast<int>(std::floor(p.x() / resolution_m)),
                      static_cast<int>(std::floor(p.y() / resolution_m))};
      canvas.paint(cell, [gone](std::uint8_t there) {
        const bool occupied = there >= 7 && there <= 13;
        if (gone) return occupied ? there : kCodeGone;
        return there == kCodeUnknown ? kCodePlanOnly : there;
      });
    }
  }
}

template <typename T>
void append_number(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

void append_header(std::string& out, const MapFrameHeader& header, std::uint8_t type, std::size_t tiles) {
  out.push_back(1);
  out.push_back(static_cast<char>(type));
  append_number<std::uint16_t>(out, 0);  // layer
  append_number<std::uint32_t>(out, header.epoch);
  append_number<std::uint64_t>(out, header.seq);
  append_number<std::uint64_t>(out, std::bit_cast<std::uint64_t>(header.server_ms));
  append_number<std::uint16_t>(out, static_cast<std::uint16_t>(tiles));
}

std::string deflate_raw(const PackedTile& cells) {
  z_stream stream{};
  ENGINE_EXPECT(deflateInit2(&stream, 6, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string out(deflateBound(&stream, cells.size()), '\0');
  stream.next_in = const_cast<Bytef*>(cells.data());  // zlib does not write there
  stream.avail_in = static_cast<uInt>(cells.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  ENGINE_EXPECT(status == Z_STREAM_END);
  return out;
}

bool inflate_raw(std::string_view bytes, PackedTile& cells) {
  z_stream stream{};
  if (inflateInit2(&stream, -15) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = cells.data();
  stream.avail_out = static_cast<uInt>(cells.size());
  const int status = inflate(&stream, Z_FINISH);
  const bool whole = status == Z_STREAM_END && stream.total_out == cells.size() && stream.avail_in == 0;
  inflateEnd(&stream);
  return whole;
}

/// Takes little-endian numbers from the front.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}
  template <typename T>
  T take() {
    std::uint64_t value = 0;
    if (rest_.size() < sizeof(T)) return short_ = true, T{};
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(rest_[i])) << (8 * i);
    rest_.remove_prefix(sizeof(T));
    return static_cast<T>(value);
  }
  std::string_view take(std::size_t count) {
    if (rest_.size() < count) return short_ = true, std::string_view();
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  bool ended_short() const { return short_; }
  bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  bool short_ = false;
};

}  // namespace

std::uint8_t occupancy_code(std::int8_t percent) {
  if (percent < 0 || percent > 100 || percent == 50) return kCodeUnknown;
  if (percent < 50) return static_cast<std::uint8_t>(1 + percent * 6 / 50);
  return static_cast<std::uint8_t>(7 + (percent - 51) * 7 / 50);
}

std::uint8_t code_at(const PackedTile& tile, int column, int row) {
  const std::uint8_t byte = tile[static_cast<std::size_t>(row * kTileCells + column) / 2];
  return column % 2 == 0 ? byte & 15 : byte >> 4;
}

std::map<TileKey, PackedTile> merged_tiles(const OccupancyGrid& sensed, const MergedMap& merged, double resolution_m) {
  ENGINE_EXPECT(resolution_m > 0);
  std::map<TileKey, PackedTile> tiles;
  Canvas canvas(tiles);
  if (!sensed.empty() && sensed.frame().origin.norm() < kFarthest_m) paint_sensed(sensed, resolution_m, canvas);
  paint_walls(merged, resolution_m, canvas);
  return tiles;
}

EncodedTile encode_tile(TileKey key, std::uint32_t version, const PackedTile& cells) {
  EncodedTile tile;
  tile.key = key;
  tile.version = version;
  const std::uint8_t first = cells[0];
  tile.uniform = (first & 15) == (first >> 4) &&
                 std::all_of(cells.begin(), cells.end(), [first](std::uint8_t byte) { return byte == first; });
  if (tile.uniform)
    tile.value = first & 15;
  else
    tile.deflated = deflate_raw(cells);
  return tile;
}

bool TileEncoder::update(const std::map<TileKey, PackedTile>& tiles, std::uint32_t version) {
  bool changed = false;
  const auto put = [&](TileKey key, const PackedTile& cells) {
    const auto [it, is_new] = cells_.try_emplace(key, cells);
    if (!is_new && it->second == cells) return;
    it->second = cells;
    table_[key] = std::make_shared<const EncodedTile>(encode_tile(key, version, cells));
    changed = true;
  };
  for (const auto& [key, cells] : tiles) put(key, cells);
  for (const auto& [key, cells] : cells_)
    if (!tiles.contains(key)) put(key, PackedTile{});
  return changed;
}

std::string map_frame(const MapFrameHeader& header, const std::vector<std::shared_ptr<const EncodedTile>>& tiles) {
  ENGINE_EXPECT(tiles.size() < 65'536);
  std::string out;
  append_header(out, header, 1, tiles.size());
  for (const auto& tile : tiles) {
    append_number(out, static_cast<std::uint16_t>(tile->key.x));
    append_number(out, static_cast<std::uint16_t>(tile->key.y));
    out.push_back(tile->uniform ? 0 : 1);
    out.push_back(static_cast<char>(tile->value));
    append_number<std::uint32_t>(out, tile->version);
    append_number(out, static_cast<std::uint32_t>(tile->deflated.size()));
    out += tile->deflated;
  }
  return out;
}

std::string end_of_snapshot_frame(const MapFrameHeader& header) {
  std::string out;
  append_header(out, header, 2, 0);
  return out;
}

Result<DecodedFrame> decode_map_frame(std::string_view text) {
  Bytes bytes(text);
  DecodedFrame frame;
  const auto version = bytes.take<std::uint8_t>();
  frame.type = bytes.take<std::uint8_t>();
  const auto layer = bytes.take<std::uint16_t>();
  frame.header.epoch = bytes.take<std::uint32_t>();
  frame.header.seq = bytes.take<std::uint64_t>();
  frame.header.server_ms = std::bit_cast<double>(bytes.take<std::uint64_t>());
  const auto count = bytes.take<std::uint16_t>();
  if (bytes.ended_short() || version != 1 || layer != 0 || (frame.type != 1 && (frame.type != 2 || count != 0)))
    return fail(Errc::kCorrupt, "not a map frame of version 1");
  for (int i = 0; i < count; ++i) {
    DecodedTile tile;
    tile.key.x = bytes.take<std::int16_t>();
    tile.key.y = bytes.take<std::int16_t>();
    const auto encoding = bytes.take<std::uint8_t>();
    const auto value = bytes.take<std::uint8_t>();
    tile.version = bytes.take<std::uint32_t>();
    const std::string_view deflated = bytes.take(bytes.take<std::uint32_t>());
    if (bytes.ended_short()) return fail(Errc::kCorrupt, "map frame cut off in a tile");
    if (encoding > 1 || value > 15 || (encoding == 0 ? !deflated.empty() : value != 0))
      return fail(Errc::kCorrupt, "map frame with a tile that says two things");
    if (encoding == 0)
      tile.cells.fill(static_cast<std::uint8_t>(value | (value << 4)));
    else if (!inflate_raw(deflated, tile.cells))
      return fail(Errc::kCorrupt, "tile that is not 8192 deflated bytes");
    frame.tiles.push_back(tile);
  }
  if (!bytes.empty()) return fail(Errc::kCorrupt, "map frame with bytes after its end");
  return frame;
}

}  // namespace smokemap::server
