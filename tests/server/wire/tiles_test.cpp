#include "server/wire/tiles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

constexpr double kResolution = 0.05;

OccupancyGrid random_grid(std::mt19937_64& random) {
  GridFrame frame{kResolution, Eigen::Vector2d::Zero(), 1 + static_cast<int>(uniform_index(random, 300)),
                  1 + static_cast<int>(uniform_index(random, 300))};
  frame.origin = kResolution * Eigen::Vector2d(static_cast<double>(uniform_index(random, 600)) - 300,
                                               static_cast<double>(uniform_index(random, 600)) - 300);
  OccupancyGrid grid(frame);
  for (auto& cell : grid.cells()) cell = static_cast<std::int8_t>(static_cast<int>(uniform_index(random, 102)) - 1);
  return grid;
}

std::uint8_t code_of(const std::map<TileKey, PackedTile>& tiles, int x, int y) {
  const auto floor_div = [](int a, int b) { return a >= 0 ? a / b : (a + 1) / b - 1; };
  const TileKey key{floor_div(x, kTileCells), floor_div(y, kTileCells)};
  const auto it = tiles.find(key);
  return it == tiles.end() ? kCodeUnknown : code_at(it->second, x - key.x * kTileCells, y - key.y * kTileCells);
}

TEST(OccupancyCode, OrdersFreeAndOccupiedByHowSureTheyAre) {
  EXPECT_EQ(occupancy_code(-1), 0);
  EXPECT_EQ(occupancy_code(0), 1);
  EXPECT_EQ(occupancy_code(49), 6);
  EXPECT_EQ(occupancy_code(50), 0) << "as good as nothing known";
  EXPECT_EQ(occupancy_code(51), 7);
  EXPECT_EQ(occupancy_code(100), 13);
  for (int percent = 1; percent <= 100; ++percent) {
    if (percent == 50 || percent == 51) continue;
    EXPECT_GE(occupancy_code(static_cast<std::int8_t>(percent)), occupancy_code(static_cast<std::int8_t>(percent - 1)));
  }
}

TEST(MergedTiles, HoldEveryCellOfTheGridWhereverItLies) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20; ++round) {
    const OccupancyGrid grid = random_grid(random);
    const auto tiles = merged_tiles(grid, MergedMap{}, kResolution);
    const GridFrame& frame = grid.frame();
    const int x0 = static_cast<int>(std::lround(frame.origin.x() / kResolution));
    const int y0 = static_cast<int>(std::lround(frame.origin.y() / kResolution));
    for (int i = 0; i < 500; ++i) {
      const Cell cell{static_cast<int>(uniform_index(random, 400)) - 50,
                      static_cast<int>(uniform_index(random, 400)) - 50};
      ASSERT_EQ(code_of(tiles, x0 + cell.x, y0 + cell.y), occupancy_code(grid.get(cell))) << cell.x << " " << cell.y;
    }
  }
}

TEST(MergedTiles, KeepAThinWallOfAFinerGridAndFillACoarserOne) {
  OccupancyGrid fine(GridFrame{0.01, Eigen::Vector2d::Zero(), 100, 100}, 0);
  for (int y = 0; y < 100; ++y) fine.at({42, y}) = 100;
  const auto tiles = merged_tiles(fine, MergedMap{}, kResolution);
  for (int y = 0; y < 20; ++y) EXPECT_EQ(code_of(tiles, 8, y), 13);
  EXPECT_EQ(code_of(tiles, 9, 5), 1);
  const OccupancyGrid coarse(GridFrame{0.1, Eigen::Vector2d::Zero(), 10, 10}, 0);
  const auto filled = merged_tiles(coarse, MergedMap{}, kResolution);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(code_of(filled, i, 19 - i), 1);
}

TEST(MergedTiles, DrawThePlanWhereNothingWasSeenAndSayWhatIsGone) {
  OccupancyGrid grid(GridFrame{kResolution, Eigen::Vector2d::Zero(), 40, 40});
  for (int x = 10; x < 20; ++x) grid.at({x, 10}) = 100;  // the first half of the wall was seen
  for (int y = 0; y < 40; ++y) grid.at({30, y}) = 0;     // nothing stands where the second wall should be
  MergedMap merged;
  const double y = 10.5 * kResolution, x = 30.5 * kResolution;
  merged.walls = {{0, {Point2(10.5 * kResolution, y), Point2(29 * kResolution, y)}, WallState::kUnseen, 1, 0, 0},
                  {1, {Point2(x, 0.01), Point2(x, 1.9)}, WallState::kMissing, 1, 2, 0},
                  {std::nullopt, {Point2(0, 0), Point2(0.2, 0)}, WallState::kNew, 1, 1, 0}};
  const auto tiles = merged_tiles(grid, merged, kResolution);
  EXPECT_EQ(code_of(tiles, 12, 10), 13);
  EXPECT_EQ(code_of(tiles, 25, 10), kCodePlanOnly);
  EXPECT_EQ(code_of(tiles, 30, 20), kCodeGone);
  EXPECT_EQ(code_of(tiles, 1, 0), kCodeUnknown) << "new walls are seen cells, not plan";
}

