// Small whole journeys: what one subcommand writes is what the next one reads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/smokemap_program.hpp"

namespace smokemap::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json parsed(const std::string& text) { return json::parse(text, nullptr, false); }

/// The true poses of a simulated run in the form that `evaluate --truth` reads.
std::string truth_lines(const json& truth) {
  std::string lines;
  for (const json& pose : truth["poses"])
    lines += pose[0].dump() + " " + pose[1].dump() + " " + pose[2].dump() + " " + pose[3].dump() + "\n";
  return lines;
}

TEST(Journey, OfASimulatedRobotEndsInAMergedMapThatIsJudged) {
  const SmokemapFolder here;
  Ran ran = here.run({"simulate", "-o", "run.mcap", "--seed", "3", "--duration", "12", "--no-radar", "--truth",
                      "truth.json", "--plan", "plan.png", "--layout", "layout.json", "--anchors", "anchors.json",
                      "--points", "points.json"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_THAT(ran.output, HasSubstr("120 scans"));
  ran = here.run({"slam", "run.mcap", "-o", "poses.tum", "--map", "map", "--stats", "stats.json"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(parsed(here.text("stats.json"))["scans"], 120);
  for (const char* name : {"map.pgm", "map.yaml", "map.png"}) EXPECT_TRUE(here.has(name)) << name;

  here.write("truth.txt", truth_lines(parsed(here.text("truth.json"))));
  ran = here.run({"evaluate", "poses.tum", "--truth", "truth.txt"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_LT(parsed(ran.output)["against_truth"]["ate_rmse_m"].get<double>(), 0.1);

  ran = here.run({"merge", "--layout", "layout.json", "--log", "run.mcap", "--anchors", "anchors.json", "--points",
                  "points.json", "-o", "merged.json", "--trajectory", "corrected.tum", "--preview", "merged.png"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const json merged = parsed(here.text("merged.json"));
  EXPECT_EQ(merged["points"].size(), parsed(here.text("points.json"))["points"].size());
  EXPECT_FALSE(merged["walls"].empty());
  for (const json& wall : merged["walls"]) {
    EXPECT_GE(wall["confidence"], 0);
    EXPECT_LE(wall["confidence"], 1);
  }
  EXPECT_FALSE(cv::imread(here.path("merged.png")).empty());
}

TEST(Journey, OfASeedIsTheSameToTheByte) {
  const SmokemapFolder here;
  for (const char* name : {"a.mcap", "b.mcap", "c.mcap"}) {
    const Ran ran = here.run({"simulate", "-o", name, "--seed", name[0] == 'c' ? "5" : "4", "--duration", "2"});
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  EXPECT_EQ(here.text("a.mcap"), here.text("b.mcap"));
  EXPECT_NE(here.text("a.mcap"), here.text("c.mcap"));
}

TEST(Journey, OfALogThroughEveryFormatKeepsItsScans) {
  const SmokemapFolder here;
  ASSERT_EQ(here.run({"simulate", "-o", "run.log", "--duration", "3"}).status, 0);
  const Ran first = here.run({"convert", "run.log", "once.mcap"});
  const Ran second = here.run({"convert", "once.mcap", "twice.mcap"});
  EXPECT_THAT(first.output, HasSubstr("30 scans"));
  EXPECT_EQ(first.output, second.output);
  here.write("cut.mcap", here.text("once.mcap").substr(0, here.text("once.mcap").size() * 2 / 3));
  const Ran cut = here.run({"convert", "cut.mcap", "rest.mcap"});
  EXPECT_TRUE(cut.status == 0 || cut.status == 1);
  EXPECT_FALSE(cut.errors.empty()) << "a log that ends early is told of";
}

TEST(Journey, OfAPlanPictureEndsInWalls) {
  const SmokemapFolder here;
  ASSERT_EQ(here.run({"simulate", "-o", "run.mcap", "--duration", "0.2", "--plan", "plan.png"}).status, 0);
  const Ran ran =
      here.run({"layout", "plan.png", "-o", "layout.json", "--metres-per-pixel", "0.05", "--preview", "over.png"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const json layout = parsed(here.text("layout.json"));
  EXPECT_GT(layout["walls"].size(), 10u);
  EXPECT_GT(layout["corners"].size(), 5u);
  EXPECT_EQ(layout["metres_per_pixel"], 0.05);
  const cv::Mat plan = cv::imread(here.path("plan.png")), over = cv::imread(here.path("over.png"));
  EXPECT_EQ(layout["size"], (json{over.cols, over.rows}));
  EXPECT_FALSE(plan.empty());
}

TEST(Journey, OfTwoMapsEndsInPairsAndCarriedPoints) {
  const SmokemapFolder here;
  here.write_map("a.png");
  here.write_map("b.png", 12);
  Ran ran = here.run({"segment", "a.png", "-o", "labels.png", "--json", "regions.json", "--preview", "preview.png",
                      "--topology", "graph.png"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const cv::Mat labels = cv::imread(here.path("labels.png"), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(labels.type(), CV_16UC1);
  EXPECT_EQ(labels.at<std::uint16_t>(5, 5), 0) << "outside is no region";
  const auto left = labels.at<std::uint16_t>(60, 60), right = labels.at<std::uint16_t>(60, 250);
  EXPECT_NE(left, 0);
  EXPECT_NE(right, 0);
  EXPECT_NE(left, right) << "the door parts two rooms";
  EXPECT_GE(parsed(here.text("regions.json"))["regions"].size(), 2u);
  const json graph = parsed(here.text("regions.json"))["topology"];
  ASSERT_GE(graph["nodes"].size(), 2u);
  ASSERT_GE(graph["edges"].size(), 1u);
  for (const json& edge : graph["edges"]) {
    EXPECT_EQ(edge["path"].front(), graph["nodes"][edge["from"].get<size_t>()]["at"]);
    EXPECT_EQ(edge["path"].back(), graph["nodes"][edge["to"].get<size_t>()]["at"]);
    EXPECT_GT(edge["length"], 0);
  }
  EXPECT_TRUE(here.has("graph.png"));

  here.write("points.json", R"({"points": [[60, 60], [250, 180], [5, 5]]})");
  here.write("pins.json", R"({"pins": [{"sketch": [40, 40], "map": [40, 40]}]})");
  ran = here.run({"match", "a.png", "b.png", "-o", "match.json", "--points", "points.json", "--pins", "pins.json"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const json match = parsed(here.text("match.json"));
  ASSERT_EQ(match["transfer"].size(), 3u);
  EXPECT_NEAR(match["transfer"][0][0].get<double>(), 60, 15);
  EXPECT_NEAR(match["transfer"][1][1].get<double>(), 180, 15);
  EXPECT_GT(match["transfer_sigma_px"][0], 0) << "no place is carried over as if it were certain";
  EXPECT_TRUE(here.has(match["sketch_labels"].get<std::string>()));
  EXPECT_TRUE(here.has(match["metric_labels"].get<std::string>()));
}

TEST(Journey, OfADrawingEndsInFreeSpaceWithoutTheOutside) {
  const SmokemapFolder here;
  here.write("strokes.json", R"({"width":400,"height":300,"strokes":[
    {"points":[[40,40],[360,40],[360,260],[40,260],[40,44]]},{"points":[[200,40],[200,130]]},
    {"points":[[200,170],[200,260]]},{"points":[[200,130],[200,170]],"kind":"door"}]})");
  const Ran ran = here.run({"sketch", "strokes.json", "-o", "free.png", "--preview", "drawn.png"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const cv::Mat free_space = cv::imread(here.path("free.png"), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(free_space.empty());
  const double scale = free_space.cols / 400.0;
  const auto at = [&](int x, int y) {
    return static_cast<int>(free_space.at<std::uint8_t>(static_cast<int>(y * scale), static_cast<int>(x * scale)));
  };
  EXPECT_EQ(at(100, 150), 255);
  EXPECT_EQ(at(300, 150), 255);
  EXPECT_EQ(at(10, 10), 0) << "outside of the drawing is no room";
}

}  // namespace
}  // namespace smokemap::test
