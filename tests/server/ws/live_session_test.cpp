#include "server/ws/live_session.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/support/example_snapshot.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

/// Answers every command at once.
class PromptSink final : public CommandSink {
 public:
  void submit(const Identity& who, CommandMessage message, Reply reply) override {
    last = who.name + ": " + message.name;
    reply({message.id, 1, "", ""});
  }
  std::string last;
};

class NoPeer final : public Peer {
 public:
  void wake() override {}
  void deliver(SharedBytes text, bool) override { delivered.push_back(*text); }
  void shut(int, const char*) override {}
  std::vector<std::string> delivered;
};

/// A grid of `size` cells in which a square of known cells stands at (x, y).
std::shared_ptr<Snapshot> snapshot_with(std::mt19937_64& random, int changes,
                                        const std::shared_ptr<const Snapshot>& before) {
  auto next = before ? std::make_shared<Snapshot>(*before) : std::make_shared<Snapshot>();
  auto grid = before ? std::make_shared<OccupancyGrid>(*before->sensed)
                     : std::make_shared<OccupancyGrid>(GridFrame{0.05, Eigen::Vector2d(-32, -32), 1280, 1280});
  for (int i = 0; i < changes; ++i)
    grid->at({static_cast<int>(uniform_index(random, 1280)), static_cast<int>(uniform_index(random, 1280))}) =
        static_cast<std::int8_t>(uniform_index(random, 101));
  next->sensed = grid;
  if (!next->merged) next->merged = std::make_shared<MergedMap>();
  if (!next->sketch) next->sketch = std::make_shared<SketchView>();
  return next;
}

struct World {
  World() {
    LiveParams params;
    params.tile_period_ms = params.robot_period_ms = params.vector_period_ms = 0;
    hub = std::make_unique<Hub>(params, 77, clock);
    token = access->pair({"123456", "Anna", Role::kCommander, false})->token;
  }
  ~World() { hub->stop(std::chrono::milliseconds(0)); }
  std::unique_ptr<LiveSession> session(const std::shared_ptr<Peer>& peer, LiveSession::Params params = {}) {
    auto shared = std::make_shared<LiveSession*>(nullptr);
    LiveSession::World parts{*access, *hub, sink,
                             clock,   peer, [shared](const CommandReply& r) { (*shared)->on_reply(r); }};
    auto session = std::make_unique<LiveSession>(params, std::move(parts));
    *shared = session.get();
    return session;
  }
  std::string hello(const std::string& more = {}) const {
    return R"({"type":"hello","version":1,"token":")" + token + "\"" + (more.empty() ? R"(,"epoch":0,"seq":0)" : more) +
           "}";
  }
  /// Shows the snapshot and waits until the hub has encoded it.
  void show(const std::shared_ptr<const Snapshot>& snapshot) {
    const std::uint64_t before = hub->state()->seq;
    hub->show(snapshot);
    while (hub->state()->seq == before) std::this_thread::yield();
  }

  std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
  std::unique_ptr<Access> access = [this] {
    PairingParams params;
    params.pin = "123456";
    return std::make_unique<Access>(params, clock, [](const PairedDevice&) -> Result<Ok> { return Ok{}; });
  }();
  PromptSink sink;
  std::unique_ptr<Hub> hub;
  std::string token;
};

/// What a browser has drawn.
struct Drawing {
  std::map<TileKey, PackedTile> tiles;
  std::uint64_t seq = 0;
  int frames = 0, tiles_received = 0;
  bool ended = false;
  std::vector<Json> texts;

  /// Takes all there is; with `acking`, every map frame is acknowledged.
  void drain(LiveSession& session, bool acking = true) {
    while (const auto frame = session.next_frame()) {
      if (!frame->binary) {
        texts.push_back(Json::parse(*frame->bytes));
        continue;
      }
      const auto decoded = decode_map_frame(*frame->bytes);
      ASSERT_THAT(decoded, test::IsOk());
      EXPECT_LE(frame->bytes->size(), 64u * 1024 + 32);
      ++frames;
      seq = decoded->header.seq;
      ended = ended || decoded->type == 2;
      for (const auto& tile : decoded->tiles) tiles[tile.key] = tile.cells;
      tiles_received += static_cast<int>(decoded->tiles.size());
      if (acking && decoded->type == 1) session.on_text(R"({"type":"ack","seq":)" + std::to_string(seq) + "}", 0);
    }
  }
  bool shows(const Snapshot& snapshot) const {
    for (const auto& [key, cells] : merged_tiles(*snapshot.sensed, *snapshot.merged, 0.05))
      if (!tiles.contains(key) || tiles.at(key) != cells) return false;
    return true;
  }
};

