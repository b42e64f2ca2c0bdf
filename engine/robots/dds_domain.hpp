#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"
#include "robots/dds_entity.hpp"

namespace smokemap {

/// Holds a DDS domain of this process open; the last holder closes it.
///
/// With CYCLONEDDS_URI in the environment, that alone decides about interfaces, peers and security. Without it the
/// domain speaks on loopback only, without multicast, to up to 61 participants of this machine: nothing leaves it by
/// accident.
class DdsDomain {
 public:
  /// kInvalidArgument outside 0..230; kIo when DDS refuses the configuration.
  static Result<std::shared_ptr<DdsDomain>> open(int id);

  /// kIo, e.g. when all participant indices are taken.
  Result<DdsEntity> participant() const;

 private:
  explicit DdsDomain(int id) : id_(id) {}
  int id_;
  DdsEntity domain_;
};

}  // namespace smokemap
