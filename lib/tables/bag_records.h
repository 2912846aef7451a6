// Bags of ROS 1 as what was recorded, topic by topic.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hapsim {

struct BagMessage {
  std::int64_t received = 0;  // [ns] since 1970, by the clock of who recorded it
  std::string_view body;      // serialised; of the bag's bytes, with which it lives
};

struct BagTopic {
  std::string topic, type;  // "/wrench", "geometry_msgs/WrenchStamped"
  std::vector<BagMessage> messages;
};

// Whether bytes begin as those of a bag of any version do.
bool is_bag(std::string_view bytes);

// The topics of a bag of format 2.0, in the order in which it names them; those of one name by
// several publishers are one. Source: wiki.ros.org/Bags/Format/2.0. Read from start to end, so that
// the index is not needed, but counts must agree with it. Error(kBadInput) at `name`: another
// version, compressed chunks or an encrypted bag (with the command of ROS that mends it), a bag
// that was not closed or is cut off, lengths that do not fit, a topic of two types.
std::vector<BagTopic> read_bag(std::string_view bytes, const std::string& name);

}  // namespace hapsim
