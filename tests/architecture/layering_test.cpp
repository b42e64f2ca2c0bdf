// Reads engine/layers.txt and server/layers.txt and every #include below them: who may include whom is data, and a slip
// is a failing test.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace smokemap {
namespace {

namespace fs = std::filesystem;

struct Rules {
  struct Module {
    enum class Kind { kFloor, kSide, kTop } kind;
    int floor;
  };
  std::map<std::string, Module> modules;
  struct Home {
    std::string library, prefix;
    std::set<std::string> modules;
  };
  std::vector<Home> homes;
  std::vector<Home> files;  ///< as homes, but single files ("http/asio_impl.cpp") instead of modules

  bool may_include(const std::string& from, const std::string& to) const {
    if (from == to) return true;
    const auto a = modules.at(from), b = modules.at(to);
    if (a.kind == Module::Kind::kTop) return true;
    if (b.kind != Module::Kind::kFloor) return false;
    return a.kind == Module::Kind::kFloor ? b.floor < a.floor : b.floor <= a.floor;
  }
};

Rules read_rules(std::istream& in) {
  Rules rules;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string kind, name;
    if (!(words >> kind)) continue;
    if (kind == "home" || kind == "file") {
      Rules::Home home;
      std::string colon;
      words >> home.library >> home.prefix >> colon;
      for (std::string module; words >> module;) home.modules.insert(module);
      (kind == "home" ? rules.homes : rules.files).push_back(home);
      continue;
    }
    int floor = 0;
    if (kind != "top") words >> floor;
    words >> name;
    rules.modules[name] = {kind == "floor"  ? Rules::Module::Kind::kFloor
                           : kind == "side" ? Rules::Module::Kind::kSide
                                            : Rules::Module::Kind::kTop,
                           floor};
  }
  return rules;
}

/// One complaint a forbidden include in `text`, the source `file` ("slam/slam.cpp") below the folder `tree`.
std::vector<std::string> complaints(const Rules& rules, const std::string& file, const std::string& text,
                                    const std::string& tree = "engine") {
  const std::string module = file.substr(0, file.find('/'));
  static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    std::string path = match[2];
    if (path.starts_with(tree + "/")) path.erase(0, tree.size() + 1);
    const std::string folder = path.substr(0, path.find('/'));
    if (match[1] == "\"" && rules.modules.contains(folder) && !rules.may_include(module, folder))
      found.push_back(module + " may not include " + path);
    for (const auto& home : rules.homes)
      if (path.starts_with(home.prefix) && !home.modules.contains(module))
        found.push_back(path + " has no home in " + module);
    for (const auto& allowed : rules.files)
      if (path.starts_with(allowed.prefix) && !allowed.modules.contains(file))
        found.push_back(path + " may not be included by " + file);
  }
  return found;
}

Rules rules_of(const std::string& tree) {
  std::ifstream in(SMOKEMAP_SOURCE_DIR "/" + tree + "/layers.txt");
  return read_rules(in);
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_source(const fs::path& path) { return path.extension() == ".cpp" || path.extension() == ".hpp"; }

class Tree : public testing::TestWithParam<const char*> {};

TEST_P(Tree, IncludesOnlyDownwards) {
  const std::string tree = GetParam();
  const Rules rules = rules_of(tree);
  const fs::path folder = fs::path(SMOKEMAP_SOURCE_DIR) / tree;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    const fs::path file = fs::relative(entry.path(), folder);
    ASSERT_TRUE(rules.modules.contains(file.begin()->string())) << file << " is of no module in layers.txt";
    for (const std::string& complaint : complaints(rules, file.string(), read_file(entry.path()), tree))
      ADD_FAILURE() << entry.path() << ": " << complaint;
  }
}

TEST_P(Tree, NamesOnlyModulesAndFilesThatExist) {
  const fs::path folder = fs::path(SMOKEMAP_SOURCE_DIR) / GetParam();
  const Rules rules = rules_of(GetParam());
  ASSERT_FALSE(rules.modules.empty());
  for (const auto& [module, place] : rules.modules) EXPECT_TRUE(fs::is_directory(folder / module)) << module;
  for (const auto& home : rules.homes)
    for (const std::string& module : home.modules) EXPECT_TRUE(rules.modules.contains(module)) << module;
  for (const auto& allowed : rules.files)
    for (const std::string& file : allowed.modules) EXPECT_TRUE(fs::is_regular_file(folder / file)) << file;
}

INSTANTIATE_TEST_SUITE_P(Layering, Tree, testing::Values("engine", "server"),
                         [](const auto& of) { return std::string(of.param); });

