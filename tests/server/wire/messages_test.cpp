#include "server/wire/messages.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/random.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

template <typename T>
T parsed(const Json& json) {
  const auto message = parse_client_message(to_text(json));
  EXPECT_THAT(message, test::IsOk()) << json;
  return message ? std::get<T>(*message) : T{};
}

TEST(Hello, SaysWhoComesAndWhatIsStillKnownThere) {
  const auto hello = parsed<HelloMessage>({{"type", "hello"},
                                           {"version", 1},
                                           {"token", "abc"},
                                           {"epoch", 4'000'000'000u},
                                           {"seq", 9'000'000'000'000'000.0 - 2},
                                           {"view", {{"x", 1.5}, {"y", -2}, {"radius", 20}}},
                                           {"parts", {{"walls", 7}, {"robots", 3.9}, {"of_tomorrow", 1}}}});
  EXPECT_EQ(hello.token, "abc");
  EXPECT_EQ(hello.epoch, 4'000'000'000u);
  EXPECT_EQ(hello.seq, 8'999'999'999'999'998u);
  ASSERT_TRUE(hello.view);
  EXPECT_EQ(hello.view->p_map, Point2(1.5, -2));
  EXPECT_EQ(hello.parts, (std::map<Part, std::uint64_t>{{Part::kWalls, 7}, {Part::kRobots, 3}}));
}

TEST(Hello, IsTakenWithoutAViewOrWithABrokenOne) {
  const Json plain{{"type", "hello"}, {"version", 1}, {"token", "t"}};
  EXPECT_FALSE(parsed<HelloMessage>(plain).view);
  for (const Json& view : {Json("x"), Json::object(), Json{{"x", 1}, {"y", "two"}, {"radius", 3}}}) {
    Json broken = plain;
    broken["view"] = view;
    EXPECT_FALSE(parsed<HelloMessage>(broken).view) << view;
  }
  Json old = plain;
  old["version"] = 2;
  EXPECT_THAT(parse_client_message(to_text(old)), test::Fails(Errc::kInvalidArgument));
  old["version"] = "1";
  EXPECT_THAT(parse_client_message(to_text(old)), test::Fails(Errc::kInvalidArgument));
  Json long_token = plain;
  long_token["token"] = std::string(65, 'x');
  EXPECT_THAT(parse_client_message(to_text(long_token)), test::Fails(Errc::kInvalidArgument));
}

TEST(CommandMessages, NeedAnIdANameAndAnObject) {
  const Json whole{{"id", "c1"}, {"name", "place_poi"}, {"data", Json::object()}, {"expires_ms", 1.7e12}};
  const auto command = parse_command_message(to_text(whole), {});
  ASSERT_THAT(command, test::IsOk());
  EXPECT_EQ(command->id, "c1");
  EXPECT_EQ(command->expires_ms, 1'700'000'000'000);
  for (const char* field : {"id", "name", "data"}) {
    Json without = whole;
    without.erase(field);
    EXPECT_THAT(parse_command_message(to_text(without), {}), test::Fails(Errc::kInvalidArgument)) << field;
  }
  for (const char* id : {"", " ", "a b", "tab\there", "\x7f"}) {
    Json bad = whole;
    bad["id"] = id;
    EXPECT_THAT(parse_command_message(to_text(bad), {}), test::Fails(Errc::kInvalidArgument)) << id;
  }
  Json never = whole;
  never["expires_ms"] = "soon";
  EXPECT_THAT(parse_command_message(to_text(never), {}), test::Fails(Errc::kInvalidArgument));
  never["expires_ms"] = 1e300;
  EXPECT_EQ(parse_command_message(to_text(never), {})->expires_ms, 0) << "no time at all has passed already";
  EXPECT_THAT(parse_command_message(std::string(100, ' '), {50, 4}), test::Fails(Errc::kTooLarge));
}

TEST(SmallMessages, CarryWhatTheySay) {
  EXPECT_EQ(parsed<AckMessage>({{"type", "ack"}, {"seq", 12}}).seq, 12u);
  EXPECT_EQ(parsed<AckMessage>({{"type", "ack"}}).seq, 0u);
  EXPECT_EQ(parsed<PingMessage>({{"type", "ping"}, {"t", 12.5}}).t, 12.5);
  const auto here = parsed<PresenceMessage>({{"type", "presence"}, {"mode", "sketch"}, {"p", {1, 2}}});
  EXPECT_EQ(here.mode, "sketch");
  EXPECT_EQ(here.p_map, Point2(1, 2));
  EXPECT_FALSE(parsed<PresenceMessage>({{"type", "presence"}, {"mode", "sketch"}, {"p", nullptr}}).p_map);
  EXPECT_EQ(parsed<InkMessage>({{"type", "ink"}, {"stroke_id", "s"}, {"points", {{1, 2}, {3, 4}}}}).points.size(), 2u);
  EXPECT_EQ(parsed<ViewMessage>({{"type", "view"}, {"x", 1}, {"y", 2}, {"radius", 3}}).radius_m, 3);
  for (const Json& bad : {Json{{"type", "presence"}}, Json{{"type", "presence"}, {"mode", "x"}, {"p", {1}}},
                          Json{{"type", "ink"}, {"stroke_id", "s"}}, Json{{"type", "ping"}, {"t", "now"}},
                          Json{{"type", "view"}, {"x", 1}, {"y", 2}, {"radius", -3}}})
    EXPECT_THAT(parse_client_message(to_text(bad)), test::Fails(Errc::kInvalidArgument)) << bad;
}

TEST(Answers, SayDoneOrWhyNot) {
  const Json done = Json::parse(reply_message({"c1", 9, "", ""}));
  EXPECT_EQ(done, (Json{{"type", "done"}, {"id", "c1"}, {"seq", 9}}));
  const Json refused = Json::parse(reply_message({"c1", std::nullopt, "forbidden", "no"}));
  EXPECT_FALSE(refused.contains("seq")) << "nothing was stored";
  EXPECT_EQ(Json::parse(reply_message({"c1", 4, "conflict", "no"}))["seq"], 4);
  EXPECT_EQ(Json::parse(pong_message(1.5, 7))["server_ms"], 7);
  EXPECT_EQ(Json::parse(bye_message("it \"stops\""))["reason"], "it \"stops\"");
}

/// Bytes changed at random in messages that are right: nothing throws, and what is taken is whole.
TEST(ClientMessages, SurviveEveryDamage) {
  std::mt19937_64 random(3);
  const std::vector<std::string> good{
      R"({"type":"hello","version":1,"token":"abc","epoch":1,"seq":2,"parts":{"walls":3}})",
      R"({"type":"command","id":"c","name":"place_poi","data":{"p":[1,2]},"expires_ms":5})",
      R"({"type":"ink","stroke_id":"s","points":[[1,2],[3,4]]})", R"({"type":"view","x":1,"y":2,"radius":3})"};
  int taken = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = good[uniform_index(random, good.size())];
    for (std::uint64_t n = 1 + uniform_index(random, 3); n > 0; --n)
      text[uniform_index(random, text.size())] = static_cast<char>(uniform_index(random, 256));
    if (i % 5 == 0) text.resize(uniform_index(random, text.size()));
    const auto message = parse_client_message(text);
    taken += message.ok();
    if (!message) {
      EXPECT_FALSE(message.error().message.empty());
    }
  }
  EXPECT_GT(taken, 20) << "damage inside of texts and numbers leaves some whole";
}

std::vector<std::string> messages_of_browsers() {
  std::vector<std::string> texts;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/examples"))
    if (entry.path().filename().string().starts_with("client_")) texts.push_back(test::read_json(entry.path()).dump());
  EXPECT_GT(texts.size(), 20u);
  return texts;
}

TEST(EveryMessageOfTheBrowser, IsRefusedWhenCutShortAnywhere) {
  for (const std::string& text : messages_of_browsers()) {
    ASSERT_THAT(parse_client_message(text), test::IsOk()) << text;
    for (std::size_t size = 0; size < text.size(); ++size)
      ASSERT_THAT(parse_client_message(std::string_view(text).substr(0, size)), test::Fails(Errc::kCorrupt)) << text;
  }
}

/// Any field of any message turned into anything else: taken or refused with a reason, nothing in between.
TEST(EveryMessageOfTheBrowser, AnswersForFieldsOfEveryOtherKind) {
  const std::vector<Json> odd{nullptr,
                              true,
                              -1,
                              0.5,
                              1e308,
                              "",
                              std::string(100, 'x'),
                              Json::array(),
                              Json::object(),
                              Json::array({1, 2}),
                              Json{{"x", 1}}};
  for (const std::string& text : messages_of_browsers()) {
    const Json whole = Json::parse(text);
    for (const auto& [field, value] : whole.items())
      for (const Json& other : odd) {
        Json changed = whole;
        changed[field] = other;
        const auto message = parse_client_message(changed.dump());
        if (message) continue;
        EXPECT_TRUE(message.error().code == Errc::kInvalidArgument || message.error().code == Errc::kNotFound)
            << changed;
        EXPECT_LT(message.error().message.size(), 200u);
      }
  }
}

TEST(EveryTextOfAMessage, IsTakenAtItsLimitAndRefusedBeyond) {
  const auto taken = [](Json message, const char* field, std::size_t bytes) {
    message[field] = std::string(bytes, 'x');
    return parse_client_message(to_text(message)).ok();
  };
  const Json hello{{"type", "hello"}, {"version", 1}}, presence{{"type", "presence"}};
  const Json command{{"type", "command"}, {"id", "c"}, {"name", "n"}, {"data", Json::object()}};
  EXPECT_TRUE(taken(hello, "token", 64) && !taken(hello, "token", 65));
  EXPECT_TRUE(taken(presence, "mode", 32) && !taken(presence, "mode", 33));
  EXPECT_TRUE(taken(command, "id", 64) && !taken(command, "id", 65));
  EXPECT_TRUE(taken(command, "name", 64) && !taken(command, "name", 65));
  Json ink{{"type", "ink"}, {"stroke_id", "s"}, {"points", Json::array()}};
  for (int i = 0; i < 2000; ++i) ink["points"].push_back({i, i});
  EXPECT_THAT(parse_client_message(to_text(ink)), test::IsOk());
  ink["points"].push_back({0, 0});
  EXPECT_THAT(parse_client_message(to_text(ink)), test::Fails(Errc::kInvalidArgument));
  std::string large = R"({"type":"ack","seq":1)";
  large += std::string(256 * 1024 - large.size() - 1, ' ') + "}";
  EXPECT_THAT(parse_client_message(large), test::IsOk());
  EXPECT_THAT(parse_client_message(large + " "), test::Fails(Errc::kTooLarge));
}

TEST(Counters, AreWholeNumbersThatABrowserCanHold) {
  const auto seq = [](const std::string& number) {
    const auto message = parse_client_message(R"({"type":"ack","seq":)" + number + "}");
    return message ? std::get<AckMessage>(*message).seq : 77u;
  };
  EXPECT_EQ(seq("8999999999999999"), 8999999999999999u);
  EXPECT_EQ(seq("2.9"), 2u);
  for (const char* number : {"-1", "0", "9000000000000000", "18446744073709551615", "18446744073709551616", "1e300",
                             "-9223372036854775808", "\"5\"", "null", "[5]", "true"})
    EXPECT_EQ(seq(number), 0u) << number;
}

TEST(MessagesOfTheServer, HoldAnyTextThatPeopleGaveThemselves) {
  const std::string name = "Zo\xc3\xab \"Blaze\" \\ \x01\xff";
  const Identity who{"d1", name, Role::kObserver};
  for (const std::string& text :
       {welcome_message({who, 1, 2, 3, 0.05}), ink_message(who, {"s", {Point2(1e308, 0.12345)}}),
        reply_message({name, std::nullopt, "invalid_argument", name}), bye_message(name)}) {
    const Json message = Json::parse(text, nullptr, false);
    ASSERT_FALSE(message.is_discarded()) << text;
    EXPECT_FALSE(message["type"].get<std::string>().empty());
  }
  const Json ink = Json::parse(ink_message(who, {"s", {Point2(0.123456, -0.004)}}));
  EXPECT_EQ(ink["points"], (Json::array({Json::array({0.12, 0.0})}))) << "in hundredths of a pixel";
  EXPECT_EQ(Json::parse(welcome_message({who, 4'294'967'295u, 8'999'999'999'999'999u, 3, 0.05}))["seq"],
            8'999'999'999'999'999u);
}

}  // namespace
}  // namespace smokemap::server