TEST(MergedTiles, IgnoreWallsThatAreNowhere) {
  MergedMap merged;
  merged.walls = {{0, {Point2(0, 0), Point2(std::nan(""), 0)}, WallState::kUnseen, 1, 0, 0},
                  {1, {Point2(1e9, 0), Point2(1e9, 1)}, WallState::kUnseen, 1, 0, 0}};
  EXPECT_TRUE(merged_tiles({}, merged, kResolution).empty());
}

TEST(MapFrame, DecodesToTheCellsThatWereEncoded) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 30; ++round) {
    PackedTile cells;
    const bool uniform_tile = round % 5 == 0;
    const auto value = static_cast<std::uint8_t>(uniform_index(random, 16) * 17);
    for (auto& byte : cells) byte = uniform_tile ? value : static_cast<std::uint8_t>(uniform_index(random, 256));
    const TileKey key{static_cast<int>(uniform_index(random, 400)) - 200, -7};
    const auto tile = std::make_shared<const EncodedTile>(encode_tile(key, 42, cells));
    EXPECT_EQ(tile->uniform, uniform_tile);
    const auto frame = decode_map_frame(map_frame({9, 1234567890123, 5.5}, {tile}));
    ASSERT_THAT(frame, test::IsOk());
    EXPECT_EQ(frame->header.seq, 1234567890123u);
    EXPECT_EQ(frame->header.server_ms, 5.5);
    ASSERT_EQ(frame->tiles.size(), 1u);
    EXPECT_EQ(frame->tiles[0].key, key);
    EXPECT_EQ(frame->tiles[0].version, 42u);
    EXPECT_EQ(frame->tiles[0].cells, cells);
  }
}

TEST(MapFrame, IsRefusedWhenCutShortAnywhere) {
  PackedTile cells{};
  cells[5] = 3;
  const std::string whole = map_frame({1, 2, 3}, {std::make_shared<const EncodedTile>(encode_tile({0, 0}, 1, cells))});
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THAT(decode_map_frame(std::string_view(whole).substr(0, size)), test::Fails(Errc::kCorrupt)) << size;
  EXPECT_THAT(decode_map_frame(whole + "x"), test::Fails(Errc::kCorrupt));
}

TEST(TileEncoder, GivesANewVersionOnlyToWhatChanged) {
  TileEncoder encoder;
  std::map<TileKey, PackedTile> tiles{{{0, 0}, PackedTile{}}, {{1, 0}, PackedTile{}}};
  tiles[{0, 0}][0] = 1;
  tiles[{1, 0}][0] = 2;
  EXPECT_TRUE(encoder.update(tiles, 1));
  EXPECT_FALSE(encoder.update(tiles, 2));
  const auto kept = encoder.table().at({0, 0});
  tiles[{1, 0}][0] = 3;
  EXPECT_TRUE(encoder.update(tiles, 3));
  EXPECT_EQ(encoder.table().at({0, 0}), kept) << "encoded once and shared";
  EXPECT_EQ(encoder.table().at({1, 0})->version, 3u);
}

TEST(TileEncoder, TurnsTilesThatVanishIntoUnknownOnes) {
  TileEncoder encoder;
  std::map<TileKey, PackedTile> tiles{{{4, 4}, PackedTile{}}};
  tiles[{4, 4}][0] = 1;
  encoder.update(tiles, 1);
  EXPECT_TRUE(encoder.update({}, 2));
  EXPECT_TRUE(encoder.table().at({4, 4})->uniform);
  EXPECT_EQ(encoder.table().at({4, 4})->value, kCodeUnknown);
  EXPECT_FALSE(encoder.update({}, 3));
}

std::shared_ptr<const EncodedTile> random_tile(std::mt19937_64& random) {
  PackedTile cells;
  const bool same = uniform01(random) < 0.4;
  const auto value = static_cast<std::uint8_t>(uniform_index(random, 16) * 17);
  for (auto& byte : cells) byte = same ? value : static_cast<std::uint8_t>(uniform_index(random, 256));
  const auto number = [&] { return static_cast<int>(uniform_index(random, 65536)) - 32768; };
  return std::make_shared<const EncodedTile>(
      encode_tile({number(), number()}, static_cast<std::uint32_t>(random()), cells));
}

