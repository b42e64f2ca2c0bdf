#pragma once

#include <string>

namespace smokemap {

/// The definition of a message as ros2msg, with all it is made of, so that other tools can read our recordings without
/// ROS. One of the types of ros_messages.hpp.
std::string ros_definition(const std::string& type);

}  // namespace smokemap
