#include <filesystem>
#include <fstream>

#include "core/expect.hpp"
#include "recording/map_server.hpp"
#include "tests/fuzz/driver.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace smokemap;

namespace {

/// A folder with a sound picture; the yaml beside it is what is tried.
struct MapFolder {
  MapFolder() {
    GridFrame frame;
    frame.resolution_m = 0.1;
    frame.width_cells = 7, frame.height_cells = 5;
    ENGINE_EXPECT(write_map(OccupancyGrid(frame, 0), folder.path() + "/map").ok());
  }
  test::TemporaryFolder folder;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MapFolder at;
  const std::string yaml = at.folder.path() + "/tried.yaml";
  std::filesystem::remove(yaml);  // writing over it would wait for the disk
  std::ofstream(yaml, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const auto grid = read_map(yaml);
  if (!grid) return 0;
  ENGINE_EXPECT(grid->frame().width_cells == 7 && grid->frame().height_cells == 5);
  ENGINE_EXPECT(grid->frame().resolution_m > 0 && grid->frame().origin.allFinite());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  const auto with = [](std::string_view mode) {
    return "image: map.pgm\nmode: " + std::string(mode) +
           "\nresolution: 0.05\norigin: [-1.5, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  };
  return {bytes_of(with("trinary")), bytes_of(with("raw")),
          bytes_of("---\n\"image\": 'map.png' # there\n" + with("scale"))};
}
