#pragma once

#include <map>
#include <string>

#include "core/time.hpp"
#include "robots/topic_table.hpp"

namespace smokemap {

/// Who is listened to on each topic of a robot. Two sources are never mixed: two robots with the same name would put
/// one robot's walls at the other one's place. The first is listened to as long as it says something; another takes its
/// place once the first is silent or gone, which most likely is the same robot, restarted.
class TopicSources {
 public:
  explicit TopicSources(double silent_after_s) : silent_after_s_(silent_after_s) {}

  /// Is a message of this participant on this topic, come at `now`, to be listened to? `table`: who is on the network.
  bool hears(const std::string& topic, const DdsGuid& participant, Stamp now, const TopicTable& table);

 private:
  struct Source {
    DdsGuid participant{};
    Stamp last_heard = 0;
  };
  double silent_after_s_;
  std::map<std::string, Source> sources_;  ///< by topic
};

}  // namespace smokemap
