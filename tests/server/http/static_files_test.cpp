#include "server/http/static_files.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

namespace fs = std::filesystem;

/// A built web app beside a file that is nobody's business.
struct Site {
  Site() {
    fs::create_directories(root() + "/assets");
    write("web/index.html", "<!doctype html>" + std::string(600, ' '));
    write("web/assets/app-1a2b.js", "let a = 1;" + std::string(600, ';'));
    write("web/small.txt", "x");
    write("secret.txt", "secret");
  }
  std::string root() const { return folder.path() + "/web"; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder.path() + "/" + name, std::ios::binary) << text;
  }
  static Request request(const std::string& path, const std::string& encodings = {}, const std::string& etag = {}) {
    Request asked;
    asked.path = path;
    asked.accept_encoding = encodings;
    asked.if_none_match = etag;
    return asked;
  }
  test::TemporaryFolder folder;
};

std::string header(const Response& response, const std::string& name) {
  for (const auto& [key, value] : response.headers)
    if (key == name) return value;
  return {};
}

std::string unpacked(const std::string& gzip) {
  z_stream stream{};
  std::string out(100'000, '\0');
  if (inflateInit2(&stream, 15 + 16) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.avail_in = static_cast<uInt>(gzip.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = inflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return status == Z_STREAM_END ? out : std::string();
}

TEST(StaticFiles, KnowTheTypesThatBrowsersInsistOn) {
  EXPECT_EQ(media_type_of("/assets/app.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(media_type_of("x.mjs"), "text/javascript; charset=utf-8");
  EXPECT_EQ(media_type_of("x.wasm"), "application/wasm");
  EXPECT_EQ(media_type_of("manifest.webmanifest"), "application/manifest+json");
  EXPECT_EQ(media_type_of("x.woff2"), "font/woff2");
  EXPECT_EQ(media_type_of("x.exe"), "application/octet-stream");
  EXPECT_EQ(media_type_of(""), "application/octet-stream");
}

TEST(StaticFiles, ArePackedForThoseWhoCanUnpackThem) {
  const Site site;
  StaticFiles files(site.root());
  const Response packed = files.get(Site::request("/assets/app-1a2b.js", "br, gzip"));
  EXPECT_EQ(header(packed, "Content-Encoding"), "gzip");
  EXPECT_EQ(header(packed, "Vary"), "Accept-Encoding");
  const Response plain = files.get(Site::request("/assets/app-1a2b.js", "br"));
  EXPECT_EQ(header(plain, "Content-Encoding"), "");
  EXPECT_EQ(unpacked(*packed.body), *plain.body);
  const Response small = files.get(Site::request("/small.txt", "gzip"));
  EXPECT_EQ(*small.body, "x") << "packing would make it larger";
}

TEST(StaticFiles, AreCachedForEverOnlyUnderNamesThatChangeWithThem) {
  const Site site;
  StaticFiles files(site.root());
  EXPECT_EQ(header(files.get(Site::request("/")), "Cache-Control"), "no-cache");
  EXPECT_NE(header(files.get(Site::request("/assets/app-1a2b.js")), "Cache-Control").find("immutable"),
            std::string::npos);
}

TEST(StaticFiles, AreSentAgainOnlyWhenTheyChanged) {
  const Site site;
  StaticFiles files(site.root());
  const std::string etag = header(files.get(Site::request("/")), "ETag");
  const Response unchanged = files.get(Site::request("/", "", etag));
  EXPECT_EQ(unchanged.status, 304);
  EXPECT_EQ(unchanged.body, nullptr);
  EXPECT_EQ(header(unchanged, "ETag"), etag);
  site.write("web/index.html", "<!doctype html>new");
  const Response changed = files.get(Site::request("/", "", etag));
  EXPECT_EQ(changed.status, 200);
  EXPECT_EQ(*changed.body, "<!doctype html>new");
  EXPECT_NE(header(changed, "ETag"), etag);
}

TEST(StaticFiles, GiveThePageForAddressesThatTheAppMadeUp) {
  const Site site;
  StaticFiles files(site.root());
  const SharedBytes page = files.get(Site::request("/")).body;
  for (const char* path : {"/operate", "/review/12", "/index.html"})
    EXPECT_EQ(files.get(Site::request(path)).body, page) << path;
  for (const char* path : {"/none.js", "/assets/none.css", "/operate/x.png"})
    EXPECT_EQ(files.get(Site::request(path)).status, 404) << "a file that is missing is missing: " << path;
}

TEST(StaticFiles, NeverLeaveTheirFolder) {
  const Site site;
  fs::create_symlink(site.folder.path() + "/secret.txt", site.root() + "/link.txt");
  fs::create_directory_symlink(site.folder.path(), site.root() + "/up");
  StaticFiles files(site.root());
  for (const char* path :
       {"/../secret.txt", "/assets/../../secret.txt", "//secret.txt", "/./../secret.txt", "/..\\secret.txt",
        "/assets/..\\..\\secret.txt", "/link.txt", "/up/secret.txt", "/../web/../secret.txt", "/etc/passwd.txt"}) {
    const Response response = files.get(Site::request(path));
    EXPECT_EQ(response.status, 404) << path;
  }
  EXPECT_EQ(files.get(Site::request("/assets/../small.txt")).status, 200) << "a way that stays inside";
  EXPECT_EQ(files.get(Site::request("/assets.d")).status, 404);
}

TEST(StaticFiles, DoNotMistakeAFolderWithTheSameBeginningForTheirs) {
  const Site site;
  fs::create_directories(site.folder.path() + "/web-secret");
  site.write("web-secret/key.txt", "key");
  StaticFiles files(site.root());
  EXPECT_EQ(files.get(Site::request("/../web-secret/key.txt")).status, 404);
}

TEST(StaticFiles, AreNoneWithoutAFolder) {
  StaticFiles none(""), missing("/no/such/folder");
  for (StaticFiles* files : {&none, &missing})
    for (const char* path : {"/", "/index.html", "/../etc/passwd"})
      EXPECT_EQ(files->get(Site::request(path)).status, 404);
}

}  // namespace
}  // namespace smokemap::server
