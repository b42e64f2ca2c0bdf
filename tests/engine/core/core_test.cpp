#include <gtest/gtest.h>

#include <set>

#include "core/check.hpp"
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

}  // namespace
}  // namespace smokemap
