#include "tests/fuzz/driver.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/random.hpp"

// A main() for fuzz targets where libFuzzer is not at hand: see README.md beside this file.

namespace smokemap::fuzz {
namespace {

constexpr unsigned kSecondsPerInput = 10;

const Bytes* current_input = nullptr;
char crash_file[256] = "crash.bin";

/// Keeps the input that killed the parser; only calls what a signal handler may.
void keep_input(int signal) {
  const int file = open(crash_file, O_CREAT | O_TRUNC | O_WRONLY, 0644);
  if (file >= 0 && current_input) {
    [[maybe_unused]] const auto written = write(file, current_input->data(), current_input->size());
    close(file);
  }
  const char* said = signal == SIGALRM ? "\ntoo slow; input kept in " : "\ncrashed; input kept in ";
  [[maybe_unused]] auto told = write(STDERR_FILENO, said, std::strlen(said));
  told = write(STDERR_FILENO, crash_file, std::strlen(crash_file));
  told = write(STDERR_FILENO, "\n", 1);
  _exit(77);
}

void watch(const char* target) {
  const char* name = std::strrchr(target, '/');
  std::snprintf(crash_file, sizeof crash_file, "%s.crash", name ? name + 1 : target);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGALRM}) std::signal(signal, keep_input);
}

void run_one(const Bytes& input) {
  current_input = &input;
  alarm(kSecondsPerInput);
  LLVMFuzzerTestOneInput(input.data(), input.size());
  alarm(0);
}

std::size_t place(const Bytes& bytes, std::mt19937_64& random) {
  return bytes.empty() ? 0 : static_cast<std::size_t>(uniform_index(random, bytes.size()));
}

void falsify_length(Bytes& bytes, std::mt19937_64& random) {
  constexpr std::array<std::uint64_t, 10> kLengths{
      0, 1, 0x7F, 0xFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7FFFFFFFFFFF, ~std::uint64_t{0}};
  const std::size_t width = std::size_t{1} << uniform_index(random, 4);
  if (bytes.size() < width) return;
  const std::uint64_t length = kLengths[uniform_index(random, kLengths.size())];
  std::memcpy(bytes.data() + uniform_index(random, bytes.size() - width + 1), &length, width);
}

void replace_word(Bytes& bytes, std::mt19937_64& random) {
  constexpr std::array<std::string_view, 14> kWords{
      "0", "-1",   "1e308", "-1e-308", "nan", "inf", "99999999999999999999",
      "",  "null", "[]",    "{}",      "\"",  "\n",  "\xC3\x28"};
  const auto is_word = [](std::uint8_t c) { return c > ' ' && c != ',' && c != '[' && c != ']'; };
  const auto begin =
      std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(place(bytes, random)), bytes.end(), is_word);
  const auto end = std::find_if_not(begin, bytes.end(), is_word);
  const std::string_view word = kWords[uniform_index(random, kWords.size())];
  const auto at = bytes.erase(begin, end);
  bytes.insert(at, word.begin(), word.end());
}

void wound(Bytes& bytes, const std::vector<Bytes>& corpus, std::mt19937_64& random) {
  const std::size_t at = place(bytes, random);
  const std::size_t length = std::min<std::size_t>(bytes.size() - at, 1 + uniform_index(random, 64));
  const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const auto last = first + static_cast<std::ptrdiff_t>(length);
  switch (uniform_index(random, 8)) {
    case 0:
      if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1u << uniform_index(random, 8));
      return;
    case 1:
      if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
      return;
    case 2:
      return falsify_length(bytes, random);
    case 3:
      bytes.resize(at);
      return;  // the end is missing
    case 4:
      bytes.erase(first, last);
      return;
    case 5: {
      const Bytes part(first, last);
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place(bytes, random)), part.begin(), part.end());
      return;
    }
    case 6:
      return replace_word(bytes, random);
    default: {
      const Bytes& other = corpus[uniform_index(random, corpus.size())];
      if (at < other.size())
        bytes.assign(bytes.begin(), first),
            bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(at), other.end());
      return;
    }
  }
}

}  // namespace

Bytes mutate(const std::vector<Bytes>& corpus, std::mt19937_64& random, std::size_t longest) {
  Bytes bytes = corpus[uniform_index(random, corpus.size())];
  const auto wounds = 1 + uniform_index(random, 8);
  for (std::uint64_t i = 0; i < wounds; ++i) wound(bytes, corpus, random);
  if (bytes.size() > longest) bytes.resize(longest);
  return bytes;
}

}  // namespace smokemap::fuzz

int main(int argc, char** argv) {
  using namespace smokemap;
  std::uint64_t runs = 10'000, seed = 1;
  std::vector<fuzz::Bytes> corpus = fuzz::seed_corpus();
  std::vector<fuzz::Bytes> given;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--runs" && i + 1 < argc) {
      runs = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--seed" && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else {
      std::ifstream file(argument, std::ios::binary);
      given.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  }
  fuzz::watch(argv[0]);
  corpus.insert(corpus.end(), given.begin(), given.end());
  corpus.emplace_back();
  for (const fuzz::Bytes& input : corpus) fuzz::run_one(input);
  const auto start = std::chrono::steady_clock::now();
  std::mt19937_64 random(seed);
  for (std::uint64_t run = 0; run < runs; ++run) fuzz::run_one(fuzz::mutate(corpus, random));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%llu inputs from %zu seeds, seed %llu: clean, %.0f a second\n", static_cast<unsigned long long>(runs),
              corpus.size(), static_cast<unsigned long long>(seed),
              static_cast<double>(runs) / std::max(seconds, 1e-9));
  return 0;
}
