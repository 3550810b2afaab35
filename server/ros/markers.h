/// Converts PersonState to visualization_msgs/MarkerArray: the elements that RViz shows beside the
/// robot. Pure: no node, no clock; any thread. Colours and sizes are those of palette.h, so that a
/// load has the same colour in pictures and in RViz. Reference frame, metres.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// Least lifetime of a marker that is not renewed, s: covers a second without samples of one person
/// while others still move.
inline constexpr double kMarkerLifetime = 1.0;

/// Lifetime of markers of a stream with a sample every `period_secs`: more than two of them.
double MarkerLifetime(double period_secs);

// m
inline constexpr double kCopThickness = 0.01;

enum class MarkerFrames {
  kReference,  // all in the reference frame
  /// Loads, centre of mass and what hands hold in the frame of their link, and locked to it: RViz
  /// then moves them with the robot, which it renders from newer transforms than the markers.
  /// Requires Kinescope's TF.
  kLinks,
};

/// ns "loads": one sphere per scored joint, id = urdf::Joint; grey if the load is unknown. ns
/// "com": a sphere, id 0; "hand_loads": the hand loads as solids. Always in the reference frame: ns
/// "cop": a disc on the floor, id 0; "support": the border of the support polygon, id 0;
/// "foot_forces": one arrow per foot (kMetresPerNewton), id = urdf::Side. Absent and unknown
/// values have no marker; those that `message` had, the last one of this person, are deleted.
void FillMarkers(const PersonState& person, const PersonNames& names,
                 const std::string& reference_frame, MarkerFrames frames, double floor_z,
                 visualization_msgs::MarkerArray& message, double lifetime_secs = kMarkerLifetime);

/// Turns the markers last sent into those of a stream that stopped: grey, with the size of unknown
/// loads, and without lifetime. The centre of pressure and the arrows are removed, because forces
/// are unknown now.
void MakeStale(const PersonModel& model, visualization_msgs::MarkerArray& message);

/// Turns the markers last sent into their deletions.
void MakeDeleted(visualization_msgs::MarkerArray& message);

/// Whether a marker of this namespace on this topic is one of these, of whatever Kinescope.
bool IsOwnMarker(const std::string& topic, const std::string& ns);

}  // namespace kinescope::ros_bridge
