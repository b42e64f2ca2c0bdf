#include "recording/live_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <future>
#include <iterator>
#include <sstream>

#include "recording/mcap_reader.hpp"
#include "recording/ros_log_builder.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap {
namespace {

LaserScan recorded_scan(int number, const std::string& robot = "fox") {
  LaserScan scan;
  scan.stamp = number;
  scan.robot = robot;
  scan.angle_increment_rad = 0.01;
  scan.range_max_m = 10;
  for (int i = 0; i < 300; ++i) scan.ranges_m.push_back(1.f + static_cast<float>((i * 7919 + number) % 1000) * 0.005f);
  return scan;
}

Result<SensorLog> read_text(const std::string& bytes) {
  RosLogBuilder builder;
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (auto read = read_mcap({first, bytes.size()}, builder); !read) return read.error();
  return std::move(builder).finish("mcap");
}

/// A disk that is full after so many bytes; what it took can be looked at.
class SmallDisk final : public std::streambuf {
 public:
  SmallDisk(std::size_t size, std::string& taken) : left_(size), taken_(taken) {}

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    const auto fits = std::min(static_cast<std::streamsize>(left_), count);
    taken_.append(bytes, static_cast<std::size_t>(fits));
    left_ -= static_cast<std::size_t>(fits);
    return fits;
  }
  int overflow(int) override { return traits_type::eof(); }

 private:
  std::size_t left_;
  std::string& taken_;
};
class SmallDiskStream final : public std::ostream {
 public:
  SmallDiskStream(std::size_t size, std::string& taken) : std::ostream(nullptr), disk_(size, taken) { rdbuf(&disk_); }

 private:
  SmallDisk disk_;
};

/// A disk that takes the head of a file and then nothing until it is let go.
class StuckDisk final : public std::streambuf {
 public:
  explicit StuckDisk(std::shared_future<void> open) : open_(std::move(open)) {}

 protected:
  std::streamsize xsputn(const char*, std::streamsize count) override {
    taken_ += count;
    if (taken_ > 64) open_.wait();
    return count;
  }

 private:
  std::streamsize taken_ = 0;
  std::shared_future<void> open_;
};
class StuckDiskStream final : public std::ostream {
 public:
  explicit StuckDiskStream(std::shared_future<void> open) : std::ostream(nullptr), disk_(std::move(open)) {
    rdbuf(&disk_);
  }

 private:
  StuckDisk disk_;
};

TEST(LiveRecorder, GivesBackWhatRobotsSentAndKeepsWhatPeopleDid) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/mission.mcap";
  const auto recorder = LiveRecorder::start(path, {}, nullptr);
  ASSERT_THAT(recorder, test::IsOk());
  for (int i = 0; i < 50; ++i) {
    (*recorder)->add(recorded_scan(i), 1000 + i);
    (*recorder)->add(Odometry{i, "fox", Pose2(0.1 * i, 0, 0), 0.5, 0}, 1000 + i);
  }
  (*recorder)->add_goal("fox", Pose2(1, 2, 0.5), 1100);
  (*recorder)->add_event(R"({"command":"set_goal"})", 1101);
  ASSERT_THAT((*recorder)->finish(), test::IsOk());
  EXPECT_EQ((*recorder)->counts().written, 102u);
  EXPECT_EQ((*recorder)->counts().left_out, 0u);
  const auto log = read_log(path);
  ASSERT_THAT(log, test::IsOk());
  EXPECT_TRUE(log->warnings.empty());
  EXPECT_EQ(log->scans(), 50u);
  EXPECT_EQ(log->odometry_readings(), 50u);
  EXPECT_EQ(std::get<LaserScan>(log->items[0]).ranges_m, recorded_scan(0).ranges_m);
  EXPECT_EQ(log->dropped.at("type not used: geometry_msgs/msg/PoseStamped"), 1u);
  EXPECT_EQ(log->dropped.at("type not used: std_msgs/msg/String"), 1u);
}

TEST(LiveRecorder, NeverWritesOverAnEarlierMission) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/mission.mcap";
  ASSERT_THAT((*LiveRecorder::start(path, {}, nullptr))->finish(), test::IsOk());
  EXPECT_THAT(LiveRecorder::start(path, {}, nullptr), test::Fails(Errc::kConflict));
  EXPECT_THAT(LiveRecorder::start(folder.path() + "/none/mission.mcap", {}, nullptr), test::Fails(Errc::kIo));
}

TEST(LiveRecorder, TellsOnceThatTheDiskIsFullAndKeepsWhatFitted) {
  std::string taken;
  test::Mailbox<std::string> told;
  LiveRecorderParams params;
  params.flush_s = 0.01;
  const auto recorder = LiveRecorder::start(std::make_unique<SmallDiskStream>(30'000, taken), params,
                                            [&told](const std::string& text) { told.put(text); });
  ASSERT_THAT(recorder, test::IsOk());
  int added = 0;
  ASSERT_TRUE(test::eventually([&] {
    (*recorder)->add(recorded_scan(added), added);
    ++added;
    return (*recorder)->counts().ended_early;
  }));
  ASSERT_TRUE(told.wait_for(1));
  for (int i = 0; i < 10; ++i, ++added) (*recorder)->add(recorded_scan(added), added);
  EXPECT_THAT((*recorder)->finish(), test::Fails(Errc::kIo));
  EXPECT_EQ(told.size(), 1u);
  EXPECT_THAT(told.all()[0], testing::HasSubstr("disk"));
  const auto counts = (*recorder)->counts();
  EXPECT_EQ(counts.written + counts.left_out, static_cast<std::size_t>(added));
  EXPECT_GE(counts.left_out, 10u);
  const auto log = read_text(taken);
  ASSERT_THAT(log, test::IsOk());
  EXPECT_GT(log->scans(), 0u) << "what fitted can be read";
}

TEST(LiveRecorder, MakesNobodyWaitForASlowDisk) {
  std::promise<void> open;
  LiveRecorderParams params;
  params.most_waiting = 100;
  params.flush_s = 0.01;
  const auto recorder =
      LiveRecorder::start(std::make_unique<StuckDiskStream>(open.get_future().share()), params, nullptr);
  ASSERT_THAT(recorder, test::IsOk());
  // Comes back each time although nothing is written; a recorder that waited would stand here for ever.
  ASSERT_TRUE(test::eventually([&] {
    (*recorder)->add(recorded_scan(1), 1);
    return (*recorder)->counts().left_out >= 50;
  }));
  open.set_value();
  EXPECT_THAT((*recorder)->finish(), test::IsOk());
}

TEST(LiveRecorder, LosesOnlySecondsWhenTheProcessDies) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/mission.mcap";
  LiveRecorderParams params;
  params.flush_s = 0.01;
  const auto recorder = LiveRecorder::start(path, params, nullptr);
  ASSERT_THAT(recorder, test::IsOk());
  for (int i = 0; i < 20; ++i) (*recorder)->add(recorded_scan(i), i);
  EXPECT_TRUE(test::eventually([&] {  // the file as a process that is killed now leaves it
    std::ifstream file(path, std::ios::binary);
    const auto log = read_text({std::istreambuf_iterator<char>(file), {}});
    return log.ok() && log->scans() == 20;
  }));
}

TEST(LiveRecorderParams, NameWhatIsOutOfRange) {
  LiveRecorderParams params;
  params.flush_s = 0;
  EXPECT_THAT(LiveRecorder::start(std::make_unique<std::ostringstream>(), params, nullptr),
              test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
