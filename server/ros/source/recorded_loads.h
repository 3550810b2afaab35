/// What the joint loads of a bag were computed with when it was recorded: loads that are computed
/// from its motion have the options of today. One thread.
#pragma once

#include <kinescope/JointLoadArray.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/ros/source/bag_reader.h"

namespace kinescope::ros_bridge {

class RecordedLoads {
 public:
  static bool IsOne(const BagConnection& connection);

  /// Ignores what cannot be read. @pre IsOne(*message.connection)
  void Take(const BagMessage& message);

  /// Of each topic that had a mass that was given, or something in the hands: "the joint loads of
  /// /right/kinescope/joint_loads were computed with a body mass of 80 to 95 kg and up to 5 kg in
  /// the right hand".
  std::vector<std::string> Texts() const;

 private:
  struct Seen {
    std::optional<std::pair<double, double>> mass_kg;  // the least and the most that was given
    std::array<double, 2> held_kg{};                   // the most; by urdf::Side
  };

  std::map<std::string, Seen> by_topic_;
  kinescope_ros::JointLoadArray message_;  // reused, keeps its memory
};

}  // namespace kinescope::ros_bridge
