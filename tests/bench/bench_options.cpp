#include "tests/bench/bench_options.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>

namespace smokemap::bench {
namespace {

constexpr int kUsage = 2;

}  // namespace

class BenchOptions::Impl {
 public:
  explicit Impl(const std::string& about) : app(about) {}
  CLI::App app;
};

BenchOptions::BenchOptions(const std::string& about) : impl_(std::make_unique<Impl>(about)) {}
BenchOptions::~BenchOptions() = default;

BenchOptions& BenchOptions::flag(const std::string& name, bool& value, const std::string& about) {
  impl_->app.add_flag(name, value, about);
  return *this;
}

BenchOptions& BenchOptions::number(const std::string& name, int& value, const std::string& about) {
  impl_->app.add_option(name, value, about)->capture_default_str();
  return *this;
}

BenchOptions& BenchOptions::text(const std::string& name, std::string& value, const std::string& about) {
  impl_->app.add_option(name, value, about)->capture_default_str();
  return *this;
}

void BenchOptions::read(int argc, char** argv) {
  try {
    impl_->app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = impl_->app.exit(error);
    std::exit(status == 0 ? 0 : kUsage);
  }
}

int seeds_option(int argc, char** argv, int otherwise, const std::string& about) {
  BenchOptions options(about);
  options.number("--seeds", otherwise, "seeds 1 to this").read(argc, argv);
  return otherwise;
}

}  // namespace smokemap::bench
