#pragma once

#include <cmath>
#include <string>

#include "core/result.hpp"

namespace smokemap {

/// Collects the first field of a parameter struct that is out of range; the body of every `validate()`.
///   return ParamCheck("SlamParams").in_range("cell_m", cell_m, 0.01, 1.0).positive("gate_m", gate_m).result();
class ParamCheck {
 public:
  explicit ParamCheck(std::string owner) : owner_(std::move(owner)) {}
  ParamCheck& in_range(const char* field, double value, double low, double high);
  ParamCheck& positive(const char* field, double value);
  ParamCheck& require(const char* field, bool holds, const char* what);
  Result<Ok> result() const;

 private:
  void complain(const char* field, const std::string& what);
  std::string owner_;
  std::string complaint_;
};

}  // namespace smokemap
