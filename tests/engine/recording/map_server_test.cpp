#include "recording/map_server.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "core/random.hpp"
#include "tests/engine/recording/bag_file.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

OccupancyGrid random_grid(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  OccupancyGrid grid({0.05, {-3.25, 7.5}, 37, 23});
  for (auto& cell : grid.cells()) cell = static_cast<std::int8_t>(static_cast<int>(uniform_index(random, 102)) - 1);
  return grid;
}

TEST(MapServer, ComesBackAsItsThreeStatesInTheSamePlace) {
  const test::ScratchFolder folder;
  const OccupancyGrid grid = random_grid(3);
  ASSERT_THAT(write_map(grid, folder / "map"), test::IsOk());
  const auto read = read_map(folder / "map.yaml");
  ASSERT_THAT(read, test::IsOk());
  EXPECT_EQ(read->frame(), grid.frame());
  for (std::size_t i = 0; i < grid.cells().size(); ++i) {
    const int sent = grid.cells()[i];
    EXPECT_EQ(read->cells()[i], sent < 0 ? -1 : sent >= 65 ? 100 : sent <= 25 ? 0 : -1) << sent;
  }
}

TEST(MapServer, DrawsThePictureWithYUp) {
  const test::ScratchFolder folder;
  OccupancyGrid grid({1, {0, 0}, 2, 3});
  grid.at({0, 0}) = 100;
  grid.at({1, 2}) = 0;
  ASSERT_THAT(write_map(grid, folder / "map"), test::IsOk());
  for (const char* name : {"map.pgm", "map.png"}) {
    const cv::Mat image = cv::imread((folder / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(image.size(), cv::Size(2, 3));
    ASSERT_EQ(image.type(), CV_8UC1);
    EXPECT_EQ(image.at<std::uint8_t>(2, 0), 0);
    EXPECT_EQ(image.at<std::uint8_t>(0, 1), 254);
    EXPECT_EQ(image.at<std::uint8_t>(1, 1), 205);
  }
}

TEST(MapServer, ReadsWhatOtherToolsWrite) {
  const test::ScratchFolder folder;
  const cv::Mat image = (cv::Mat_<std::uint8_t>(1, 4) << 0, 100, 205, 254);
  cv::imwrite((folder / "m.png").string(), image);
  const auto map_with = [&](const std::string& more) {
    std::ofstream(folder / "m.yaml") << "# map\nimage: \"m.png\"\nresolution: 0.03  # m\norigin: [-1.5, 2, 0.0]\n"
                                     << more;
    auto map = read_map(folder / "m.yaml");
    EXPECT_THAT(map, test::IsOk());
    return map ? map->cells() : std::vector<std::int8_t>();
  };
  EXPECT_THAT(map_with("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"), testing::ElementsAre(100, -1, -1, 0));
  EXPECT_THAT(map_with("negate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"),
              testing::ElementsAre(0, -1, 100, 100));
  EXPECT_THAT(map_with("mode: raw\n"), testing::ElementsAre(0, 100, -1, -1));
  EXPECT_THAT(map_with("mode: scale\noccupied_thresh: 0.65\nfree_thresh: 0.1\n"), testing::ElementsAre(100, 91, 18, 0));
}

TEST(MapServer, SaysWhatIsWrongWithAMap) {
  const test::ScratchFolder folder;
  const auto reading = [&](const std::string& yaml) {
    std::ofstream(folder / "m.yaml") << yaml;
    return read_map(folder / "m.yaml");
  };
  EXPECT_THAT(write_map(OccupancyGrid(), folder / "map"), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(write_map(random_grid(1), folder / "nowhere" / "map"), test::Fails(Errc::kIo));
  EXPECT_THAT(read_map(folder / "none.yaml"), test::Fails(Errc::kIo));
  EXPECT_THAT(reading("resolution: 1\norigin: [0,0,0]\n"), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(reading("image: m.pgm\nresolution: nan\norigin: [0,0,0]\n"), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(reading("image: m.pgm\nresolution: 1\norigin: [0,0]\n"), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(reading("image: m.pgm\nresolution: 1\norigin: [0,0,1.57]\n"), test::Fails(Errc::kUnsupported));
  EXPECT_THAT(reading("image: m.pgm\nresolution: 1\norigin: [0,0,0]\nmode: fancy\n"), test::Fails(Errc::kUnsupported));
  std::ofstream(folder / "m.pgm") << "P5 no picture";
  EXPECT_THAT(reading("image: m.pgm\nresolution: 1\norigin: [0,0,0]\n"), test::Fails(Errc::kCorrupt));
}

}  // namespace
}  // namespace smokemap
