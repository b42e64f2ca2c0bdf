#include "core/expect.hpp"
#include "recording/layout_json.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = layout_from_json({reinterpret_cast<const char*>(data), size});
  if (!read) return 0;
  const auto corners = static_cast<int>(read->layout.corners.size());
  for (const LayoutWall& wall : read->layout.walls)
    ENGINE_EXPECT(wall.corner_a >= 0 && wall.corner_b >= 0 && wall.corner_a < corners && wall.corner_b < corners);
  ENGINE_EXPECT(layout_from_json(to_json(*read)).ok());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  return {
      bytes_of(R"({"size": [100, 80], "walls": [[0, 0, 50, 0, 3], [50, 0, 50, 40, 3]], "wall_confidence": [1, 0.5],
                       "corners": [[0, 0], [50, 0], [50, 40]], "wall_corners": [[0, 1], [1, 2]], "doors": [[10, 0, 20, 0]],
                       "door_kinds": ["window"], "rooms": [[[0, 0], [50, 0], [50, 40]]], "you_are_here": [5, 6],
                       "signs": [{"x": 1, "y": 2, "r": 3, "colour": "green", "confidence": 0.5}],
                       "metres_per_pixel": 0.02, "scale_sigma": 0.1, "homography": [1, 0, 0, 0, 1, 0, 0, 0, 1],
                       "sheet_corners": [[0, 0], [1, 0], [1, 1], [0, 1]], "warnings": ["tilted"]})"),
      bytes_of(R"({"size": [100, 80], "walls": [[0, 0, 50, 0, 3], [50.5, 0.5, 50, 40]], "metres_per_pixel": null})")};
}
