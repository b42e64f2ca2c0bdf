// Bad input gets status 1 and one clear line, and leaves no half-written answer.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/smokemap_program.hpp"

namespace smokemap::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct BadInput {
  std::vector<std::string> arguments;
  std::string says;
};

/// What ctest calls the case.
void PrintTo(const BadInput& c, std::ostream* out) {
  for (const std::string& argument : c.arguments) *out << argument << ' ';
}

/// A folder with one of everything that is not what its name says.
struct BadFiles : SmokemapFolder {
  BadFiles() {
    write("empty", "");
    write("noise.png", "these are no pixels");
    write_map("map.png");
    write("cut.png", text("map.png").substr(0, 300));
    write("noise.log", "\x01\x02 no log\n");
    write("scanless.log", "# a log of nobody\nPARAM robot_front_laser_max 30\n");
    write("brackets.json", std::string(100'000, '['));
    write("object.json", "{}");
    write("layout.json", R"({"size":[100,100],"walls":[[0,0,1e999,0,3]]})");
    write("words.tum", "one two three four\n");
    write("scenario.json", R"({"lenght_m": 30})");
    write("types.json", R"({"length_m": "thirty"})");
    write("strokes.json", R"({"strokes":[{"points":[[1],[2]]}]})");
    write("white.png", "");
    EXPECT_TRUE(cv::imwrite(path("white.png"), cv::Mat(60, 80, CV_8UC1, cv::Scalar(255))));
    EXPECT_TRUE(cv::imwrite(path("black.png"), cv::Mat(60, 80, CV_8UC1, cv::Scalar(0))));
    before = names();
  }
  std::vector<std::string> before;
};

class RefusedInput : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedInput, IsSaidInOneLineAndNothingIsWritten) {
  const BadFiles here;
  const Ran ran = here.run(GetParam().arguments);
  EXPECT_EQ(ran.status, 1) << ran.errors;
  EXPECT_THAT(ran.errors, HasSubstr("smokemap: "));
  EXPECT_THAT(ran.errors, HasSubstr(GetParam().says));
  EXPECT_EQ(lines_of(ran.errors.substr(ran.errors.find("smokemap: "))), 1u) << ran.errors;
  EXPECT_EQ(here.names(), here.before) << "an answer was left behind";
}

using Args = std::vector<std::string>;

INSTANTIATE_TEST_SUITE_P(
    Missing, RefusedInput,
    testing::Values(BadInput{Args{"segment", "none.png", "-o", "x.png"}, "none.png"},
                    BadInput{Args{"match", "none.png", "map.png", "-o", "x.json"}, "none.png"},
                    BadInput{Args{"match", "map.png", "map.png", "--pins", "none.json", "-o", "x.json"}, "none.json"},
                    BadInput{Args{"layout", "none.png", "-o", "x.json"}, "none.png"},
                    BadInput{Args{"sketch", "none.png", "-o", "x.png"}, "none.png"},
                    BadInput{Args{"slam", "none.log", "-o", "x.tum"}, "none.log"},
                    BadInput{Args{"convert", "none.log", "x.mcap"}, "none.log"},
                    BadInput{Args{"robot", "--bag", "none.log"}, "none.log"},
                    BadInput{Args{"merge", "--layout", "none.json", "--log", "a.log", "-o", "x.json"}, "none.json"},
                    BadInput{Args{"evaluate", "none.tum", "--truth", "words.tum"}, "none.tum"},
                    BadInput{Args{"simulate", "none.json", "-o", "x.mcap"}, "none.json"}));

INSTANTIATE_TEST_SUITE_P(
    Damaged, RefusedInput,
    testing::Values(BadInput{Args{"segment", "noise.png", "-o", "x.png"}, "noise.png is not a picture"},
                    BadInput{Args{"segment", "cut.png", "-o", "x.png"}, "cut.png"},
                    BadInput{Args{"layout", "noise.png", "-o", "x.json"}, "no PNG"},
                    BadInput{Args{"layout", "cut.png", "-o", "x.json"}, "cannot be decoded"},
                    BadInput{Args{"sketch", "empty", "-o", "x.png"}, "no PNG"},
                    BadInput{Args{"sketch", "strokes.json", "-o", "x.png"}, "the strokes"},
                    BadInput{Args{"slam", "noise.log", "-o", "x.tum"}, "no log we read"},
                    BadInput{Args{"slam", "empty", "-o", "x.tum"}, "no log we read"},
                    BadInput{Args{"convert", "noise.log", "x.mcap"}, "no log we read"},
                    BadInput{Args{"merge", "--layout", "brackets.json", "--log", "a", "-o", "x.json"}, "layout"},
                    BadInput{Args{"merge", "--layout", "layout.json", "--log", "a", "-o", "x.json"}, ""},
                    BadInput{Args{"match", "map.png", "map.png", "--pins", "object.json", "-o", "x.json"}, "pins"},
                    BadInput{Args{"evaluate", "words.tum", "--truth", "words.tum"}, "words.tum:1"},
                    BadInput{Args{"evaluate", "empty", "--truth", "empty"}, "fewer than two poses"},
                    BadInput{Args{"simulate", "types.json", "-o", "x.mcap"}, "types.json"}));

INSTANTIATE_TEST_SUITE_P(WithoutAnswer, RefusedInput,
                         testing::Values(BadInput{Args{"segment", "black.png", "-o", "x.png"}, ""},
                                         BadInput{Args{"match", "black.png", "map.png", "-o", "x.json"}, "black.png"},
                                         BadInput{Args{"layout", "white.png", "-o", "x.json"}, ""},
                                         BadInput{Args{"slam", "scanless.log", "-o", "x.tum"}, ""}));

INSTANTIATE_TEST_SUITE_P(
    UnwritableOutput, RefusedInput,
    testing::Values(BadInput{Args{"segment", "map.png", "-o", "no/x.png"}, "cannot write no/x.png"},
                    BadInput{Args{"segment", "map.png", "-o", "x.cake"}, "cannot write x.cake"},
                    BadInput{Args{"match", "map.png", "map.png", "-o", "no/x.json"}, "cannot write"},
                    BadInput{Args{"simulate", "-o", "no/x.mcap", "--duration", "0.2"}, "cannot write no/x.mcap"},
                    BadInput{Args{"simulate", "-o", "x.mcap", "--duration", "0.2", "--plan", "x.cake"}, "x.cake"},
                    BadInput{Args{"serve", "--port", "0", "--data", "/proc/none"}, "/proc/none"},
                    BadInput{Args{"serve", "--port", "0", "--data", "map.png"}, "map.png"}));

TEST(RefusedInput, IsSaidAsJsonTooWhereverTheFlagStands) {
  const SmokemapFolder here;
  for (const Args& arguments :
       {Args{"--json", "convert", "none.log", "x.mcap"}, Args{"convert", "none.log", "x.mcap", "--json"}}) {
    const Ran ran = here.run(arguments);
    EXPECT_EQ(ran.status, 1);
    const auto said = nlohmann::json::parse(ran.output, nullptr, false);
    ASSERT_TRUE(said.is_object()) << ran.output;
    EXPECT_EQ(said["error"]["code"], "io");
    EXPECT_EQ("smokemap: " + said["error"]["message"].get<std::string>() + "\n", ran.errors);
  }
}

TEST(RefusedInput, OfAMisspeltScenarioNamesTheField) {
  const BadFiles here;
  const Ran ran = here.run({"simulate", "scenario.json", "-o", "x.mcap"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.errors, HasSubstr("unknown field \"lenght_m\""));
  EXPECT_FALSE(here.has("x.mcap"));
}

TEST(FullDisk, IsToldAndLeavesNoPart) {
  const SmokemapFolder here;
  std::filesystem::create_symlink("/dev/full", here.path("full.mcap"));  // every write says: no space left
  const Ran ran = here.run({"simulate", "-o", "full.mcap", "--duration", "0.2"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.errors, StartsWith("smokemap: cannot write full.mcap"));
  EXPECT_EQ(here.names(), Args{"full.mcap"});
}

TEST(PreviewThatCannotBeWritten, IsSaidInOneLine) {
  const SmokemapFolder here;
  here.write("strokes.json",
             R"({"width":400,"height":300,"strokes":[{"points":[[10,10],[300,10],[300,200],[10,200],[10,10]]}]})");
  const Ran ran = here.run({"sketch", "strokes.json", "-o", "x.png", "--preview", "x.cake"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.errors, StartsWith("smokemap: cannot write x.cake"));
  EXPECT_EQ(lines_of(ran.errors), 1u);
}

}  // namespace
}  // namespace smokemap::test
