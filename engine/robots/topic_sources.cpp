#include "robots/topic_sources.hpp"

namespace smokemap {

bool TopicSources::hears(const std::string& topic, const DdsGuid& participant, Stamp now, const TopicTable& table) {
  Source& source = sources_.try_emplace(topic, Source{participant, now}).first->second;
  if (source.participant != participant) {
    const bool is_silent = to_seconds(now - source.last_heard) > silent_after_s_;
    if (!is_silent && table.writes(source.participant, topic)) return false;
    source.participant = participant;
  }
  source.last_heard = now;
  return true;
}

}  // namespace smokemap