TEST(Layering, ServerSpeaksToTheEngineThroughItsFacade) {
  // The server may know the nouns and the facade, not the methods.
  const std::set<std::string> methods{"layout", "sketch",       "segmentation", "topology",   "features",   "slam",
                                      "acg",    "localization", "matching",     "navigation", "simulation", "robots"};
  static const std::regex include(R"re(#\s*include\s*"([a-z_]+)/)re");
  for (const auto& entry : fs::recursive_directory_iterator(SMOKEMAP_SOURCE_DIR "/server")) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    std::istringstream lines(read_file(entry.path()));
    for (std::string line; std::getline(lines, line);) {
      std::smatch match;
      const bool quoted = std::regex_search(line, match, include);
      EXPECT_FALSE(quoted && methods.contains(match[1])) << entry.path() << ": " << line;
    }
  }
}

TEST(Layering, OnlyThreeSourcesInstantiateBeast) {
  for (const auto& allowed : rules_of("server").files) {
    const auto sources = std::count_if(allowed.modules.begin(), allowed.modules.end(),
                                       [](const std::string& file) { return file.ends_with(".cpp"); });
    EXPECT_TRUE(allowed.library != "boost" || sources <= 3) << "Beast costs 15 to 37 s a source";
  }
}

TEST(Layering, NoSourceFileIsLongerThanFourHundredLines) {
  for (const char* folder : {"engine", "server", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(SMOKEMAP_SOURCE_DIR) / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      const std::string text = read_file(entry.path());
      EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 400) << entry.path();
    }
}

TEST(Layering, EveryTypeInAHeaderHasANameOfItsOwn) {
  // All of the engine shares one namespace: two types of one name in one program are undefined behaviour without a
  // word.
  static const std::regex definition(R"(^(struct|class|enum class) ([A-Z][A-Za-z0-9]+)( final)?( :[^;]*)? *\{)");
  std::map<std::string, fs::path> seen;
  for (const char* folder : {"/engine", "/server"})
    for (const auto& entry : fs::recursive_directory_iterator(SMOKEMAP_SOURCE_DIR + std::string(folder))) {
      if (entry.path().extension() != ".hpp") continue;
      std::istringstream lines(read_file(entry.path()));
      for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, definition)) continue;
        const auto [it, fresh] = seen.emplace(folder + std::string(" ") + match[2].str(), entry.path());
        EXPECT_TRUE(fresh) << match[2] << " is defined in " << it->second << " and in " << entry.path();
      }
    }
}

TEST(Rules, RefuseNeighboursAndUpperFloors) {
  std::istringstream in(
      "floor 0 core\nfloor 1 geometry\nfloor 1 grids\nside 1 tools\ntop app\nhome boost boost/ : app\n");
  const Rules rules = read_rules(in);
  EXPECT_TRUE(complaints(rules, "geometry/pose2.cpp", "#include \"core/result.hpp\"\n#include \"geometry/pose2.hpp\"\n")
                  .empty());
  EXPECT_EQ(complaints(rules, "geometry/pose2.cpp", "#include \"grids/grid.hpp\"\n").size(), 1u);
  EXPECT_EQ(complaints(rules, "core/time.cpp", "  #  include \"geometry/pose2.hpp\"\n").size(), 1u);
  EXPECT_EQ(complaints(rules, "geometry/pose2.cpp", "#include \"tools/hammer.hpp\"\n").size(), 1u);
  EXPECT_TRUE(complaints(rules, "tools/saw.cpp", "#include \"grids/grid.hpp\"\n").empty());
  EXPECT_EQ(complaints(rules, "core/time.cpp", "#include <boost/asio.hpp>\n").size(), 1u);
  EXPECT_TRUE(complaints(rules, "app/main.cpp", "#include <boost/asio.hpp>\n").empty());
}

TEST(Rules, LetOnlyNamedFilesIncludeWhatIsDear) {
  std::istringstream in("floor 0 wire\nfloor 1 http\nhome boost boost/ : http\nfile boost boost/ : http/impl.cpp\n");
  const Rules rules = read_rules(in);
  const std::string dear = "#include <boost/beast.hpp>\n";
  EXPECT_TRUE(complaints(rules, "http/impl.cpp", dear, "server").empty());
  EXPECT_EQ(complaints(rules, "http/api.cpp", dear, "server").size(), 1u);
  EXPECT_EQ(complaints(rules, "wire/json.cpp", dear, "server").size(), 2u);
  EXPECT_EQ(complaints(rules, "wire/json.cpp", "#include \"server/http/api.hpp\"\n", "server").size(), 1u);
  EXPECT_TRUE(complaints(rules, "http/api.cpp", "#include \"server/wire/json.hpp\"\n", "server").empty());
}

}  // namespace
}  // namespace smokemap
