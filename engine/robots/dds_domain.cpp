#include "robots/dds_domain.hpp"

#include <cstdlib>
#include <map>
#include <mutex>

namespace smokemap {
namespace {

constexpr const char* kLoopbackOnly =
    "<General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces><AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60</MaxAutoParticipantIndex>"
    "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>"
    "<Tracing><Verbosity>severe</Verbosity></Tracing>";

constexpr int kHighestDomain = 230;  // above, ports of the 61st participant would pass 65535

}  // namespace

Result<std::shared_ptr<DdsDomain>> DdsDomain::open(int id) {
  static std::mutex mutex;
  static std::map<int, std::weak_ptr<DdsDomain>> open_domains;
  if (id < 0 || id > kHighestDomain)
    return fail(Errc::kInvalidArgument, "DDS domain " + std::to_string(id) + " is not within 0..230");
  const std::lock_guard lock(mutex);
  if (auto known = open_domains[id].lock()) return known;
  std::shared_ptr<DdsDomain> domain(new DdsDomain(id));
  if (const char* uri = std::getenv("CYCLONEDDS_URI"); !uri || !*uri) {
    domain->domain_ = DdsEntity(dds_create_domain(static_cast<dds_domainid_t>(id), kLoopbackOnly));
    // Somebody else in this process may have opened it: then their configuration holds.
    if (!domain->domain_ && domain->domain_.get() != DDS_RETCODE_PRECONDITION_NOT_MET)
      return fail(Errc::kIo, "DDS domain " + std::to_string(id) + " does not open: " + domain->domain_.why());
  }
  open_domains[id] = domain;
  return domain;
}

Result<DdsEntity> DdsDomain::participant() const {
  DdsEntity participant(dds_create_participant(static_cast<dds_domainid_t>(id_), nullptr, nullptr));
  if (participant) return participant;
  return fail(Errc::kIo, "no DDS participant in domain " + std::to_string(id_) + ": " + participant.why() +
                             " (interface absent, or all participant indices taken: raise MaxAutoParticipantIndex)");
}

}  // namespace smokemap
