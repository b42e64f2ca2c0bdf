#include "core/expect.hpp"
#include "server/access/origin.hpp"
#include "server/http/message.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;
using namespace smokemap::server;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Request request;
  if (parse_target(text, request)) ENGINE_EXPECT(!request.path.empty() && request.path.find('\0') == std::string::npos);
  (void)OriginPolicy({"map.example"}).host_is_ours(text, "127.0.0.1", 8080);
  (void)OriginPolicy::origin_is_ours(text, "127.0.0.1:8080");
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  return {bytes_of("/api/plans/0123/picture?v=abc&page=%31"), bytes_of("/a%20b/%C3%A4?x=1&&y#z"),
          bytes_of("127.0.0.1:8080"), bytes_of("http://localhost:8080")};
}