TEST(LiveSession, SendsTheWholeMapInFramesAndSaysWhenItIsComplete) {
  World world;
  std::mt19937_64 random(1);
  const auto snapshot = snapshot_with(random, 200'000, nullptr);
  world.show(snapshot);
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(), 0);
  Drawing drawing;
  drawing.drain(*session);
  EXPECT_EQ(drawing.texts.at(0)["type"], "welcome");
  EXPECT_TRUE(drawing.shows(*snapshot));
  EXPECT_TRUE(drawing.ended);
  EXPECT_GT(drawing.frames, 3);
  EXPECT_EQ(drawing.seq, world.hub->state()->seq);
}

TEST(LiveSession, SendsTheTileInViewFirst) {
  World world;
  std::mt19937_64 random(2);
  world.show(snapshot_with(random, 100'000, nullptr));
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(R"(,"epoch":0,"seq":0,"view":{"x":20,"y":-15,"radius":5})"), 0);
  std::optional<LiveSession::Frame> frame;
  do frame = session->next_frame();
  while (frame && !frame->binary);
  ASSERT_TRUE(frame);
  EXPECT_EQ(decode_map_frame(*frame->bytes)->tiles.at(0).key, (TileKey{3, -3}));
}

TEST(LiveSession, WaitsForAcksAndThenSendsOnlyTheNewest) {
  World world;
  std::mt19937_64 random(3);
  auto snapshot = snapshot_with(random, 10, nullptr);
  world.show(snapshot);
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(), 0);
  Drawing slow;
  slow.drain(*session, false);
  for (int i = 0; i < 50; ++i) {  // nothing is acknowledged meanwhile
    snapshot = snapshot_with(random, 3, snapshot);
    world.show(snapshot);
    slow.drain(*session, false);
  }
  EXPECT_LE(slow.frames, 3) << "two on credit and the end of the snapshot";
  const int before = slow.frames;
  session->on_text(R"({"type":"ack","seq":1})", 0);
  slow.drain(*session);
  EXPECT_LE(slow.frames - before, 3);
  EXPECT_TRUE(slow.shows(*snapshot)) << "the newest state, not fifty old ones";
}

