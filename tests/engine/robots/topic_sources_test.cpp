#include "robots/topic_sources.hpp"

#include <gtest/gtest.h>

#include <random>

#include "robots/ros_names.hpp"

namespace smokemap {
namespace {

constexpr double kSilentAfterS = 2;
const std::string kScan = "rt/red/scan";

DdsGuid participant(std::uint8_t number) { return {number}; }

TopicTable network_of(std::initializer_list<std::uint8_t> participants) {
  TopicTable table;
  for (const std::uint8_t number : participants)
    table.add_writer({number, 1}, {kScan, kScanTypeName, {}, participant(number)});
  return table;
}

TEST(TopicSources, HearTheFirstAndNotTheSecondWhileTheFirstSpeaks) {
  TopicSources sources(kSilentAfterS);
  const TopicTable table = network_of({1, 2});
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(sources.hears(kScan, participant(1), from_seconds(i * 0.1), table));
    EXPECT_FALSE(sources.hears(kScan, participant(2), from_seconds(i * 0.1 + 0.05), table));
  }
}

TEST(TopicSources, HearTheSecondOnceTheFirstIsSilentAndThenNoMoreTheFirst) {
  TopicSources sources(kSilentAfterS);
  const TopicTable table = network_of({1, 2});
  EXPECT_TRUE(sources.hears(kScan, participant(1), 0, table));
  EXPECT_FALSE(sources.hears(kScan, participant(2), from_seconds(kSilentAfterS), table)) << "not yet silent";
  EXPECT_TRUE(sources.hears(kScan, participant(2), from_seconds(kSilentAfterS + 0.1), table));
  EXPECT_FALSE(sources.hears(kScan, participant(1), from_seconds(kSilentAfterS + 0.2), table));
}

TEST(TopicSources, HearTheSecondAtOnceWhereTheFirstHasLeftTheNetwork) {
  TopicSources sources(kSilentAfterS);
  EXPECT_TRUE(sources.hears(kScan, participant(1), 0, network_of({1, 2})));
  EXPECT_TRUE(sources.hears(kScan, participant(2), from_seconds(0.1), network_of({2})));
}

TEST(TopicSources, MayDifferFromTopicToTopic) {
  TopicSources sources(kSilentAfterS);
  TopicTable table = network_of({1, 2});
  table.add_writer({2, 2}, {"rt/red/odom", kOdometryTypeName, {}, participant(2)});
  EXPECT_TRUE(sources.hears(kScan, participant(1), 0, table));
  EXPECT_TRUE(sources.hears("rt/red/odom", participant(2), 0, table));
  EXPECT_FALSE(sources.hears(kScan, participant(2), 0, table));
}

TEST(TopicSources, NeverHearTwoWithinTheTimeOfSilenceWhateverTheOrderOfThreeThatStay) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    TopicSources sources(kSilentAfterS);
    const TopicTable table = network_of({1, 2, 3});
    Stamp now = 0, last_of_heard = 0;
    int heard = 0;
    for (int i = 0; i < 300; ++i) {
      now += from_seconds(std::exponential_distribution<>(1.0)(random));
      const int speaker = std::uniform_int_distribution<>(1, 3)(random);
      if (!sources.hears(kScan, participant(static_cast<std::uint8_t>(speaker)), now, table)) continue;
      if (heard != 0 && speaker != heard) {
        EXPECT_GT(to_seconds(now - last_of_heard), kSilentAfterS) << "seed " << seed << ", message " << i;
      }
      heard = speaker;
      last_of_heard = now;
    }
  }
}

}  // namespace
}  // namespace smokemap
