#include "recording/ros_definitions.hpp"

#include <map>
#include <string_view>
#include <vector>

#include "core/expect.hpp"

namespace smokemap {
namespace {

struct Definition {
  std::string_view fields;
  std::vector<std::string_view> made_of;  ///< all of them, the nested too
};

const std::map<std::string_view, Definition>& definitions() {
  static const std::map<std::string_view, Definition> kDefinitions{
      {"builtin_interfaces/Time", {"int32 sec\nuint32 nanosec\n", {}}},
      {"std_msgs/Header", {"builtin_interfaces/Time stamp\nstring frame_id\n", {}}},
      {"geometry_msgs/Vector3", {"float64 x\nfloat64 y\nfloat64 z\n", {}}},
      {"geometry_msgs/Point", {"float64 x\nfloat64 y\nfloat64 z\n", {}}},
      {"geometry_msgs/Quaternion", {"float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", {}}},
      {"geometry_msgs/Pose", {"geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n", {}}},
      {"geometry_msgs/PoseWithCovariance", {"geometry_msgs/Pose pose\nfloat64[36] covariance\n", {}}},
      {"geometry_msgs/Twist", {"geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n", {}}},
      {"geometry_msgs/TwistWithCovariance", {"geometry_msgs/Twist twist\nfloat64[36] covariance\n", {}}},
      {"geometry_msgs/Transform", {"geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n", {}}},
      {"geometry_msgs/TransformStamped",
       {"std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n", {}}},
      {"sensor_msgs/msg/LaserScan",
       {"std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 "
        "time_increment\n"
        "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n",
        {"std_msgs/Header", "builtin_interfaces/Time"}}},
      {"sensor_msgs/msg/Image",
       {"std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 "
        "step\nuint8[] data\n",
        {"std_msgs/Header", "builtin_interfaces/Time"}}},
      {"nav_msgs/msg/Odometry",
       {"std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist\n",
        {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose",
         "geometry_msgs/Point", "geometry_msgs/Quaternion", "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist",
         "geometry_msgs/Vector3"}}},
      {"geometry_msgs/msg/PoseStamped",
       {"std_msgs/Header header\ngeometry_msgs/Pose pose\n",
        {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Pose", "geometry_msgs/Point",
         "geometry_msgs/Quaternion"}}},
      {"std_msgs/msg/String", {"string data\n", {}}},
      {"tf2_msgs/msg/TFMessage",
       {"geometry_msgs/TransformStamped[] transforms\n",
        {"geometry_msgs/TransformStamped", "std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Transform",
         "geometry_msgs/Vector3", "geometry_msgs/Quaternion"}}},
  };
  return kDefinitions;
}

}  // namespace

std::string ros_definition(const std::string& type) {
  const auto found = definitions().find(type);
  ENGINE_EXPECT(found != definitions().end());
  std::string text(found->second.fields);
  for (const std::string_view part : found->second.made_of) {
    text.append(80, '=').append("\nMSG: ").append(part).append("\n").append(definitions().at(part).fields);
  }
  return text;
}

}  // namespace smokemap
