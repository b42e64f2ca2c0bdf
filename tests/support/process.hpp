#pragma once

// A program as a person starts it: arguments in, exit status and text out. No shell in between.

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/eventually.hpp"

namespace smokemap::test {

/// A running program with its output at hand. Ends with its owner: a test that fails leaves nothing behind.
class Process {
 public:
  Process(const std::string& program, std::vector<std::string> arguments, const std::string& folder = ".") {
    int out[2], err[2];
    if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    arguments.insert(arguments.begin(), program);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    if (::posix_spawn(&pid_, program.c_str(), &actions, nullptr, words.data(), environ) != 0) pid_ = 0;
    posix_spawn_file_actions_destroy(&actions);
    ::close(out[1]);
    ::close(err[1]);
    streams_ = {Stream{out[0], {}}, Stream{err[0], {}}};
  }
  ~Process() {
    if (!status_) send(SIGKILL);
    if (!status_ && pid_ > 0) ::waitpid(pid_, nullptr, 0);
    for (const Stream& stream : streams_)
      if (stream.fd >= 0) ::close(stream.fd);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const {
    if (pid_ > 0) ::kill(pid_, signal);
  }
  /// Waits until the output holds `text`, where `after` is given behind that; false when the program ends or patience
  /// does.
  bool says(const std::string& text, const std::string& after = {}) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    const auto said = [&] {
      const std::size_t from = streams_[0].text.find(after);
      return from != std::string::npos && streams_[0].text.find(text, from + after.size()) != std::string::npos;
    };
    while (!said())
      if (!pump(deadline)) return said();
    return true;
  }
  /// The exit status; 128 + signal when one ended it, -1 when it does not end (then it is killed).
  int wait() {
    const auto deadline = std::chrono::steady_clock::now() + 3 * kPatience;
    while (pump(deadline)) {
    }
    if (status_) return *status_;
    if (pid_ <= 0 || std::chrono::steady_clock::now() > deadline) return -1;
    int status = 0;
    ::waitpid(pid_, &status, 0);
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return *status_;
  }
  const std::string& output() const { return streams_[0].text; }
  const std::string& errors() const { return streams_[1].text; }

 private:
  struct Stream {
    int fd = -1;
    std::string text;
  };
  /// Takes what comes on either stream; false when both have ended, or at the deadline.
  bool pump(std::chrono::steady_clock::time_point deadline) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    std::array<pollfd, 2> waits{pollfd{streams_[0].fd, POLLIN, 0}, pollfd{streams_[1].fd, POLLIN, 0}};
    if (left <= 0 || (waits[0].fd < 0 && waits[1].fd < 0)) return false;
    if (::poll(waits.data(), waits.size(), static_cast<int>(left)) <= 0) return false;
    for (std::size_t i = 0; i < waits.size(); ++i) {
      if (waits[i].revents == 0) continue;
      std::array<char, 4096> bytes;
      const ssize_t n = ::read(streams_[i].fd, bytes.data(), bytes.size());
      if (n > 0) {
        streams_[i].text.append(bytes.data(), static_cast<std::size_t>(n));
      } else {
        ::close(streams_[i].fd);
        streams_[i].fd = -1;
      }
    }
    return true;
  }

  pid_t pid_ = 0;
  std::optional<int> status_;
  std::array<Stream, 2> streams_;
};

/// What a program left behind.
struct Ran {
  int status = -1;
  std::string output, errors;
};
inline Ran run_program(const std::string& program, const std::vector<std::string>& arguments,
                       const std::string& folder = ".") {
  Process process(program, arguments, folder);
  const int status = process.wait();
  return {status, process.output(), process.errors()};
}

}  // namespace smokemap::test
