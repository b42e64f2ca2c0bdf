#include <sstream>

#include "core/expect.hpp"
#include "recording/log_writer.hpp"
#include "recording/mcap_reader.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  RosLogBuilder builder;
  if (!read_mcap({data, size}, builder)) return 0;
  const SensorLog log = std::move(builder).finish("mcap");
  for (const LogItem& item : log.items)
    if (const auto* scan = std::get_if<LaserScan>(&item)) ENGINE_EXPECT(check(*scan).ok());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  std::ostringstream out;
  LogWriter writer(out);
  for (int i = 0; i < 5; ++i) {
    writer.add(LaserScan{i, "robot", 0, 0.1, 0, 0, 10, {1, 2, 3}, {}, Pose2(0.1, 0, 0)});
    writer.add(Odometry{i, "fox", Pose2(1, 2, 3), 0, 0});
  }
  ENGINE_EXPECT(writer.finish().ok());
  Bytes whole = bytes_of(out.str());
  // The same records outside of a chunk, so that wounds reach them without spoiling a sum.
  Bytes plain(whole.begin(), whole.begin() + 8);
  const auto put = [&](std::uint8_t op, const Bytes& body) {
    plain.push_back(op);
    const std::uint64_t length = body.size();
    for (int byte = 0; byte < 8; ++byte) plain.push_back(static_cast<std::uint8_t>(length >> (8 * byte)));
    plain.insert(plain.end(), body.begin(), body.end());
  };
  put(3, bytes_of(std::string("\1\0\x19\0\0\0sensor_msgs/msg/LaserScan\7\0\0\0ros2msg\0\0\0\0", 46)));
  put(4, bytes_of(std::string("\2\0\1\0\5\0\0\0/scan\3\0\0\0cdr\0\0\0\0", 24)));
  Bytes message(22, 0);
  message[0] = 2;
  const Bytes scan = encode_scan({7, "", 0, 0.1, 0, 0, 10, {1, 2, 3}, {}, {}}, "laser");
  message.insert(message.end(), scan.begin(), scan.end());
  put(5, message);
  return {whole, plain};
}
