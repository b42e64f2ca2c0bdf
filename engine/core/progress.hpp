#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace smokemap {

/// How long work speaks with whoever waits for it. Both parts are optional.
struct Progress {
  std::function<void(double fraction, std::string_view stage)> report;  ///< called from the worker's thread
  std::stop_token stop;                                                 ///< asked for at every round

  void tell(double fraction, std::string_view stage) const {
    if (report) report(fraction, stage);
  }
  bool cancelled() const { return stop.stop_requested(); }
};

}  // namespace smokemap
