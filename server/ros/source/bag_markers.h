/// The markers in a bag (visualization_msgs/Marker and MarkerArray, on any topic), as a list that
/// changes over time. Actions, lifetimes and frames are as in marker_input.h, by the times of the
/// bag. One thread.
#pragma once

#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "core/source.h"
#include "server/ros/force_frames.h"
#include "server/ros/marker_input.h"
#include "server/ros/source/bag_reader.h"

namespace kinescope::ros_bridge {

class BagMarkers {
 public:
  /// Whether its messages are markers.
  static bool IsMarkers(const BagConnection& connection);

  /// Takes a message of such a connection. What is not used is counted by reason: the markers that
  /// Kinescope itself published, which a scene draws by itself, in `ignored`. @pre IsMarkers()
  void Take(const BagMessage& message, SourceCounters& counters);
  /// Remembers frames; before the first marker the static ones alone.
  void AddTransforms(const tf2_msgs::TFMessage& message, bool is_static);
  /// Delivers the list to `sink` if it has changed at `now_nanos` (of the bag). `world`: the frame
  /// of the scene. Warns once of each frame that is not there.
  void Update(std::int64_t now_nanos, const std::string& world, const std::string& bag,
              SampleSink& sink);

 private:
  const char* Decode(const BagMessage& message);

  bool has_markers_ = false;
  MarkerStore store_;
  TfTree tf_;
  std::map<std::string, std::size_t> topics_;  // their numbers
  std::set<std::string> lost_frames_;          // that were warned of
  visualization_msgs::Marker marker_;
  visualization_msgs::MarkerArray array_;
};

}  // namespace kinescope::ros_bridge
