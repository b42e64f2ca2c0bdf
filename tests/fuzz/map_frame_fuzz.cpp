#include "core/expect.hpp"
#include "server/wire/tiles.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;
using namespace smokemap::server;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto frame = decode_map_frame({reinterpret_cast<const char*>(data), size});
  if (!frame) return 0;
  for (const DecodedTile& tile : frame->tiles)
    for (int i = 0; i < kTileCells; ++i) ENGINE_EXPECT(code_at(tile.cells, i, i) <= 15);
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  PackedTile cells{}, other{};
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = static_cast<std::uint8_t>(i * 7 / 64);
  const auto tile = [](TileKey key, const PackedTile& packed) {
    return std::make_shared<const EncodedTile>(encode_tile(key, 3, packed));
  };
  return {bytes_of(map_frame({1, 2, 3}, {tile({0, 0}, cells), tile({-1, 5}, other)})),
          bytes_of(end_of_snapshot_frame({1, 2, 3})),
          bytes_of(map_frame({1, 2, 3}, {tile({7, 7}, cells), tile({8, 7}, cells), tile({9, 7}, cells)}))};
}
