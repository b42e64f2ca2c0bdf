#include "recording/limited_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>

namespace smokemap {
namespace {

enum ChildExit { kDone = 0, kThrew = 3 };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;  // sanitizers reserve terabytes of addresses
#else
constexpr bool kLimitsMemory = true;
#endif

std::size_t address_space_in_use() {
  std::size_t pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(statm, "%zu", &pages) != 1) pages = 0;
    std::fclose(statm);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void set_limit(__rlimit_resource resource, std::size_t value) {
  const rlimit limit{value, value};
  (void)setrlimit(resource, &limit);
}

/// Ends this process by SIGPROF. Whole seconds of RLIMIT_CPU stand behind, should somebody block the signal.
void limit_processor_time(double seconds) {
  sigset_t prof;
  sigemptyset(&prof);
  sigaddset(&prof, SIGPROF);
  (void)sigprocmask(SIG_UNBLOCK, &prof, nullptr);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - std::floor(seconds)));
  (void)setitimer(ITIMER_PROF, &timer, nullptr);
  set_limit(RLIMIT_CPU, static_cast<std::size_t>(std::ceil(seconds)) + 1);
}

[[noreturn]] void child(const ChildLimits& limits, std::size_t bytes_in_use, const std::function<void()>& work) {
  for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGPROF})
    std::signal(signal, SIG_DFL);
  (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) (void)dup2(nowhere, stream);
  (void)close_range(3, ~0U, 0);  // sockets of the server among them
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, 0);
  limit_processor_time(limits.processor_s);
  if (kLimitsMemory) set_limit(RLIMIT_AS, bytes_in_use + limits.bytes);
  try {
    work();
  } catch (...) {
    _exit(kThrew);
  }
  _exit(kDone);
}

struct Ended {
  int status = 0;
  bool in_time = true;
  double processor_s = 0;
};

/// Waits on the process itself where the kernel has descriptors for that, else looks again every few milliseconds.
Ended wait_for(pid_t pid, double seconds) {
  using Steady = std::chrono::steady_clock;
  constexpr int kLookAgainMs = 5;
  const auto deadline = Steady::now() + std::chrono::duration<double>(seconds);
  const int watched = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  Ended ended;
  rusage used{};
  while (wait4(pid, &ended.status, ended.in_time ? WNOHANG : 0, &used) != pid) {
    const double left_s = std::chrono::duration<double>(deadline - Steady::now()).count();
    if (left_s <= 0) {
      ended.in_time = false;
      (void)kill(pid, SIGKILL);
      continue;
    }
    pollfd event{watched, POLLIN, 0};
    (void)poll(&event, 1, watched >= 0 ? static_cast<int>(std::ceil(left_s * 1000)) : kLookAgainMs);
  }
  if (watched >= 0) (void)close(watched);
  ended.processor_s = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                      1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  return ended;
}

}  // namespace

SharedMemory::SharedMemory(std::size_t size) {
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return;
  data_ = static_cast<std::uint8_t*>(memory);
  size_ = size;
}

SharedMemory::~SharedMemory() {
  if (data_) munmap(data_, size_);
}

Result<Ok> run_in_limited_child(const ChildLimits& limits, const std::function<void()>& work) {
  constexpr double kNeverStartedSeconds = 0.05;
  const std::size_t bytes_in_use = address_space_in_use();
  for (int attempt = 0;; ++attempt) {
    const pid_t pid = fork();
    if (pid < 0) return fail(Errc::kIo, "no process to be had");
    if (pid == 0) child(limits, bytes_in_use, work);
    const Ended ended = wait_for(pid, limits.seconds);
    if (!ended.in_time && ended.processor_s < kNeverStartedSeconds && attempt == 0) continue;
    const int signal = WIFSIGNALED(ended.status) ? WTERMSIG(ended.status) : 0;
    if (!ended.in_time || signal == SIGPROF || signal == SIGXCPU)
      return fail(Errc::kTooLarge, "took longer than it may");
    if (WIFSIGNALED(ended.status)) return fail(Errc::kCorrupt, "broke the program that reads it");
    if (WEXITSTATUS(ended.status) == kThrew)
      return fail(Errc::kCorrupt, "cannot be read, or needs more memory than it may");
    return Ok{};
  }
}

}  // namespace smokemap
