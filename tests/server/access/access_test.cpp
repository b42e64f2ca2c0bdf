#include <gtest/gtest.h>

#include <set>

#include "server/access/origin.hpp"
#include "server/access/pairing.hpp"
#include "server/access/permission.hpp"
#include "server/wire/commands_json.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

struct Door {
  explicit Door(PairingParams params = {}) {
    params.pin = "123456";
    access = std::make_unique<Access>(params, clock, [this](const PairedDevice& device) -> Result<Ok> {
      if (disk_full) return fail(Errc::kIo, "the disk is full");
      saved.push_back(device);
      return Ok{};
    });
  }
  Result<Paired> try_pin(const std::string& pin) { return access->pair({pin, "Anna", Role::kCommander, false}); }
  std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
  bool disk_full = false;
  std::vector<PairedDevice> saved;
  std::unique_ptr<Access> access;
};

TEST(Pairing, GivesATokenThatIsKeptOnlyAsAHash) {
  Door door;
  const auto paired = door.try_pin("123456");
  ASSERT_THAT(paired, test::IsOk());
  EXPECT_EQ(paired->token.size(), 32u);
  ASSERT_EQ(door.saved.size(), 1u);
  EXPECT_EQ(door.saved[0].token_hash.find(paired->token), std::string::npos);
  const auto who = door.access->identify(paired->token);
  ASSERT_TRUE(who);
  EXPECT_EQ(who->name, "Anna");
  EXPECT_EQ(who->role, Role::kCommander);
  EXPECT_FALSE(door.access->identify("not a token"));
  EXPECT_FALSE(door.access->identify(door.saved[0].token_hash));
}

TEST(Pairing, LocksEverybodyOutAfterFiveWrongPins) {
  Door door;
  for (int i = 0; i < 5; ++i) EXPECT_THAT(door.try_pin("000000"), test::Fails(Errc::kForbidden));
  EXPECT_THAT(door.try_pin("123456"), test::Fails(Errc::kConflict)) << "even the right one";
  door.clock->advance(from_seconds(59.9));
  EXPECT_THAT(door.try_pin("123456"), test::Fails(Errc::kConflict));
  door.clock->advance(from_seconds(0.2));
  EXPECT_THAT(door.try_pin("123456"), test::IsOk());
}

TEST(Pairing, ForgetsWrongPinsAfterARightOne) {
  Door door;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 4; ++i) EXPECT_THAT(door.try_pin("000000"), test::Fails(Errc::kForbidden));
    EXPECT_THAT(door.try_pin("123456"), test::IsOk());
  }
}

TEST(Pairing, NeedsNoPinOnlyForTheDemoOnThisMachine) {
  PairingParams demo;
  demo.loopback_without_pin = true;
  EXPECT_THAT(Door(demo).access->pair({std::nullopt, "Anna", Role::kCommander, true}), test::IsOk());
  EXPECT_THAT(Door(demo).access->pair({std::nullopt, "Anna", Role::kCommander, false}), test::Fails(Errc::kForbidden));
  EXPECT_THAT(Door().access->pair({std::nullopt, "Anna", Role::kCommander, true}), test::Fails(Errc::kForbidden));
  EXPECT_THAT(Door(demo).access->pair({"000000", "Anna", Role::kCommander, true}), test::Fails(Errc::kForbidden));
}

TEST(Pairing, RefusesNamesThatCannotBeShown) {
  Door door;
  for (const std::string& name : {std::string(), std::string(41, 'x'), std::string("a\nb")})
    EXPECT_THAT(door.access->pair({"123456", name, Role::kObserver, false}), test::Fails(Errc::kInvalidArgument));
}

TEST(Pairing, PairsNobodyWhomItCannotKeep) {
  Door door;
  door.disk_full = true;
  EXPECT_THAT(door.try_pin("123456"), test::Fails(Errc::kIo));
}

