#pragma once

#include <gmock/gmock.h>

#include "core/result.hpp"

namespace smokemap::test {

MATCHER(IsOk, "is a value") {
  if (arg.ok()) return true;
  *result_listener << "fails with " << to_string(arg.error().code) << ": " << arg.error().message;
  return false;
}

MATCHER_P(Fails, code, std::string("fails with ") + to_string(code)) {
  if (!arg.ok() && arg.error().code == code) return true;
  *result_listener << (arg.ok() ? "is a value" : std::string("fails with ") + to_string(arg.error().code));
  return false;
}

}  // namespace smokemap::test
