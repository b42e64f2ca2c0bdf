// What `smokemap evaluate` says, and what it refuses to say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/smokemap_program.hpp"

namespace smokemap::test {
namespace {

using testing::HasSubstr;

/// A robot that drives 0.1 m a second along x; two of three seconds have a pose, every second a relation.
struct DrivenFiles : SmokemapFolder {
  DrivenFiles() {
    std::ostringstream log, every, third, relations;
    for (int t = 0; t <= 30; ++t) {
      log << "ODOM " << 0.1 * t << " 0 0 0 0 0 " << t << ".0 host " << t << ".0\n";
      every << t << ".0 " << 0.1 * t << " 0 0\n";
      if (t % 3 != 2) third << t << ".0 " << 0.1 * t << " 0 0\n";
      if (t > 0) relations << t - 1 << ".0 " << t << ".0 0.1 0 0 0 0 0\n";
    }
    write("run.log", log.str());
    write("every.txt", every.str());
    write("third.txt", third.str());
    write("run.relations", relations.str());
  }
};

TEST(Evaluate, SaysThatRelationsAreMissingInsteadOfAMeanOfTheRest) {
  const DrivenFiles here;
  const Ran without = here.run({"evaluate", "third.txt", "--relations", "run.relations"});
  EXPECT_EQ(without.status, 1);
  EXPECT_THAT(without.errors, HasSubstr("20 of 30 relations"));
  EXPECT_THAT(without.output, Not(HasSubstr("mean")));

  const Ran with = here.run({"evaluate", "third.txt", "--relations", "run.relations", "--log", "run.log"});
  ASSERT_EQ(with.status, 0) << with.errors;
  const nlohmann::json report = nlohmann::json::parse(with.output).at("relation_error");
  EXPECT_EQ(report.at("missing"), 0);
  EXPECT_EQ(report.at("relations"), 30);
  EXPECT_LT(report.at("translation_m").at("max").get<double>(), 1e-6);
  EXPECT_EQ(report.at("clear_stamps").at("relations"), 30);
}

TEST(Evaluate, NeedsNoLogWhereEveryStampHasAPose) {
  const DrivenFiles here;
  const Ran ran = here.run({"evaluate", "every.txt", "--relations", "run.relations"});
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const nlohmann::json report = nlohmann::json::parse(ran.output).at("relation_error");
  EXPECT_EQ(report.at("missing"), 0);
  EXPECT_LT(report.at("translation_m").at("mean").get<double>(), 1e-6);
  EXPECT_FALSE(report.contains("clear_stamps"));  // nobody knows without the log
}

}  // namespace
}  // namespace smokemap::test
