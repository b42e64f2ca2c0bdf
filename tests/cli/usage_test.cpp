// What a person sees who does not know the program yet: help, versions, words that are none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/cli/smokemap_program.hpp"

namespace smokemap::test {
namespace {

using testing::HasSubstr;

TEST(Usage, ListsEverySubcommandAndNoOther) {
  const SmokemapFolder here;
  const Ran help = here.run({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.errors, "");
  const std::string list = help.output.substr(help.output.find("Subcommands:"));
  for (const std::string& name : subcommands()) EXPECT_THAT(list, HasSubstr("  " + name + " "));
  std::istringstream lines(list);
  std::size_t named = 0;
  for (std::string line; std::getline(lines, line);) named += line.size() > 2 && line[0] == ' ' && line[2] != ' ';
  EXPECT_EQ(named, subcommands().size()) << "a subcommand without a test:\n" << list;
}

TEST(Usage, OfEverySubcommandNamesItsOptionsWithTheirMeaning) {
  const SmokemapFolder here;
  for (const std::string& name : subcommands()) {
    const Ran help = here.run({name, "--help"});
    EXPECT_EQ(help.status, 0) << name;
    EXPECT_EQ(help.errors, "") << name;
    EXPECT_THAT(help.output, HasSubstr("Options:")) << name;
    std::istringstream lines(help.output.substr(help.output.find("Options:")));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);)
      if (line.starts_with("  -")) {  // its meaning stands beside it, or below
        EXPECT_TRUE(line.find("  ", 2) != std::string::npos || lines.peek() == ' ')
            << name << " leaves unsaid: " << line;
      }
  }
}

TEST(Usage, SaysItsVersion) {
  const SmokemapFolder here;
  const Ran version = here.run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.output, "smokemap 0.1.0\n");
}

struct Misuse {
  std::vector<std::string> arguments;
  std::string says;
};

/// What ctest calls the case.
void PrintTo(const Misuse& c, std::ostream* out) {
  *out << "smokemap";
  for (const std::string& argument : c.arguments) *out << ' ' << argument;
}

class Misused : public testing::TestWithParam<Misuse> {};

TEST_P(Misused, EndsWithStatusTwoAndWritesNothing) {
  const SmokemapFolder here;
  const Ran ran = here.run(GetParam().arguments);
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.errors, HasSubstr(GetParam().says));
  EXPECT_EQ(ran.output, "");
  EXPECT_TRUE(here.names().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Words, Misused,
    testing::Values(Misuse{{}, "subcommand is required"}, Misuse{{"dance"}, "there is no subcommand 'dance'"},
                    Misuse{{"segment"}, "map is required"}, Misuse{{"slam", "a.log"}, "--output is required"},
                    Misuse{{"slam", "a.log", "-o", "t.tum", "--sensor", "nose"}, "nose"},
                    Misuse{{"segment", "a.png", "-o", "b.png", "--kind", "cake"}, "cake"},
                    Misuse{{"layout", "a.png", "-o", "b.json", "--corners", "1,2,3"}, "--corners"},
                    Misuse{{"evaluate", "a.tum"}, "give --relations or --truth"},
                    Misuse{{"serve", "--port", "70000"}, "70000"}, Misuse{{"serve", "--ros-domain", "231"}, "231"},
                    Misuse{{"robot", "--bag", "a", "--rate", "0"}, "--rate"},
                    Misuse{{"simulate", "-o", "r.mcap", "--duration", "-5"}, "max_duration_s"},
                    Misuse{{"simulate", "-o", "r.mcap", "--duration", "nan"}, "max_duration_s"},
                    Misuse{{"simulate", "-o", "r.mcap", "--robots", "0"}, "--robots"},
                    Misuse{{"simulate", "-o", "r.mcap", "--seed", "-1"}, "--seed"},
                    Misuse{{"merge", "--layout", "a.json", "--log", "b.log"}, "--output is required"},
                    Misuse{{"convert", "a.log", "b.mcap", "c"}, "not expected"}));

}  // namespace
}  // namespace smokemap::test