TEST(Pairing, RemembersDevicesAndForgetsRevokedOnes) {
  Door before, after;
  const auto paired = before.try_pin("123456");
  after.access->restore(before.saved[0]);
  EXPECT_TRUE(after.access->identify(paired->token));
  before.saved[0].revoked = true;
  after.access->restore(before.saved[0]);
  EXPECT_FALSE(after.access->identify(paired->token));
}

TEST(Pairing, AfterTwoHundredDevicesNobodyCouldPairEverAgain) {
  PairingParams params;
  params.most_devices = 3;
  Door door(params);
  std::vector<std::string> tokens;
  for (int i = 0; i < 3; ++i) {
    tokens.push_back(door.try_pin("123456")->token);
    door.clock->advance(from_seconds(3600));
  }
  EXPECT_THAT(door.try_pin("123456"), test::Fails(Errc::kTooLarge)) << "all were here today";
  door.clock->advance(from_seconds(22 * 3600));
  ASSERT_TRUE(door.access->identify(tokens[0]));  // the oldest is still in use
  door.disk_full = true;
  EXPECT_THAT(door.try_pin("123456"), test::Fails(Errc::kIo));
  EXPECT_TRUE(door.access->identify(tokens[2])) << "nobody is forgotten for one who was not kept";
  door.disk_full = false;
  EXPECT_THAT(door.try_pin("123456"), test::IsOk());
  EXPECT_TRUE(door.access->identify(tokens[0]));
  EXPECT_FALSE(door.access->identify(tokens[1])) << "it was away longest";
  EXPECT_TRUE(door.access->identify(tokens[2]));
  EXPECT_TRUE(door.saved[door.saved.size() - 2].revoked) << "also after a restart";
}

TEST(Secrets, AreNotTheSameTwice) {
  std::set<std::string> seen;
  for (int i = 0; i < 200; ++i) {
    const std::string pin = random_pin();
    EXPECT_EQ(pin.size(), 6u);
    EXPECT_EQ(pin.find_first_not_of("0123456789"), std::string::npos);
    EXPECT_TRUE(seen.insert(random_hex(16)).second);
  }
}

/// One command of every kind, and the engaged and released stop.
std::vector<Command> every_command() {
  return {SetLayout{},
          SetStart{},
          AddAnchor{},
          RemoveAnchor{},
          JudgeWall{},
          MeasureWall{},
          PinCorner{},
          AddStroke{},
          EraseStroke{},
          ClearSketch{},
          SetSketchSheet{},
          JudgePair{},
          PlacePoi{},
          RemovePoi{},
          SetGoal{},
          CancelGoal{},
          EmergencyStop{"", true},
          EmergencyStop{"", false},
          SetExploring{}};
}

TEST(Permission, IsWhatTheProtocolSaysForEveryCommandAndRole) {
  const std::set<std::string> of_firefighters{"add_stroke", "erase_stroke", "clear_sketch", "set_sketch_sheet",
                                              "judge_pair", "place_poi",    "remove_poi"};
  std::set<std::string> seen;
  for (const Command& command : every_command()) {
    const std::string name = command_name(command);
    seen.insert(name);
    const auto* stop = std::get_if<EmergencyStop>(&command);
    const bool engage = stop && stop->engaged;
    EXPECT_EQ(may(Role::kObserver, command).ok(), engage) << name;
    EXPECT_EQ(may(Role::kFirefighter, command).ok(), engage || of_firefighters.contains(name)) << name;
    EXPECT_TRUE(may(Role::kCommander, command).ok()) << name;
  }
  EXPECT_EQ(seen.size(), command_names().size()) << "a command is missing here";
  EXPECT_EQ(may(Role::kFirefighter, SetGoal{}).error().message, "the role firefighter may not set_goal");
}

