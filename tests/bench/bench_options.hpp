#pragma once

#include <memory>
#include <string>

namespace smokemap::bench {

/// The command line of a benchmark. `read` prints help and leaves when it is asked for (status 0) or when a word is not
/// understood (status 2): a run of an hour is no answer to `--help`.
class BenchOptions {
 public:
  /// @param about  what is measured, in a line or two
  explicit BenchOptions(const std::string& about);
  ~BenchOptions();

  BenchOptions& flag(const std::string& name, bool& value, const std::string& about);
  BenchOptions& number(const std::string& name, int& value, const std::string& about);
  BenchOptions& text(const std::string& name, std::string& value, const std::string& about);
  void read(int argc, char** argv);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// For benchmarks whose only option is the number of seeds.
int seeds_option(int argc, char** argv, int otherwise, const std::string& about);

}  // namespace smokemap::bench
