#include "core/time.hpp"

#include <chrono>

namespace smokemap {

Stamp SystemClock::now() const {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace smokemap
