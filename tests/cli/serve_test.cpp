// The server as a program: started, reached, stopped, killed and started again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "recording/sensor_log.hpp"
#include "tests/cli/smokemap_program.hpp"
#include "tests/support/raw_client.hpp"
#include "tests/support/ros_domain.hpp"

namespace smokemap::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// `smokemap serve` on a free port, in a folder that outlives it.
class Serving {
 public:
  explicit Serving(const SmokemapFolder& here, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{
        "serve", "--port", "0", "--web", "", "--data", "data", "--ros-domain", std::to_string(ros_domain())};
    arguments.insert(arguments.end(), more.begin(), more.end());
    process = std::make_unique<Process>(SMOKEMAP_PROGRAM, arguments, here.path("."));
    EXPECT_TRUE(process->says("PIN to pair a device: ")) << process->errors();
    EXPECT_TRUE(process->says("\n", "PIN to pair a device: "));
    const std::string& said = process->output();
    port = static_cast<std::uint16_t>(std::atoi(after("http://127.0.0.1:", said).c_str()));
    pin = after("PIN to pair a device: ", said).substr(0, 6);
  }
  std::string pair(const std::string& role) const {
    RawClient client(port);
    const auto answer = client.ask("POST", "/api/pair", json{{"pin", pin}, {"name", "Anna"}, {"role", role}}.dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return "Authorization: Bearer " + json::parse(answer.body, nullptr, false).value("token", "") + "\r\n";
  }
  HttpAnswer place_poi(const std::string& token, int number) const {
    RawClient client(port);
    return client.ask(
        "POST", "/api/commands",
        json{{"id", "c" + std::to_string(number)},
             {"name", "place_poi"},
             {"data",
              {{"poi_id", "p" + std::to_string(number)}, {"kind", "fire"}, {"frame", "map"}, {"p", {1, number}}}}}
            .dump(),
        token);
  }
  std::unique_ptr<Process> process;
  std::uint16_t port = 0;
  std::string pin;

 private:
  static std::string after(const std::string& word, const std::string& text) {
    const std::size_t at = text.find(word);
    return at == std::string::npos ? "" : text.substr(at + word.size());
  }
};

TEST(Serve, SaysWhereItIsAnswersThereAndEndsWhenAsked) {
  const SmokemapFolder here;
  Serving serving(here);
  EXPECT_EQ(serving.pin.find_first_not_of("0123456789"), std::string::npos);
  RawClient client(serving.port);
  const auto health = client.ask("GET", "/api/health");
  EXPECT_EQ(health.status, 200);
  EXPECT_EQ(json::parse(health.body)["ok"], true);
  serving.process->send(SIGTERM);
  EXPECT_EQ(serving.process->wait(), 0) << serving.process->errors();
}

TEST(Serve, KeepsWhatItAcknowledgedThroughKillNine) {
  const SmokemapFolder here;
  std::string token;
  {
    Serving first(here);
    token = first.pair("commander");
    for (int i = 1; i <= 5; ++i) ASSERT_EQ(first.place_poi(token, i).status, 200);
    first.process->send(SIGKILL);
    EXPECT_EQ(first.process->wait(), 128 + SIGKILL);
  }
  Serving second(here);
  RawClient client(second.port);
  const auto events = client.ask("GET", "/api/events", "", token);
  ASSERT_EQ(events.status, 200) << "the device is still paired";
  EXPECT_EQ(json::parse(events.body)["events"].size(), 5u);
  EXPECT_EQ(json::parse(second.place_poi(token, 3).body)["seq"], 3) << "the same command again is not a new one";
}

TEST(Serve, RefusesWhatAnotherServerHolds) {
  const SmokemapFolder here;
  const Serving first(here);
  const Ran same_data = here.run({"serve", "--port", "0", "--web", "", "--data", "data"});
  EXPECT_EQ(same_data.status, 1);
  EXPECT_THAT(same_data.errors, HasSubstr("in use by another process"));
  const Ran same_port = here.run({"serve", "--port", std::to_string(first.port), "--web", "", "--data", "other"});
  EXPECT_EQ(same_port.status, 1);
  EXPECT_THAT(same_port.errors, HasSubstr("cannot listen on 127.0.0.1:" + std::to_string(first.port)));
}

TEST(Serve, RecordsTwoRobotsOfTheDemoSoThatSlamReplaysThem) {
  const SmokemapFolder here;
  {
    Serving serving(here, {"--demo", "--robots", "2", "--record", "mission.mcap"});
    const std::string token = serving.pair("commander");
    ASSERT_EQ(serving.place_poi(token, 1).status, 200);
    ASSERT_TRUE(eventually([&] {  // both robots reach the recording
      const auto log = read_log(here.path("mission.mcap"));
      if (!log) return false;
      bool first = false, second = false;
      for (const LogItem& item : log->items)
        if (const auto* scan = std::get_if<LaserScan>(&item))
          first = first || scan->robot == "robot1", second = second || scan->robot == "robot2";
      return first && second;
    }));
    serving.process->send(SIGINT);
    ASSERT_EQ(serving.process->wait(), 0) << serving.process->errors();
  }
  const Ran slam = here.run({"slam", "mission.mcap", "-o", "poses.tum"});
  EXPECT_EQ(slam.status, 0) << slam.errors;
  EXPECT_GT(lines_of(here.text("poses.tum")), 10u);
  const Ran again = here.run({"serve", "--port", "0", "--web", "", "--data", "data", "--record", "mission.mcap"});
  EXPECT_EQ(again.status, 1) << "an earlier recording is not written over";
  EXPECT_THAT(again.errors, HasSubstr("mission.mcap exists already"));
}

}  // namespace
}  // namespace smokemap::test
