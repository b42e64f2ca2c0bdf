#include "robots/ros_qos.hpp"

namespace smokemap {
namespace {

constexpr dds_duration_t kMostBlocking = DDS_MSECS(20);

DdsQos ros_qos(dds_reliability_kind_t reliability, dds_durability_kind_t durability, int depth) {
  DdsQos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), reliability, kMostBlocking);
  dds_qset_durability(qos.get(), durability);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  if (durability == DDS_DURABILITY_TRANSIENT_LOCAL)
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED);
  return qos;
}

}  // namespace

DdsQos sensor_qos() { return ros_qos(DDS_RELIABILITY_BEST_EFFORT, DDS_DURABILITY_VOLATILE, 5); }
DdsQos state_qos(int depth) { return ros_qos(DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_VOLATILE, depth); }
DdsQos latched_qos(int depth) { return ros_qos(DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL, depth); }

OfferedQos offered(const dds_qos_t* qos) {
  OfferedQos offer;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_duration_t blocking = 0;
  if (qos && dds_qget_reliability(qos, &reliability, &blocking))
    offer.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  if (qos && dds_qget_durability(qos, &durability)) offer.transient_local = durability != DDS_DURABILITY_VOLATILE;
  return offer;
}

DdsQos reader_qos_for(const OfferedQos& offer, int depth) {
  return ros_qos(offer.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                 offer.reliable && offer.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE,
                 depth);
}

const char* policy_name(std::uint32_t policy_id) {
  switch (policy_id) {
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "durability";
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case DDS_LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case DDS_RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case DDS_PARTITION_QOS_POLICY_ID:
      return "partition";
    default:
      return "quality of service";
  }
}

}  // namespace smokemap