TEST(MapFrame, OfSeveralTilesKeepsEveryNumberOfItsHeadAndItsTiles) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::shared_ptr<const EncodedTile>> tiles;
    for (std::uint64_t n = uniform_index(random, 6); n > 0; --n) tiles.push_back(random_tile(random));
    const MapFrameHeader header{static_cast<std::uint32_t>(random()), random(), uniform(random, -1e15, 1e15)};
    const std::string bytes = map_frame(header, tiles);
    const auto frame = decode_map_frame(bytes);
    ASSERT_THAT(frame, test::IsOk());
    EXPECT_EQ(frame->type, 1);
    EXPECT_EQ(frame->header.epoch, header.epoch);
    EXPECT_EQ(frame->header.seq, header.seq);
    EXPECT_EQ(frame->header.server_ms, header.server_ms);
    ASSERT_EQ(frame->tiles.size(), tiles.size());
    std::size_t size = 26;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      EXPECT_EQ(frame->tiles[i].key, tiles[i]->key);
      EXPECT_EQ(frame->tiles[i].version, tiles[i]->version);
      size += tiles[i]->wire_bytes();
      const auto again = encode_tile(frame->tiles[i].key, frame->tiles[i].version, frame->tiles[i].cells);
      EXPECT_EQ(again.deflated, tiles[i]->deflated);
      EXPECT_EQ(again.value, tiles[i]->value);
    }
    EXPECT_EQ(bytes.size(), size) << "wire_bytes says what a tile costs";
  }
}

TEST(MapFrame, OfNothingButItsEndIsShort) {
  const std::string end = end_of_snapshot_frame({7, 8, 9.5});
  EXPECT_EQ(end.size(), 26u);
  const auto frame = decode_map_frame(end);
  ASSERT_THAT(frame, test::IsOk());
  EXPECT_EQ(frame->type, 2);
  EXPECT_EQ(frame->header.seq, 8u);
  for (std::size_t size = 0; size < end.size(); ++size)
    EXPECT_THAT(decode_map_frame(end.substr(0, size)), test::Fails(Errc::kCorrupt)) << size;
}

TEST(MapFrame, SurvivesAnyDamage) {
  std::mt19937_64 random(8);
  const std::string whole = map_frame({1, 2, 3}, {random_tile(random), random_tile(random), random_tile(random)});
  int taken = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = whole;
    for (std::uint64_t n = 1 + uniform_index(random, 4); n > 0; --n)
      bytes[uniform_index(random, i % 2 == 0 ? 60 : bytes.size())] = static_cast<char>(uniform_index(random, 256));
    if (i % 3 == 0) bytes.resize(uniform_index(random, bytes.size()));
    const auto frame = decode_map_frame(bytes);
    taken += frame.ok();
    EXPECT_TRUE(!frame || frame->tiles.size() <= 3u);
  }
  EXPECT_GT(taken, 10) << "other numbers in the head are other numbers";
}

TEST(MapFrame, TheReaderTookFramesThatTheWriterNeverWrites) {
  PackedTile cells{};
  const std::string uniform_frame =
      map_frame({1, 2, 3}, {std::make_shared<EncodedTile>(encode_tile({0, 0}, 1, cells))});
  cells[5] = 3;
  const std::string packed_frame = map_frame({1, 2, 3}, {std::make_shared<EncodedTile>(encode_tile({0, 0}, 1, cells))});
  const auto changed = [](std::string bytes, std::size_t at, char value) {
    bytes[at] = value;
    return decode_map_frame(bytes);
  };
  EXPECT_THAT(changed(uniform_frame, 2, 1), test::Fails(Errc::kCorrupt)) << "a layer that nobody knows";
  EXPECT_THAT(changed(uniform_frame, 1, 2), test::Fails(Errc::kCorrupt)) << "an end with tiles";
  EXPECT_THAT(changed(packed_frame, 31, 5), test::Fails(Errc::kCorrupt)) << "a packed tile with a value";
  std::string two_things = uniform_frame;
  two_things[36] = 1;  // one byte of packed cells, in a uniform tile
  EXPECT_THAT(decode_map_frame(two_things + "x"), test::Fails(Errc::kCorrupt));
}

TEST(MergedTiles, DrawAWallTheSameInBothDirections) {
  std::mt19937_64 random(9);
  for (int round = 0; round < 50; ++round) {
    const Point2 a(uniform(random, -20, 20), uniform(random, -20, 20));
    const Point2 b = a + Point2(uniform(random, -9, 9), uniform(random, -9, 9));
    MergedMap there, back;
    there.walls = {{0, {a, b}, WallState::kUnseen, 1, 0, 0}};
    back.walls = {{0, {b, a}, WallState::kUnseen, 1, 0, 0}};
    const auto tiles = merged_tiles({}, there, kResolution);
    const auto cell = [](double v) { return static_cast<int>(std::floor(v / kResolution)); };
    for (int i = 0; i <= 100; ++i) {  // every point of the wall lies in a painted cell or beside one
      const Point2 p = a + i / 100.0 * (b - a);
      bool painted = false;
      for (int k = 0; k < 9; ++k)
        painted = painted || code_of(tiles, cell(p.x()) + k % 3 - 1, cell(p.y()) + k / 3 - 1) == kCodePlanOnly;
      EXPECT_TRUE(painted) << p.transpose();
    }
    EXPECT_EQ(code_of(tiles, cell(a.x()), cell(a.y())), kCodePlanOnly);
    EXPECT_EQ(code_of(tiles, cell(b.x()), cell(b.y())), kCodePlanOnly);
    EXPECT_EQ(merged_tiles({}, back, kResolution).size(), tiles.size());
  }
}

}  // namespace
}  // namespace smokemap::server
