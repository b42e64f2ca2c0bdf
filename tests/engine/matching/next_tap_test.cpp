#include "matching/next_tap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

Eigen::VectorXd even(Eigen::Index n) { return Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n)); }

TEST(NextTap, AsksWhereTheTwoAnswersDiffer) {
  // Three like rooms in a row, seen from either end: the middle one is the middle one anyhow.
  const std::vector<WeighedAnswer> answers = {{{0, 1, 2}, 1}, {{2, 1, 0}, 0.9}};
  const Eigen::VectorXd gains = expected_gains(answers, even(3), Eigen::VectorXd::Ones(3));
  EXPECT_NEAR(gains(0), gains(2), 1e-12);
  EXPECT_NEAR(gains(1), 0, 1e-12);
  EXPECT_NEAR(gains(0), 2.0 / 3 * 0.9 / 1.9, 1e-12);  // both ends become right where the second answer was
  EXPECT_NE(next_tap(answers, even(3), Eigen::VectorXd::Ones(3), {false, false, false}), 1);
}

TEST(NextTap, PrefersTheTapThatSettlesMoreThanItself) {
  // Answers differ in region 0 alone, and in regions 1 to 3 together.
  const std::vector<WeighedAnswer> answers = {
      {{0, 1, 2, 3}, 1}, {{9, 1, 2, 3}, 1}, {{0, 5, 6, 7}, 1}, {{9, 5, 6, 7}, 1}};
  const auto asked = next_tap(answers, even(4), Eigen::VectorXd::Ones(4), {false, false, false, false});
  ASSERT_TRUE(asked.has_value());
  EXPECT_NE(*asked, 0);
}

TEST(NextTap, AsksForTheLeastSureOfLikeSizesWhereAllAnswersAgree) {
  const std::vector<WeighedAnswer> answers = {{{0, 1, 2}, 1}};
  Eigen::VectorXd confidence(3);
  confidence << 0.9, 0.3, 0.6;
  EXPECT_EQ(next_tap(answers, even(3), confidence, {false, false, false}), 1);
  EXPECT_EQ(next_tap(answers, even(3), confidence, {false, true, false}), 2);
}

TEST(NextTap, AsksNothingWhenAllIsBoundOrSure) {
  const std::vector<WeighedAnswer> answers = {{{0, 1}, 1}};
  EXPECT_FALSE(next_tap(answers, even(2), Eigen::VectorXd::Ones(2), {false, false}).has_value());
  EXPECT_FALSE(next_tap(answers, even(2), Eigen::VectorXd::Zero(2), {true, true}).has_value());
  EXPECT_FALSE(next_tap({}, even(2), Eigen::VectorXd::Zero(2), {false, false}).has_value());
}

/// By playing it out: draw the true answer, tap, keep what agrees, say what most of it says, count what is right.
double played_gain(const std::vector<WeighedAnswer>& answers, const Eigen::VectorXd& importance, Eigen::Index tapped) {
  const auto right = [&](const std::vector<int>& truth, bool is_tapped) {
    double sum = 0;
    for (Eigen::Index i = 0; i < importance.size(); ++i) {
      std::map<int, double> votes;
      for (const WeighedAnswer& answer : answers)
        if (!is_tapped || answer.partner[static_cast<size_t>(tapped)] == truth[static_cast<size_t>(tapped)])
          votes[answer.partner[static_cast<size_t>(i)]] += answer.weight;
      const auto said = std::max_element(votes.begin(), votes.end(),
                                         [](const auto& one, const auto& two) { return one.second < two.second; });
      sum += said->first == truth[static_cast<size_t>(i)] ? importance(i) : 0;
    }
    return sum;
  };
  double gain = 0, total = 0;
  for (const WeighedAnswer& truth : answers) {
    gain += truth.weight * (right(truth.partner, true) - right(truth.partner, false));
    total += truth.weight;
  }
  return gain / total;
}

TEST(NextTap, ExpectsWhatPlayingAllCasesOutGives) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const auto n = 2 + static_cast<Eigen::Index>(uniform_index(random, 4));
    std::vector<WeighedAnswer> answers(2 + uniform_index(random, 4));
    for (WeighedAnswer& answer : answers) {
      for (Eigen::Index i = 0; i < n; ++i) answer.partner.push_back(static_cast<int>(uniform_index(random, 3)) - 1);
      answer.weight = uniform(random, 0.1, 1);
    }
    Eigen::VectorXd importance(n);
    for (Eigen::Index i = 0; i < n; ++i) importance(i) = uniform(random, 0.1, 1);
    importance /= importance.sum();
    const Eigen::VectorXd gains = expected_gains(answers, importance, Eigen::VectorXd::Ones(n));
    for (Eigen::Index i = 0; i < n; ++i) {
      EXPECT_NEAR(gains(i), played_gain(answers, importance, i), 1e-9);
      EXPECT_GE(gains(i), -1e-12);  // asking never hurts
    }
  }
}

}  // namespace
}  // namespace smokemap
