#include "core/check.hpp"

#include <sstream>

namespace smokemap {

ParamCheck& ParamCheck::in_range(const char* field, double value, double low, double high) {
  if (!(value >= low && value <= high)) {  // also catches NaN
    std::ostringstream what;
    what << "is " << value << ", must be within [" << low << ", " << high << "]";
    complain(field, what.str());
  }
  return *this;
}

ParamCheck& ParamCheck::positive(const char* field, double value) {
  if (!(value > 0 && std::isfinite(value))) {
    std::ostringstream what;
    what << "is " << value << ", must be positive";
    complain(field, what.str());
  }
  return *this;
}

ParamCheck& ParamCheck::require(const char* field, bool holds, const char* what) {
  if (!holds) complain(field, what);
  return *this;
}

Result<Ok> ParamCheck::result() const {
  if (complaint_.empty()) return Ok{};
  return fail(Errc::kInvalidArgument, complaint_);
}

void ParamCheck::complain(const char* field, const std::string& what) {
  if (complaint_.empty()) complaint_ = owner_ + "." + field + " " + what;
}

}  // namespace smokemap
