#include "core/result.hpp"

#include <cstdio>
#include <cstdlib>

namespace smokemap {

const char* to_string(Errc code) {
  switch (code) {
    case Errc::kInvalidArgument:
      return "invalid_argument";
    case Errc::kDegenerate:
      return "degenerate";
    case Errc::kCorrupt:
      return "corrupt";
    case Errc::kUnsupported:
      return "unsupported";
    case Errc::kTooLarge:
      return "too_large";
    case Errc::kNotFound:
      return "not_found";
    case Errc::kConflict:
      return "conflict";
    case Errc::kForbidden:
      return "forbidden";
    case Errc::kIo:
      return "io";
    case Errc::kCancelled:
      return "cancelled";
    case Errc::kNotConverged:
      return "not_converged";
  }
  broken_promise("a known Errc", __FILE__, __LINE__);
}

void broken_promise(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, condition);
  std::abort();
}

}  // namespace smokemap
