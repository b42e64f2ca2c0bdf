#include "server/wire/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/random.hpp"
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
  const Json json = {{"x", 1e300}, {"id", "has space"}, {"p", {1, "two"}}, {"flag", 1}};
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

TEST(ParseJson, TakesExactlyItsLimits) {
  const auto nested = [](int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
  };
  EXPECT_THAT(parse_json(nested(16), {1000, 16}), test::IsOk());
  EXPECT_THAT(parse_json(nested(17), {1000, 16}), test::Fails(Errc::kTooLarge));
  const std::string text = "\"" + std::string(98, 'x') + "\"";
  EXPECT_THAT(parse_json(text, {100, 4}), test::IsOk());
  EXPECT_THAT(parse_json(text, {99, 4}), test::Fails(Errc::kTooLarge));
  for (const char* number : {"1e999", "-1e999", "NaN", "Infinity", "01", "+1", ".5", "0x10"})
    EXPECT_THAT(parse_json(number), test::Fails(Errc::kCorrupt)) << number;
  EXPECT_EQ((*parse_json("{\"a\":1,\"a\":2}"))["a"], 2) << "of a key that comes twice the last counts";
}

TEST(ParseJson, CountsBracketsOutsideOfStringsOnlyWhateverIsEscaped) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 500; ++i) {
    std::string inside;
    for (std::uint64_t n = uniform_index(random, 30); n > 0; --n)
      inside += std::string("[{\"\\]}x")[uniform_index(random, 7)];
    EXPECT_THAT(parse_json(to_text(Json::array({inside})), {1000, 1}), test::IsOk()) << inside;
  }
}

TEST(Rounded, HugeNumbersBecameNull) {
  for (const double value : {1e306, -1e306, 1.7e308}) {
    EXPECT_TRUE(std::isfinite(rounded(value, 0.001))) << value;
    EXPECT_NE(to_text(Json(rounded_m(value))), "null") << value;
  }
}

TEST(Rounded, IsNeverFurtherThanHalfAStepAndRoundingTwiceIsRoundingOnce) {
  std::mt19937_64 random(5);
  for (const double step : {0.0001, 0.001, 0.01, 0.1})
    for (int i = 0; i < 1000; ++i) {
      const double value = uniform(random, -1e5, 1e5), once = rounded(value, step);
      EXPECT_LE(std::abs(once - value), 0.5 * step + 1e-9);
      EXPECT_EQ(rounded(once, step), once);
      EXPECT_LE(to_text(Json(once)).size(), 14u) << "short on the wire";
    }
}

TEST(FieldsOfMessages, ReadNothingFromWhatIsNoObject) {
  for (const Json& json : {Json(), Json(1), Json("x"), Json::array({1})}) {
    Fields f(json, "thing");
    EXPECT_FALSE(f.has("x"));
    EXPECT_EQ(f.text("x", 5), "");
    EXPECT_EQ(f.number("x", 3, 4), 3) << "within its range even when it is not there";
    EXPECT_EQ(f.point("x"), Point2(0, 0));
    EXPECT_TRUE(f.points("x", 0, 5).empty());
    EXPECT_FALSE(f.boolean("x"));
    EXPECT_EQ(f.error().message, "thing is not an object") << json;
  }
}

TEST(FieldsOfMessages, TakeListsOfPointsOfTheAskedLength) {
  const auto read = [](const Json& list) {
    const Json json{{"list", list}};
    Fields f(json, "thing");
    const auto points = f.points("list", 1, 3);
    return f.ok() ? static_cast<int>(points.size()) : -1;
  };
  const Json p = {1, 2};
  EXPECT_EQ(read(Json::array({p})), 1);
  EXPECT_EQ(read(Json::array({p, p, p})), 3);
  for (const Json& list : {Json::array(), Json::array({p, p, p, p}), Json::array({p, 1}), Json::array({p, {1, 1e8}}),
                           Json("[[1,2]]"), Json{{"0", p}}})
    EXPECT_EQ(read(list), -1) << list;
}

}  // namespace
}  // namespace smokemap::server