TEST(LiveSession, ResumesWithTheChangedTilesOnly) {
  World world;
  std::mt19937_64 random(4);
  auto snapshot = snapshot_with(random, 100'000, nullptr);
  world.show(snapshot);
  Drawing drawing;
  const auto peer = std::make_shared<NoPeer>();
  {
    const auto session = world.session(peer);
    session->on_text(world.hello(), 0);
    drawing.drain(*session);
  }
  world.hub->leave(peer.get());
  auto changed = std::make_shared<Snapshot>(*snapshot);
  auto grid = std::make_shared<OccupancyGrid>(*snapshot->sensed);
  for (int i = 0; i < 40; ++i) grid->at({600 + i, 640}) = 100;  // two tiles
  changed->sensed = grid;
  world.show(changed);
  const auto again = world.session(peer);
  again->on_text(world.hello(R"(,"epoch":77,"seq":)" + std::to_string(drawing.seq)), 0);
  drawing.tiles_received = 0;
  drawing.drain(*again);
  EXPECT_TRUE(drawing.shows(*changed));
  EXPECT_LE(drawing.tiles_received, 2);
}

TEST(LiveSession, NeverClaimsAResumePointBeforeEverythingUpToItWasSent) {
  World world;
  std::mt19937_64 random(5);
  auto snapshot = snapshot_with(random, 150'000, nullptr);
  world.show(snapshot);
  for (int cut = 1; cut < 6; ++cut) {  // the link breaks after `cut` frames
    Drawing drawing;
    const auto peer = std::make_shared<NoPeer>();
    for (int attempt = 0; attempt < 2; ++attempt) {
      const auto session = world.session(peer);
      session->on_text(world.hello(R"(,"epoch":77,"seq":)" + std::to_string(drawing.seq)), 0);
      for (int taken = 0; attempt == 1 || taken < cut;) {
        const auto frame = session->next_frame();
        if (!frame) break;
        if (!frame->binary) continue;
        ++taken;
        const auto decoded = *decode_map_frame(*frame->bytes);
        drawing.seq = decoded.header.seq;
        for (const auto& tile : decoded.tiles) drawing.tiles[tile.key] = tile.cells;
        session->on_text(R"({"type":"ack","seq":1})", 0);
      }
      world.hub->leave(peer.get());
      if (attempt == 0) world.show(snapshot = snapshot_with(random, 5, snapshot));
    }
    EXPECT_TRUE(drawing.shows(*snapshot)) << cut;
  }
}

TEST(LiveSession, ForgetsWhatABrowserKnewOfAnotherRun) {
  World world;
  std::mt19937_64 random(6);
  const auto snapshot = snapshot_with(random, 1000, nullptr);
  world.show(snapshot);
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(R"(,"epoch":76,"seq":9999,"parts":{"people":9})"), 0);
  Drawing drawing;
  drawing.drain(*session);
  EXPECT_TRUE(drawing.shows(*snapshot));
}

TEST(LiveSession, LetsNobodyInWithoutAToken) {
  World world;
  const auto peer = std::make_shared<NoPeer>();
  const auto close_code = [&](const std::string& text) {
    const auto session = world.session(peer);
    session->on_text(text, 0);
    return session->closing() ? session->closing()->code : 0;
  };
  EXPECT_EQ(close_code(R"({"type":"hello","version":1,"token":"wrong","epoch":0,"seq":0})"), kNoToken);
  EXPECT_EQ(close_code(R"({"type":"ping","t":1})"), kProtocolError);
  EXPECT_EQ(close_code("not json"), kProtocolError);
  EXPECT_EQ(close_code(world.hello()), 0);
  const auto silent = world.session(peer);
  silent->on_time(4'000);
  EXPECT_FALSE(silent->closing());
  silent->on_time(6'000);
  EXPECT_EQ(silent->closing()->code, kProtocolError) << "not 4001: a thin link is no reason to forget the token";
  EXPECT_EQ(Json::parse(*silent->next_frame()->bytes)["type"], "bye");
  EXPECT_FALSE(silent->next_frame());
}

TEST(LiveSession, ClosesOnFloods) {
  World world;
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(), 0);
  for (int i = 0; i < 300; ++i) session->on_text(R"({"type":"ack","seq":1})", i);
  EXPECT_FALSE(session->closing());
  for (int i = 0; i < 600; ++i) session->on_text(R"({"type":"ack","seq":1})", 300 + i / 10);
  EXPECT_EQ(session->closing()->code, kTooMany);
}

TEST(LiveSession, ClosesOnASocketThatDoesNotTakeItsAnswersButDropsInkFirst) {
  World world;
  LiveSession::Params params;
  params.messages_per_s = 1e6;
  params.bytes_per_s = 1e9;
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer, params);
  session->on_text(world.hello(), 0);
  const auto ink = std::make_shared<const std::string>(10'000, 'x');
  for (int i = 0; i < 100; ++i) session->on_deliver(ink, true);
  EXPECT_FALSE(session->closing());
  for (int i = 0; i < 10'000 && !session->closing(); ++i) session->on_text(R"({"type":"ping","t":1})", 0);
  ASSERT_TRUE(session->closing());
  EXPECT_EQ(session->closing()->code, kTooSlow);
}

TEST(LiveSession, CarriesCommandsWithTheNameOfWhoeverHoldsTheToken) {
  World world;
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(), 0);
  session->on_text(R"({"type":"command","id":"c1","name":"clear_sketch","data":{}})", 0);
  EXPECT_EQ(world.sink.last, "Anna: clear_sketch");
  Drawing drawing;
  drawing.drain(*session);
  const auto done =
      std::find_if(drawing.texts.begin(), drawing.texts.end(), [](const Json& t) { return t["type"] == "done"; });
  ASSERT_NE(done, drawing.texts.end());
  EXPECT_EQ((*done)["id"], "c1");
}

TEST(LiveSession, ShowsInkToOthersButNotToItsAuthor) {
  World world;
  const auto anna = std::make_shared<NoPeer>(), bo = std::make_shared<NoPeer>();
  const auto of_anna = world.session(anna), of_bo = world.session(bo);
  of_anna->on_text(world.hello(), 0);
  of_bo->on_text(world.hello(), 0);
  of_anna->on_text(R"({"type":"ink","stroke_id":"s1","points":[[1,2]]})", 0);
  EXPECT_TRUE(anna->delivered.empty());
  ASSERT_EQ(bo->delivered.size(), 1u);
  EXPECT_EQ(Json::parse(bo->delivered[0])["stroke_id"], "s1");
}

TEST(LiveSession, TellsANewerBrowserThatItDoesNotKnowAMessage) {
  World world;
  const auto peer = std::make_shared<NoPeer>();
  const auto session = world.session(peer);
  session->on_text(world.hello(), 0);
  session->on_text(R"({"type":"dance"})", 0);
  EXPECT_FALSE(session->closing());
  Drawing drawing;
  drawing.drain(*session);
  EXPECT_EQ(drawing.texts.at(1)["code"], "not_found");
}

TEST(Hub, LimitsHowManyAreConnected) {
  World world;
  std::vector<std::shared_ptr<Peer>> peers;
  int joined = 0;
  for (int i = 0; i < 100; ++i) {
    peers.push_back(std::make_shared<NoPeer>());
    joined += world.hub->join(peers.back(), {"d-" + std::to_string(i / 10), "x", Role::kObserver}).ok();
  }
  EXPECT_EQ(joined, 64);
  world.hub->leave(peers[0].get());
  EXPECT_THAT(world.hub->join(std::make_shared<NoPeer>(), {"d-9", "x", Role::kObserver}), test::IsOk());
}

}  // namespace
}  // namespace smokemap::server
