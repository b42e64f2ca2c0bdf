#pragma once

#include <cstdint>
#include <random>

namespace smokemap {

/// Draws that give the same numbers with every standard library (the distributions of <random> do not).

/// Uniform in [0, 1).
double uniform01(std::mt19937_64& random);
/// Uniform in [low, high).
double uniform(std::mt19937_64& random, double low, double high);
/// Uniform over 0 .. count-1; count > 0.
std::uint64_t uniform_index(std::mt19937_64& random, std::uint64_t count);
/// Normal, mean 0, the given standard deviation.
double normal(std::mt19937_64& random, double sigma);
/// Exponential with mean 1.
double exponential(std::mt19937_64& random);

/// A generator of its own for each (seed, a, b, c), so that adding a robot or sensor does not change another's noise.
std::mt19937_64 random_stream(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0);

}  // namespace smokemap
