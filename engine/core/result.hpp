#pragma once

#include <string>
#include <utility>
#include <variant>

#include "core/expect.hpp"

namespace smokemap {

/// Why bad data from outside has no answer. A closed set: callers switch over it.
enum class Errc {
  kInvalidArgument,  ///< a parameter or field out of range
  kDegenerate,       ///< well-formed, but there is no answer (no free cell, no wall, nothing matched)
  kCorrupt,          ///< bytes that do not keep their format's promises
  kUnsupported,      ///< a format or variant we do not read
  kTooLarge,         ///< over a stated limit
  kNotFound,         ///< names something that is not there
  kConflict,         ///< contradicts what is there already
  kForbidden,        ///< the role may not do this
  kIo,               ///< disk or network said no
  kCancelled,        ///< somebody asked to stop
  kNotConverged,     ///< a solver gave no usable answer
};

/// "kDegenerate" -> "degenerate": stable words for JSON and logs.
const char* to_string(Errc code);

struct Error {
  Errc code = Errc::kInvalidArgument;
  std::string message;  ///< one line, for people: says what, where and which value
};

struct Ok {};

/// A value or the reason why there is none. Ask before you take: `value()` of a failure aborts.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  const T& value() const& { return expect_value(), *std::get_if<0>(&state_); }
  T& value() & { return expect_value(), *std::get_if<0>(&state_); }
  T&& value() && { return expect_value(), std::move(*std::get_if<0>(&state_)); }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }
  const Error& error() const {
    ENGINE_EXPECT(!ok());
    return *std::get_if<1>(&state_);
  }

 private:
  void expect_value() const { ENGINE_EXPECT(ok()); }
  std::variant<T, Error> state_;
};

inline Error fail(Errc code, std::string message) { return Error{code, std::move(message)}; }

}  // namespace smokemap
