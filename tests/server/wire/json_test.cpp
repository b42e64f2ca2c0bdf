#include "server/wire/json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "server/wire/messages.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

TEST(ParseJson, RefusesWhatIsTooLargeTooDeepOrNoJsonWithoutThrowing) {
  EXPECT_THAT(parse_json("{\"a\":1}"), test::IsOk());
  EXPECT_THAT(parse_json(std::string(100, ' '), {50, 4}), test::Fails(Errc::kTooLarge));
  EXPECT_THAT(parse_json(std::string(100'000, '['), {1'000'000, 16}), test::Fails(Errc::kTooLarge));
  for (const char* text : {"", "{", "nul", "[1,]", "\"\xff\"", "{\"a\":1}x", "\"\\"})
    EXPECT_THAT(parse_json(text), test::Fails(Errc::kCorrupt)) << text;
}

TEST(ParseJson, DoesNotCountBracketsInStrings) { EXPECT_THAT(parse_json("\"[[[[\\\"[[[[\"", {1000, 2}), test::IsOk()); }

TEST(ToText, WritesSomethingForBytesThatAreNotUtf8) {
  EXPECT_NE(to_text(Json("a\xff")).find("\xef\xbf\xbd"), std::string::npos);
}

TEST(Rounded, MakesEveryNumberPrintable) {
  EXPECT_EQ(rounded(1.23456, 0.001), 1.235);
  EXPECT_EQ(rounded(std::numeric_limits<double>::quiet_NaN(), 0.001), 0);
  EXPECT_EQ(rounded(std::numeric_limits<double>::infinity(), 0.001), 0);
  EXPECT_EQ(to_text(Json(rounded(-0.0001, 0.001))), "0.0");
}

TEST(FieldsOfMessages, KeepTheFirstComplaintAndNameTheField) {
  const Json json = {{"x", 1e300}, {"id", "has space"}, {"p", {1, "two"}}, {"flag", 1}, {"list", {1, 2, 3}}};
  const auto complaint = [&json](auto read) {
    Fields f(json, "thing");
    read(f);
    return f.ok() ? std::string() : f.error().message;
  };
  EXPECT_EQ(complaint([](Fields& f) { f.number("x"); }), "thing.x must be a number within [-10000000.0, 10000000.0]");
  EXPECT_EQ(complaint([](Fields& f) { f.id("id"); }), "thing.id must be 1 to 64 printable characters");
  EXPECT_EQ(complaint([](Fields& f) {
              f.point("p");
              f.boolean("flag");
            }),
            "thing.p must be [x, y]");
  EXPECT_EQ(complaint([](Fields& f) { f.array("list", 2); }), "thing.list must be a list of at most 2");
  EXPECT_EQ(complaint([](Fields& f) { f.text("none", 5); }), "thing.none is missing");
  EXPECT_EQ(complaint([](Fields& f) { f.text("none", 5, false); }), "");
}

TEST(ClientMessages, AreRefusedWhenMalformed) {
  for (const char* text :
       {R"([])", R"({"type":1})", R"({"type":"hello","version":1})", R"({"type":"hello","token":"x","version":2})",
        R"({"type":"command","id":"a","name":"x","data":[]})", R"({"type":"ping"})",
        R"({"type":"ink","stroke_id":"s","points":[[1]]})", R"({"type":"view","x":1})"})
    EXPECT_THAT(parse_client_message(text), test::Fails(Errc::kInvalidArgument)) << text;
  EXPECT_THAT(parse_client_message(R"({"type":"dance"})"), test::Fails(Errc::kNotFound));
}

TEST(ClientMessages, OfNewerBrowsersMaySayMore) {
  const auto message = parse_client_message(R"({"type":"ack","seq":7,"decode_ms":3})");
  ASSERT_THAT(message, test::IsOk());
  EXPECT_EQ(std::get<AckMessage>(*message).seq, 7u);
}

TEST(ClientMessages, TakeCountersThatMakeNoSenseAsZero) {
  const auto message = parse_client_message(
      R"({"type":"hello","token":"t","version":1,"epoch":-5,"seq":1e300,"parts":{"walls":"x","nonsense":3}})");
  ASSERT_THAT(message, test::IsOk());
  const auto& hello = std::get<HelloMessage>(*message);
  EXPECT_EQ(hello.epoch, 0u);
  EXPECT_EQ(hello.seq, 0u);
  EXPECT_EQ(hello.parts.at(Part::kWalls), 0u);
}

}  // namespace
}  // namespace smokemap::server
