#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/time.hpp"
#include "server/store/store.hpp"
#include "server/wire/command_sink.hpp"
#include "server/wire/engine_port.hpp"
#include "server/wire/parts.hpp"

namespace smokemap::server {

/// What the server itself remembers of the commands that were carried out.
class ViewKeeper {
 public:
  /// @param data  the command's data as it came, for fields that the command does not carry
  /// @return true if the view changed
  bool note(const Command& command, const Json& data);
  const ServerView& view() const { return view_; }

 private:
  ServerView view_;
};

/// The one way in for what people do: role -> log -> engine -> answer, one after the other on a thread of its own.
///
/// A command is on the disk before the engine gets it and before it is acknowledged. The same id again gets the same
/// answer and changes nothing. An emergency stop overtakes everything that waits and reaches the engine before the
/// disk: a full disk must not keep a robot going.
class CommandBus final : public CommandSink {
 public:
  using ViewListener = std::function<void(const ServerView&)>;
  struct Limits {
    std::size_t most_waiting = 2000;
  };

  CommandBus(Store& store, EnginePort& engine, std::shared_ptr<const Clock> clock, ViewListener listener,
             Limits limits);
  ~CommandBus() override;
  CommandBus(const CommandBus&) = delete;
  CommandBus& operator=(const CommandBus&) = delete;

  /// Brings the engine to where the log ends; before `start`.
  Result<Ok> replay();
  void start();
  /// Answers what waits with "io" and joins the thread.
  void stop();

  void submit(const Identity& who, CommandMessage message, Reply reply) override;

 private:
  struct Job {  // NOLINT(bugprone-exception-escape): no move of it throws
    Identity who;
    CommandMessage message;
    Reply reply;
  };
  void run();
  CommandReply carry_out(const Job& asked);
  CommandReply stop_robots(const Job& job, const Command& command);
  std::optional<CommandReply> earlier_answer(const Job& job);
  CommandReply apply_stored(std::int64_t seq, const Job& job, const Command& command);

  Store& store_;
  EnginePort& engine_;
  std::shared_ptr<const Clock> clock_;
  ViewListener listener_;
  Limits limits_;
  ViewKeeper keeper_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> waiting_;
  bool stopping_ = false;
  std::thread thread_;
};

/// Applies events 1..`last` of the log to an engine (all of them without `last`). Refused ones, and those of another
/// version that cannot be read, are passed over. Used at the start and for looking back.
Result<ViewKeeper> replay_log(Store& store, EnginePort& engine, Origin origin, std::optional<std::int64_t> last = {});

}  // namespace smokemap::server
