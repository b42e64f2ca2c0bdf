// Everything the server says to people stands in proto/sentences.json, which every language of the page translates:
// whoever writes a new sentence hears of it here.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/json_schema.hpp"

namespace smokemap::server {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = SMOKEMAP_SOURCE_DIR;

/// Files that speak to people through the page; folders end in a slash.
constexpr std::array kSpeakers = {
    "engine/session/",
    "engine/navigation/",
    "engine/sketch/",
    "engine/matching/match.cpp",
    "engine/matching/transfer.cpp",
    "engine/acg/solver.cpp",
    "engine/acg/first_alignment.cpp",
    "engine/acg/auto_complete_graph.cpp",
    "engine/layout/sheet.cpp",
    "engine/layout/read_layout.cpp",
    "engine/recording/pdf_page.cpp",
    "engine/recording/picture_",
    "engine/recording/limited_",
    "engine/app/picture_reader.cpp",
    "engine/app/recording_port",
    "server/access/",
    "server/app/command_bus.cpp",
    "server/http/api_pictures",
    "server/http/exports.cpp",
    "server/store/file_store.cpp",
};

/// Three words and more that nobody is told.
const std::set<std::string> kNotSaid = {"does not fit", "correcting plan and map",
                                        "private, max-age=31536000, immutable",
                                        "coordinates are metres in the merged map, not longitude and latitude"};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool speaks(const std::string& file) {
  return !file.ends_with("_params.cpp") &&
         std::any_of(kSpeakers.begin(), kSpeakers.end(), [&](const char* start) { return file.starts_with(start); });
}

/// What of a text between quotes (or of a template between blanks) reads like words: three or more.
std::vector<std::string> wordy(const std::string& text, const std::regex& pattern, int group) {
  std::vector<std::string> found;
  for (std::sregex_token_iterator it(text.begin(), text.end(), pattern, group), end; it != end; ++it) {
    const std::string piece = *it;
    if (std::count(piece.begin(), piece.end(), ' ') >= 2) found.push_back(piece);
  }
  return found;
}

std::vector<std::string> sentences() {
  return test::read_json(kRoot / "proto" / "sentences.json").get<std::vector<std::string>>();
}

TEST(Sentences, OfTheServerStandInTheListThatThePageTranslates) {
  const std::vector<std::string> known = sentences();
  const std::regex quoted(R"re("((?:[^"\\\n]|\\.)*)")re"), comment(R"(//[^\n]*)"), joint(R"("\s*\n\s*")");
  const std::regex blank(R"(%[.\d]*[a-z]|\\n)");
  int found = 0;
  for (const char* side : {"engine", "server"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / side)) {
      const std::string file = fs::relative(entry.path(), kRoot).string();
      if (!entry.is_regular_file() || !speaks(file)) continue;
      const std::string code = std::regex_replace(std::regex_replace(text_of(entry.path()), comment, ""), joint, "");
      for (const std::string& literal : wordy(code, quoted, 1))
        for (const std::string& piece : wordy(literal, blank, -1)) {
          if (kNotSaid.contains(piece)) continue;
          ++found;
          EXPECT_TRUE(std::any_of(known.begin(), known.end(),
                                  [&](const std::string& s) { return s.find(piece) != std::string::npos; }))
              << file << ": \"" << piece << '"';
        }
    }
  EXPECT_GT(found, 100);
}

TEST(Sentences, OfTheListAreStillSaid) {
  std::string all;
  for (const char* side : {"engine", "server", "web/src/link"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / side))
      if (entry.is_regular_file()) all += text_of(entry.path());
  const std::regex joint(R"("\s*\n\s*")"), blank(R"(\{\w+\})");
  all = std::regex_replace(all, joint, "");
  std::set<std::string> once;
  for (const std::string& sentence : sentences()) {
    EXPECT_TRUE(once.insert(sentence).second) << sentence << " stands there twice";
    for (const std::string& piece : wordy(sentence, blank, -1))
      EXPECT_NE(all.find(piece), std::string::npos) << '"' << piece << "\" is said nowhere";
  }
}

}  // namespace
}  // namespace smokemap::server
