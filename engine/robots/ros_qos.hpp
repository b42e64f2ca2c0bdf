#pragma once

#include <cstdint>

#include "robots/dds_entity.hpp"

namespace smokemap {

/// Quality of service as ROS 2 has it, by purpose. Deadline and liveliness stay infinite, see link.hpp.
DdsQos sensor_qos();            ///< best effort, last 5: fits every writer
DdsQos state_qos(int depth);    ///< reliable, volatile
DdsQos latched_qos(int depth);  ///< reliable, transient local: late joiners get the last ones

/// What a writer offers, as far as a reader must fit it.
struct OfferedQos {
  bool reliable = false;
  bool transient_local = false;
};
OfferedQos offered(const dds_qos_t* qos);

/// The strongest reader that such a writer matches.
DdsQos reader_qos_for(const OfferedQos& offer, int depth);

/// "durability", "reliability", ...: for telling people why a reader and a writer do not fit.
const char* policy_name(std::uint32_t policy_id);

}  // namespace smokemap
