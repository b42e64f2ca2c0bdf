#include "core/expect.hpp"
#include "server/wire/commands_json.hpp"
#include "server/wire/messages.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;
using namespace smokemap::server;

// What a browser says: whatever it is, it is understood or refused, and an understood command survives the log.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = parse_client_message({reinterpret_cast<const char*>(data), size});
  if (!message) return 0;
  const auto* asked = std::get_if<CommandMessage>(&*message);
  if (!asked) return 0;
  const auto command = command_from_json(asked->name, asked->data, {"fuzz", 1});
  if (!command) return 0;
  const auto logged = parse_json(to_text(command_data(*command)), {64 * 1024 * 1024, 64});
  ENGINE_EXPECT(logged.ok());
  ENGINE_EXPECT(command_from_json(command_name(*command), *logged, {"fuzz", 1}).ok());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  std::vector<Bytes> corpus;
  for (
      const char* text :
      {R"({"type":"hello","token":"0123","version":1,"epoch":5,"seq":7,"view":{"x":1,"y":2,"radius":3},"parts":{"walls":4}})",
       R"({"type":"ack","seq":812})", R"({"type":"ping","t":1.5})", R"({"type":"presence","mode":"operate","p":[1,2]})",
       R"({"type":"ink","stroke_id":"s","points":[[1,2],[3,4]]})", R"({"type":"view","x":1,"y":2,"radius":3})",
       R"({"type":"command","id":"a","name":"place_poi","data":{"poi_id":"p","kind":"fire","frame":"map","p":[1,2],"label":"x"}})",
       R"({"type":"command","id":"a","name":"add_stroke","data":{"stroke_id":"s","kind":"wall","width":3,"points":[[1,2],[3,4]]}})",
       R"({"type":"command","id":"a","name":"set_goal","expires_ms":9,"data":{"goal_id":"g","robot":"r","frame":"map","p":[1,2],"heading":null}})",
       R"({"type":"command","id":"a","name":"set_layout","data":{"plan_id":"x","layout":{"size":[9,9],"walls":[[1,1,5,1,2],[5,1,5,5,2]],"corners":[[1,1],[5,1],[5,5]],"wall_corners":[[0,1],[1,2]]}}})"})
    corpus.push_back(bytes_of(text));
  return corpus;
}
