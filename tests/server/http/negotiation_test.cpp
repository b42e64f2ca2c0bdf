// What browsers and proxies negotiate: codings, tags, lists in headers; and the roads that lead out of the folder.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "server/http/static_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

namespace fs = std::filesystem;

class BuiltApp : public testing::Test {
 protected:
  BuiltApp() : files_(root()) {}
  std::string root() {
    fs::create_directories(folder_.path() + "/web/assets/deep");
    for (const auto& [name, text] :
         std::vector<std::pair<std::string, std::string>>{{"web/index.html", "<!doctype html>" + std::string(600, ' ')},
                                                          {"web/assets/app-1a2b.js", std::string(900, ';')},
                                                          {"web/assets/deep/a b.css", "body {}"},
                                                          {"web/noise.bin", "0123456789"},
                                                          {"secret.txt", "secret"}})
      std::ofstream(folder_.path() + "/" + name, std::ios::binary) << text;
    return folder_.path() + "/web";
  }
  Response get(const std::string& path, const std::string& encodings = {}, const std::string& etags = {}) {
    Request asked;
    asked.path = path;
    asked.accept_encoding = encodings;
    asked.if_none_match = etags;
    return files_.get(asked);
  }
  static std::string header(const Response& response, const std::string& name) {
    for (const auto& [key, value] : response.headers)
      if (key == name) return value;
    return {};
  }
  bool packed(const std::string& encodings) {
    return header(get("/assets/app-1a2b.js", encodings), "Content-Encoding") == "gzip";
  }

  test::TemporaryFolder folder_;
  StaticFiles files_;
};

TEST_F(BuiltApp, PacksForThoseWhoSaySoAndNotForThoseWhoRuleItOut) {
  for (const char* yes : {"gzip", "gzip, deflate, br, zstd", "br;q=1.0, gzip;q=0.8", "gzip;q=0.001", "*",
                          "deflate,gzip", "identity, *;q=0.5", "  gzip  "})
    EXPECT_TRUE(packed(yes)) << yes;
  for (const char* no : {"", "br", "identity", "gzip;q=0", "gzip; q=0.000", "xgzip", "gzipped", "*;q=0", "deflate"})
    EXPECT_FALSE(packed(no)) << no;
}

TEST_F(BuiltApp, AnswersNotModifiedToEveryFormOfTheTag) {
  const std::string tag = header(get("/"), "ETag");
  ASSERT_TRUE(tag.starts_with("W/\"")) << "the same tag names the packed and the plain form: " << tag;
  const std::string opaque = tag.substr(2);
  for (const std::string& matching :
       {tag, opaque, "\"other\", " + tag, opaque + ",\"other\"", "W/\"other\" , " + opaque, std::string("*")}) {
    const Response response = get("/", "gzip", matching);
    EXPECT_EQ(response.status, 304) << matching;
    EXPECT_EQ(response.body, nullptr);
    EXPECT_EQ(header(response, "ETag"), tag);
    EXPECT_EQ(header(response, "Content-Encoding"), "");
  }
  for (const std::string& other : {std::string(), std::string("\"other\""), opaque.substr(1), tag + "x",
                                   std::string(","), std::string("W/"), std::string("\"\"")})
    EXPECT_EQ(get("/", "", other).status, 200) << other;
}

TEST_F(BuiltApp, APageUnderAnInventedAssetsAddressWasKeptForAYear) {
  const auto kept = [this](const std::string& path) {
    const Response response = get(path);
    return response.status == 200 && header(response, "Cache-Control").find("immutable") != std::string::npos;
  };
  EXPECT_TRUE(kept("/assets/app-1a2b.js"));
  EXPECT_TRUE(kept("/assets/deep/a b.css"));
  for (const char* page :
       {"/assets/gone", "/assets/", "/assets", "/assets/../index.html", "/assets/deep/../../index.html"})
    EXPECT_FALSE(kept(page)) << page;
}

/// Paths made of everything that has ever led out of a folder: what is served lies inside, whatever the path.
TEST_F(BuiltApp, ServesNothingFromOutsideForAnyPath) {
  std::mt19937_64 random(3);
  const std::vector<std::string> steps{"..",  ".",          "/",   "//",     "assets",  "deep", "secret.txt",
                                       "web", "index.html", "\\",  "..\\",   "...",     "%2e",  "~",
                                       " ",   "web-",       "etc", "passwd", "a b.css", "\n"};
  int served = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string path = "/";
    for (std::uint64_t n = 1 + uniform_index(random, 6); n > 0; --n) {
      path += steps[uniform_index(random, steps.size())];
      if (uniform01(random) < 0.7) path += "/";
    }
    if (uniform01(random) < 0.3) path += "secret.txt";
    const Response response = get(path);
    ASSERT_TRUE(response.status == 200 || response.status == 404) << path;
    if (response.status != 200) continue;
    ++served;
    ASSERT_NE(*response.body, "secret") << path;
  }
  EXPECT_GT(served, 200);
}

TEST_F(BuiltApp, SurvivesNamesThatNoFileCanHave) {
  EXPECT_EQ(get("/" + std::string(5000, 'x') + ".js").status, 404);
  EXPECT_EQ(get("/" + std::string(5000, 'x')).status, 200) << "an address that the app made up";
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "/a";
  EXPECT_EQ(get(deep + ".js").status, 404);
  EXPECT_EQ(get("/\xff\xfe.js").status, 404);
}

TEST_F(BuiltApp, GivesWhatLiesThereNow) {
  EXPECT_EQ(*get("/noise.bin").body, "0123456789");
  EXPECT_EQ(get("/noise.bin").content_type, "application/octet-stream");
  std::ofstream(folder_.path() + "/web/noise.bin", std::ios::binary) << std::string("\0new", 4);
  EXPECT_EQ(*get("/noise.bin").body, std::string("\0new", 4));
  fs::remove(folder_.path() + "/web/noise.bin");
  EXPECT_EQ(get("/noise.bin").status, 404) << "not from memory";
}

}  // namespace
}  // namespace smokemap::server
