#include <gtest/gtest.h>

#include <set>

#include "core/check.hpp"
#include "core/progress.hpp"
#include "core/random.hpp"
#include "core/time.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

TEST(Result, HoldsAValueOrAReason) {
  Result<int> good = 7;
  Result<int> bad = fail(Errc::kDegenerate, "no free cell");
  EXPECT_THAT(good, test::IsOk());
  EXPECT_EQ(*good, 7);
  EXPECT_THAT(bad, test::Fails(Errc::kDegenerate));
  EXPECT_EQ(bad.error().message, "no free cell");
}

TEST(ResultDeathTest, TakingTheValueOfAFailureIsABrokenPromise) {
  Result<int> bad = fail(Errc::kIo, "disk full");
  EXPECT_DEATH((void)bad.value(), "broken promise");
}

TEST(ParamCheck, NamesTheFirstFieldOutOfRangeAndItsValue) {
  const auto result =
      ParamCheck("SlamParams").positive("cell_m", 0.1).in_range("gate_m", -2, 0, 1).positive("x", -1).result();
  ASSERT_THAT(result, test::Fails(Errc::kInvalidArgument));
  EXPECT_EQ(result.error().message, "SlamParams.gate_m is -2, must be within [0, 1]");
}

TEST(ParamCheck, RefusesNotANumber) {
  EXPECT_THAT(ParamCheck("P").in_range("x", std::nan(""), 0, 1).result(), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(ParamCheck("P").positive("x", std::nan("")).result(), test::Fails(Errc::kInvalidArgument));
}

TEST(Random, NormalHasTheAskedSpread) {
  std::mt19937_64 random(1);
  double sum = 0, squares = 0;
  constexpr int kDraws = 100'000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = normal(random, 2.0);
    sum += x, squares += x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.03);
  EXPECT_NEAR(std::sqrt(squares / kDraws), 2.0, 0.03);
}

TEST(Random, StreamsAreIndependentOfEachOthersExistence) {
  std::set<std::uint64_t> firsts;
  for (std::uint64_t robot = 0; robot < 100; ++robot) firsts.insert(random_stream(7, robot)());
  EXPECT_EQ(firsts.size(), 100u);
  EXPECT_EQ(random_stream(7, 3, 1)(), random_stream(7, 3, 1)());
}

TEST(Random, IndexReachesEveryValueEvenly) {
  std::mt19937_64 random(3);
  int counts[5] = {};
  for (int i = 0; i < 50'000; ++i) ++counts[uniform_index(random, 5)];
  for (const int count : counts) EXPECT_NEAR(count, 10'000, 500);
}

TEST(Time, SecondsGoThereAndBack) {
  EXPECT_EQ(from_seconds(1.5), 1'500'000'000);
  EXPECT_EQ(from_seconds(-0.25), -250'000'000);
  EXPECT_DOUBLE_EQ(to_seconds(from_seconds(12.125)), 12.125);
}

TEST(Time, RoundsToTheNearestNanosecondOnBothSidesOfZero) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 1000; ++i) {
    const double seconds = uniform(random, -1e6, 1e6);
    EXPECT_NEAR(to_seconds(from_seconds(seconds)), seconds, 1e-9 + 1e-15 * std::abs(seconds));
    EXPECT_EQ(from_seconds(-seconds), -from_seconds(seconds));
  }
}

TEST(Clock, AManualOneStandsStillUntilTold) {
  ManualClock clock;
  const Stamp before = clock.now();
  EXPECT_EQ(clock.now(), before);
  clock.advance(from_seconds(2));
  EXPECT_EQ(clock.now() - before, 2'000'000'000);
  EXPECT_GT(SystemClock().now(), from_seconds(1.5e9)) << "counts from 1970";
}

TEST(Result, IsMovedOutOfAndLookedInto) {
  Result<std::string> word = std::string("wall");
  EXPECT_EQ(word->size(), 4u);
  word->append("s");
  const std::string taken = *std::move(word);
  EXPECT_EQ(taken, "walls");
}

TEST(ResultDeathTest, AskingASuccessForItsErrorIsABrokenPromise) {
  const Result<int> good = 1;
  EXPECT_DEATH((void)good.error(), "broken promise");
}

TEST(Errc, EveryCodeHasAWordOfItsOwn) {
  std::set<std::string> words;
  for (int code = 0; code <= static_cast<int>(Errc::kNotConverged); ++code)
    words.insert(to_string(static_cast<Errc>(code)));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(Errc::kNotConverged) + 1);
  for (const std::string& word : words) EXPECT_EQ(word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), word.npos);
}

TEST(ParamCheck, TakesTheBordersOfARangeAndTellsARequirementInWords) {
  EXPECT_THAT(ParamCheck("P").in_range("x", 0, 0, 1).in_range("y", 1, 0, 1).result(), test::IsOk());
  EXPECT_THAT(ParamCheck("P").positive("x", 0).result(), test::Fails(Errc::kInvalidArgument));
  const auto refused = ParamCheck("P").require("x", false, "must be odd").result();
  ASSERT_THAT(refused, test::Fails(Errc::kInvalidArgument));
  EXPECT_NE(refused.error().message.find("must be odd"), std::string::npos);
}

TEST(Progress, WorksWithoutAListenerAndSeesTheStop) {
  Progress nobody;
  nobody.tell(0.5, "half");
  EXPECT_FALSE(nobody.cancelled());
  std::stop_source source;
  double told = 0;
  const Progress progress{[&](double fraction, std::string_view) { told = fraction; }, source.get_token()};
  progress.tell(0.25, "reading");
  EXPECT_EQ(told, 0.25);
  source.request_stop();
  EXPECT_TRUE(progress.cancelled());
}

TEST(Random, DrawsStayInTheirRanges) {
  std::mt19937_64 random(5);
  double mean = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double u = uniform01(random), v = uniform(random, -3, 5), e = exponential(random);
    EXPECT_TRUE(u >= 0 && u < 1 && v >= -3 && v < 5 && e >= 0);
    EXPECT_LT(uniform_index(random, 1), 1u);
    mean += e / 20'000;
  }
  EXPECT_NEAR(mean, 1, 0.03);
}

TEST(Random, NumbersAreTheSameOnEveryMachine) {
  auto random = random_stream(42, 1, 2, 3);
  const double first = uniform01(random), second = normal(random, 1);
  auto again = random_stream(42, 1, 2, 3);
  EXPECT_EQ(uniform01(again), first);
  EXPECT_EQ(normal(again, 1), second);
  EXPECT_NE(random_stream(42, 1, 2, 4)(), random_stream(42, 1, 2, 3)());
}

}  // namespace
}  // namespace smokemap
