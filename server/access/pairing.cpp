#include "server/access/pairing.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/text.hpp"

namespace smokemap::server {
namespace {

std::string hex(const unsigned char* bytes, std::size_t count) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 15];
  }
  return text;
}

/// Tokens carry 128 random bits, so a plain hash is enough: there is nothing to guess.
std::string token_hash(std::string_view token) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  ENGINE_EXPECT(EVP_Digest(token.data(), token.size(), digest.data(), &size, EVP_sha256(), nullptr) == 1);
  return hex(digest.data(), size);
}

bool same_in_constant_time(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

bool usable_name(const std::string& name) {
  if (name.empty() || characters(name) > 40) return false;
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 32 || c == 127) return false;
  return true;
}

}  // namespace

std::string random_hex(int bytes) {
  std::vector<unsigned char> random(static_cast<std::size_t>(bytes));
  ENGINE_EXPECT(RAND_bytes(random.data(), bytes) == 1);
  return hex(random.data(), random.size());
}

std::string random_pin() {
  constexpr std::uint32_t kPins = 1'000'000, kEven = 0xffffffffu - 0xffffffffu % kPins;
  std::uint32_t draw = 0;
  do {
    ENGINE_EXPECT(RAND_bytes(reinterpret_cast<unsigned char*>(&draw), sizeof draw) == 1);
  } while (draw >= kEven);
  std::string pin = std::to_string(draw % kPins);
  return std::string(6 - pin.size(), '0') + pin;
}

Access::Access(const PairingParams& params, std::shared_ptr<const Clock> clock, Save save)
    : params_(params),
      clock_(std::move(clock)),
      save_(std::move(save)),
      pin_(params.pin.empty() ? random_pin() : params.pin) {}

void Access::restore(const PairedDevice& device) {
  const std::lock_guard lock(mutex_);
  if (device.revoked)
    by_token_hash_.erase(device.token_hash);
  else
    by_token_hash_[device.token_hash] = {device, device.created_ms * 1'000'000};
}

Result<Ok> Access::make_room() {
  if (by_token_hash_.size() < params_.most_devices) return Ok{};
  const auto longest_away =
      std::min_element(by_token_hash_.begin(), by_token_hash_.end(),
                       [](const auto& a, const auto& b) { return a.second.last_seen < b.second.last_seen; });
  if (longest_away == by_token_hash_.end() || clock_->now() - longest_away->second.last_seen < params_.idle)
    return fail(Errc::kTooLarge, "no more than " + std::to_string(params_.most_devices) + " devices can be paired");
  PairedDevice gone = longest_away->second.device;
  gone.revoked = true;
  if (auto saved = save_(gone); !saved) return saved.error();
  by_token_hash_.erase(longest_away);
  return Ok{};
}

Result<Ok> Access::check_pin(const PairRequest& request) {
  if (!request.pin && request.from_loopback && params_.loopback_without_pin) return Ok{};
  const Stamp now = clock_->now();
  if (now < locked_until_)
    return fail(Errc::kConflict, "too many wrong PINs; try again in " +
                                     std::to_string(static_cast<int>(to_seconds(locked_until_ - now)) + 1) + " s");
  if (request.pin && same_in_constant_time(*request.pin, pin_)) {
    wrong_ = 0;
    return Ok{};
  }
  if (!request.pin) return fail(Errc::kForbidden, "the PIN that the server's console shows is needed");
  if (++wrong_ >= params_.tries) {
    wrong_ = 0;
    locked_until_ = now + params_.lock;
  }
  return fail(Errc::kForbidden, "this is not the PIN that the server's console shows");
}

Result<Paired> Access::pair(const PairRequest& request) {
  const std::lock_guard lock(mutex_);
  if (!usable_name(request.name)) return fail(Errc::kInvalidArgument, "a name of 1 to 40 characters is needed");
  if (auto right = check_pin(request); !right) return right.error();
  if (auto room = make_room(); !room) return room.error();
  Paired paired{{"d-" + random_hex(8), request.name, request.role}, random_hex(16)};
  const PairedDevice device{paired.who, token_hash(paired.token), clock_->now() / 1'000'000, false};
  if (auto saved = save_(device); !saved) return saved.error();
  by_token_hash_[device.token_hash] = {device, clock_->now()};
  return paired;
}

std::optional<Identity> Access::identify(std::string_view token) const {
  const std::lock_guard lock(mutex_);
  const auto it = by_token_hash_.find(token_hash(token));
  if (it == by_token_hash_.end()) return std::nullopt;
  it->second.last_seen = clock_->now();
  return it->second.device.who;
}

}  // namespace smokemap::server
