#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "core/time.hpp"
#include "server/wire/role.hpp"

namespace smokemap::server {

/// Bits from the operating system's generator as hexadecimal digits.
std::string random_hex(int bytes);
/// Six decimal digits, evenly drawn.
std::string random_pin();

struct PairingParams {
  int tries = 5;  ///< wrong PINs before everybody waits
  Stamp lock = from_seconds(60);
  bool loopback_without_pin = false;  ///< the demo
  std::string pin;                    ///< empty = drawn at the start
  std::size_t most_devices = 200;
  Stamp idle = from_seconds(24 * 3600);  ///< a device not seen for so long may be forgotten for a new one
};

/// A device as it is kept: never the token, only its hash.
struct PairedDevice {
  Identity who;
  std::string token_hash;
  std::int64_t created_ms = 0;
  bool revoked = false;
};

struct PairRequest {
  std::optional<std::string> pin;
  std::string name;
  Role role = Role::kObserver;
  bool from_loopback = false;
};
struct Paired {
  Identity who;
  std::string token;  ///< 128 bits; shown to the device once
};

/// Who is known: pairing by PIN, tokens, roles. Thread-safe.
class Access {
 public:
  using Save = std::function<Result<Ok>(const PairedDevice&)>;

  /// @param save  must have kept the device when it returns; otherwise nobody is paired
  Access(const PairingParams& params, std::shared_ptr<const Clock> clock, Save save);

  void restore(const PairedDevice& device);

  /// kForbidden: wrong PIN. kConflict: locked after too many wrong ones. kInvalidArgument: no usable name. kTooLarge:
  /// there are `most_devices`, and all were seen lately; else the one that was away longest has to pair again.
  Result<Paired> pair(const PairRequest& request);
  /// Who holds this token; nothing for a wrong or revoked one.
  std::optional<Identity> identify(std::string_view token) const;
  const std::string& pin() const { return pin_; }

 private:
  struct Known {
    PairedDevice device;
    Stamp last_seen = 0;
  };
  Result<Ok> check_pin(const PairRequest& request);
  Result<Ok> make_room();
  PairingParams params_;
  std::shared_ptr<const Clock> clock_;
  Save save_;
  std::string pin_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, Known, std::less<>> by_token_hash_;  // who asks is seen
  int wrong_ = 0;
  Stamp locked_until_ = 0;
};

}  // namespace smokemap::server
