#include <cstring>

#include "core/expect.hpp"
#include "sketch/clean_sketch.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

namespace {

/// Five bytes a point: what to do (new stroke of a kind, or go on), x and y as signed 16 bit.
SketchMap sketch_of(const std::uint8_t* data, std::size_t size) {
  SketchMap sketch{160, 120, {}};
  for (std::size_t i = 0; i + 5 <= size && i < 2000; i += 5) {
    if (sketch.strokes.empty() || data[i] < 24) {
      Stroke stroke;
      stroke.kind = static_cast<StrokeKind>(data[i] % 3);
      stroke.width_px = data[i] % 11;
      sketch.strokes.push_back(stroke);
    }
    std::int16_t xy[2];
    std::memcpy(xy, data + i + 1, sizeof xy);
    sketch.strokes.back().points_px.emplace_back(xy[0] / 16.0, xy[1] / 16.0);
  }
  return sketch;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const SketchMap sketch = sketch_of(data, size);
  const auto clean = clean_sketch(sketch);
  if (!clean) return 0;
  ENGINE_EXPECT(clean->free_space.cols == sketch.width_px && clean->free_space.rows == sketch.height_px);
  for (const auto& gap : clean->gaps) ENGINE_EXPECT(gap.gap_px.a.allFinite() && gap.gap_px.b.allFinite());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  Bytes room;
  const auto point = [&](std::uint8_t act, int x, int y) {
    const std::int16_t xy[2] = {static_cast<std::int16_t>(16 * x), static_cast<std::int16_t>(16 * y)};
    room.push_back(act);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(xy);
    room.insert(room.end(), bytes, bytes + sizeof xy);
  };
  point(3, 20, 20), point(99, 140, 20), point(99, 140, 100), point(99, 20, 100), point(99, 20, 20);
  point(3, 80, 20), point(99, 80, 100), point(4, 80, 50), point(99, 80, 70);
  return {room, {}};
}
