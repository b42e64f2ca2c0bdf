#include "core/random.hpp"

#include <cmath>
#include <numbers>

#include "core/expect.hpp"

namespace smokemap {
namespace {

std::uint64_t mix(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

double uniform01(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

double uniform(std::mt19937_64& random, double low, double high) { return low + (high - low) * uniform01(random); }

std::uint64_t uniform_index(std::mt19937_64& random, std::uint64_t count) {
  ENGINE_EXPECT(count > 0);
  const std::uint64_t limit = count * (~std::uint64_t{0} / count);  // reject the uneven tail
  std::uint64_t draw = random();
  while (draw >= limit) draw = random();
  return draw % count;
}

double normal(std::mt19937_64& random, double sigma) {  // Box-Muller, one of the pair
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform01(random)));
  return sigma * radius * std::cos(2.0 * std::numbers::pi * uniform01(random));
}

double exponential(std::mt19937_64& random) { return -std::log(1.0 - uniform01(random)); }

std::mt19937_64 random_stream(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return std::mt19937_64(mix(mix(mix(mix(seed) ^ a) ^ b) ^ c));
}

}  // namespace smokemap