TEST(Host, MustBeOneTheServerAnswersFor) {
  const OriginPolicy policy({"map.example"});
  EXPECT_TRUE(policy.host_is_ours("127.0.0.1:8080", "127.0.0.1", 8080));
  EXPECT_TRUE(policy.host_is_ours("LOCALHOST:8080", "127.0.0.1", 8080));
  EXPECT_TRUE(policy.host_is_ours("[::1]:8080", "::1", 8080));
  EXPECT_TRUE(policy.host_is_ours("192.168.1.5:8080", "192.168.1.5", 8080));
  EXPECT_TRUE(policy.host_is_ours("192.168.1.5:8080", "::ffff:192.168.1.5", 8080));
  EXPECT_TRUE(policy.host_is_ours("map.example:8080", "192.168.1.5", 8080));
  for (const char* host : {"", "localhost:8081", "evil.example:8080", "localhost.evil.example:8080",
                           "127.0.0.1:8080.evil", "map.example.evil:8080", "localhost"})
    EXPECT_FALSE(policy.host_is_ours(host, "127.0.0.1", 8080)) << host;
  EXPECT_FALSE(policy.host_is_ours("localhost:8080", "192.168.1.5", 8080)) << "a name of this machine, from another";
}

TEST(Origin, MustBeThePagesOwn) {
  EXPECT_TRUE(OriginPolicy::origin_is_ours("", "localhost:80")) << "not a browser's cross-site request";
  EXPECT_TRUE(OriginPolicy::origin_is_ours("http://localhost:8080", "localhost:8080"));
  for (const char* origin : {"null", "http://localhost", "http://localhost:8081", "http://evil.example",
                             "http://localhost:8080.evil.example", "http://localhost:8080/"})
    EXPECT_FALSE(OriginPolicy::origin_is_ours(origin, "localhost:8080")) << origin;
}

TEST(Pairing, ANameInAnotherAlphabetWasTooLongAtTwentyLetters) {
  Door door;
  const auto pair_as = [&](const std::string& name) {
    return door.access->pair({"123456", name, Role::kObserver, false});
  };
  std::string forty, forty_one;
  for (int i = 0; i < 40; ++i) forty += "\xd0\x90";
  forty_one = forty + "\xd0\x90";
  EXPECT_THAT(pair_as(forty), test::IsOk()) << "40 letters, 80 bytes";
  EXPECT_THAT(pair_as(forty_one), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(pair_as(std::string(40, 'a')), test::IsOk());
  EXPECT_THAT(pair_as(std::string(41, 'a')), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(pair_as(std::string(161, '\x80')), test::Fails(Errc::kInvalidArgument)) << "bytes that are no letters";
  for (const char* odd : {"", "a\nb", "\x7f", "a\tb"})
    EXPECT_THAT(pair_as(odd), test::Fails(Errc::kInvalidArgument)) << odd;
}

TEST(Hosts, OfAConnectionOverIpv6AreWrittenInBrackets) {
  const OriginPolicy policy({"Smoke.example", "proxy.example:8443"});
  EXPECT_TRUE(policy.host_is_ours("[fe80::1]:8080", "fe80::1", 8080));
  EXPECT_FALSE(policy.host_is_ours("fe80::1:8080", "fe80::1", 8080));
  EXPECT_FALSE(policy.host_is_ours("localhost:8080", "fe80::1", 8080)) << "loopback names only on loopback";
  EXPECT_TRUE(policy.host_is_ours("10.0.0.7:8080", "::ffff:10.0.0.7", 8080)) << "IPv4 inside of IPv6";
  EXPECT_TRUE(policy.host_is_ours("localhost:8080", "::ffff:127.0.0.1", 8080));
  for (const char* ours : {"smoke.EXAMPLE", "smoke.example:8080", "proxy.example:8443"})
    EXPECT_TRUE(policy.host_is_ours(ours, "10.0.0.7", 8080)) << ours;
  for (const char* foreign : {"smoke.example:81", "proxy.example", "a.smoke.example", "smoke.example.", ""})
    EXPECT_FALSE(policy.host_is_ours(foreign, "10.0.0.7", 8080)) << foreign;
}

}  // namespace
}  // namespace smokemap::server
