#pragma once

#include <dds/dds.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "core/result.hpp"

namespace smokemap {

/// One DDS thing, deleted with its owner. Declare children after their parent: members die in reverse order.
class DdsEntity {
 public:
  DdsEntity() = default;
  explicit DdsEntity(dds_entity_t handle) : handle_(handle) {}
  ~DdsEntity() { reset(); }
  DdsEntity(DdsEntity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  DdsEntity& operator=(DdsEntity&& other) noexcept {
    if (this != &other) reset(), handle_ = std::exchange(other.handle_, 0);
    return *this;
  }

  dds_entity_t get() const { return handle_; }
  explicit operator bool() const { return handle_ > 0; }
  /// Why creation failed, e.g. "Out of resources".
  std::string why() const { return dds_strretcode(-handle_); }

 private:
  void reset() {
    if (handle_ > 0) dds_delete(handle_);
    handle_ = 0;
  }
  dds_entity_t handle_ = 0;
};

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using DdsQos = std::unique_ptr<dds_qos_t, DeleteQos>;

/// Takes samples of a C type and gives each valid one to `use(const T&, const dds_sample_info_t&)`; the loan goes back
/// on every path. Without `use_invalid` samples that only tell of a change of state are passed over.
template <typename T, typename Use>
void take_all(dds_entity_t reader, Use&& use, bool use_invalid = false) {
  constexpr std::size_t kBatch = 16;
  for (;;) {
    std::array<void*, kBatch> samples{};
    std::array<dds_sample_info_t, kBatch> infos;
    const dds_return_t taken = dds_take(reader, samples.data(), infos.data(), kBatch, kBatch);
    if (taken <= 0) return;
    struct Loan {
      dds_entity_t reader;
      void** samples;
      dds_return_t count;
      ~Loan() { (void)dds_return_loan(reader, samples, count); }
    } const loan{reader, samples.data(), taken};
    for (std::size_t i = 0; i < static_cast<std::size_t>(taken); ++i)
      if (infos[i].valid_data || use_invalid) use(*static_cast<const T*>(samples[i]), infos[i]);
  }
}

}  // namespace smokemap
