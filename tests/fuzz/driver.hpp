#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

/// Hands one input to the parser under test; returns 0. libFuzzer's own entry point, so that the same target links with
/// it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace smokemap::fuzz {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

/// Sound inputs to start from, made by the target's own code. Defined by every target.
std::vector<Bytes> seed_corpus();

/// One to eight small wounds: bits turned, lengths falsified, parts cut, doubled, exchanged with another sound input,
/// words of a text replaced by extreme ones. Never longer than `longest`.
Bytes mutate(const std::vector<Bytes>& corpus, std::mt19937_64& random, std::size_t longest = 1 << 20);

}  // namespace smokemap::fuzz
