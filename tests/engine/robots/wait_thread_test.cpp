#include "robots/wait_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <type_traits>
#include <utility>

#include "robots/dds_domain.hpp"
#include "robots/ros_convert.hpp"
#include "robots/ros_qos.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/ros_domain.hpp"

namespace smokemap {
namespace {

/// A topic with a writer and a reader in one participant.
struct Loop {
  Loop() : domain(*DdsDomain::open(test::ros_domain())), participant(*domain->participant()) {
    topic = DdsEntity(
        dds_create_topic(participant.get(), &geometry_msgs_msg_dds__Twist__desc, "rt/loop", nullptr, nullptr));
    reader = DdsEntity(dds_create_reader(participant.get(), topic.get(), state_qos(100).get(), nullptr));
    writer = DdsEntity(dds_create_writer(participant.get(), topic.get(), state_qos(100).get(), nullptr));
  }
  std::shared_ptr<DdsDomain> domain;
  DdsEntity participant, topic, reader, writer;
};

TEST(WaitThread, CallsForEveryArrivalAndTicksBesides) {
  Loop loop;
  std::atomic<int> taken = 0, ticks = 0;
  WaitThread thread(loop.participant.get(), 0.005, [&] { ++ticks; });
  thread.on_data(loop.reader.get(), [&] {
    take_all<RosTwistMsg>(loop.reader.get(), [&](const RosTwistMsg&, const dds_sample_info_t&) { ++taken; });
  });
  thread.start();
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(write_twist(loop.writer.get(), i, 0));
  EXPECT_TRUE(test::eventually([&] { return taken == 20 && ticks > 2; }));
  thread.stop();
  const int after = ticks;
  EXPECT_TRUE(write_twist(loop.writer.get(), 1, 0));
  EXPECT_EQ(ticks, after) << "nothing runs after stop";
  EXPECT_EQ(taken, 20);
}

TEST(WaitThread, TicksAlsoWhileDataNeverEnd) {
  Loop loop;
  std::atomic<int> ticks = 0;
  WaitThread thread(loop.participant.get(), 0.005, [&] { ++ticks; });
  thread.on_data(loop.reader.get(), [&] {  // takes one and puts another: there is always data
    take_all<RosTwistMsg>(loop.reader.get(), [](const RosTwistMsg&, const dds_sample_info_t&) {});
    write_twist(loop.writer.get(), 1, 0);
  });
  EXPECT_TRUE(write_twist(loop.writer.get(), 1, 0));
  thread.start();
  EXPECT_TRUE(test::eventually([&] { return ticks > 10; }));
  thread.stop();
}

TEST(WaitThread, LetsAHandlerForgetItself) {
  Loop loop;
  std::atomic<int> calls = 0;
  WaitThread thread(loop.participant.get(), 0.005, [] {});
  thread.on_data(loop.reader.get(), [&] {
    ++calls;
    thread.forget(loop.reader.get());
  });
  thread.start();
  EXPECT_TRUE(write_twist(loop.writer.get(), 1, 0));
  ASSERT_TRUE(test::eventually([&] { return calls == 1; }));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(write_twist(loop.writer.get(), 1, 0));
  thread.stop();
  EXPECT_EQ(calls, 1);
}

TEST(WaitThread, StopsWithoutEverHavingStarted) {
  Loop loop;
  WaitThread thread(loop.participant.get(), 1, [] {});
  thread.stop();
  thread.stop();
}

TEST(DdsDomain, IsOneForAllThatOpenIt) {
  const auto one = DdsDomain::open(test::ros_domain()), other = DdsDomain::open(test::ros_domain());
  ASSERT_THAT(one, test::IsOk());
  EXPECT_EQ(*one, *other);
  EXPECT_THAT(DdsDomain::open(-1), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(DdsDomain::open(231), test::Fails(Errc::kInvalidArgument));
}

TEST(DdsEntities, AreMovedAndNeverCopied) {
  static_assert(!std::is_copy_constructible_v<DdsEntity>);
  Loop loop;
  const dds_entity_t handle = loop.writer.get();
  DdsEntity moved(std::move(loop.writer));
  EXPECT_EQ(moved.get(), handle);
  EXPECT_FALSE(static_cast<bool>(loop.writer));
  moved = DdsEntity();
  dds_guid_t guid;
  EXPECT_NE(dds_get_guid(handle, &guid), DDS_RETCODE_OK) << "deleted when it was given up";
}

TEST(OfferedQos, IsWhatTheWriterSaid) {
  EXPECT_FALSE(offered(nullptr).reliable);
  EXPECT_FALSE(offered(sensor_qos().get()).reliable);
  EXPECT_TRUE(offered(state_qos(1).get()).reliable);
  EXPECT_FALSE(offered(state_qos(1).get()).transient_local);
  EXPECT_TRUE(offered(latched_qos(1).get()).transient_local);
  for (const bool reliable : {false, true})
    for (const bool latched : {false, true}) {
      const OfferedQos fitted = offered(reader_qos_for({reliable, latched}, 3).get());
      EXPECT_LE(fitted.reliable, reliable) << "a reader never asks for more than is offered";
      EXPECT_LE(fitted.transient_local, latched);
    }
  EXPECT_STREQ(policy_name(DDS_RELIABILITY_QOS_POLICY_ID), "reliability");
  EXPECT_STREQ(policy_name(9999), "quality of service");
}

}  // namespace
}  // namespace smokemap
