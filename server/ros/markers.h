/// PersonState -> visualization_msgs/MarkerArray: what RViz shows beside the robot. Pure: no node,
/// no clock. Colours and sizes are palette.h's, so that a sphere that is red in the picture is red
/// here.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// A marker that is not renewed goes away after this, s: a second of one person's silence while
/// others still move.
inline constexpr double kMarkerLifetime = 1.0;

// m
inline constexpr double kComRadius = 0.04;
inline constexpr double kCopRadius = 0.05;
inline constexpr double kCopThickness = 0.01;

enum class MarkerFrames {
  kReference,  // all in the reference frame
  /// Loads and centre of mass in the frame of their link, and locked to it: RViz then moves them
  /// with the robot, which it draws from newer transforms than the markers it has. Needs our TF.
  kLinks,
};

/// ns "loads": a sphere for each scored joint, id = urdf::Joint, its text the reason where the load
/// is not known. ns "com": a sphere, id 0. Always in the reference frame: ns "cop": a disc on the
/// floor, id 0; "support": the border of what the feet can push on, id 0; "foot_forces": an arrow
/// for each foot (kMetresPerNewton), id = urdf::Side; "held": what the hands hold, in a few solids.
/// What is not there or not known has no marker.
void FillMarkers(const PersonState& person, const PersonNames& names,
                 const std::string& reference_frame, MarkerFrames frames, double floor_z,
                 visualization_msgs::MarkerArray& message);

/// Turns the markers last sent into those of a stream that stopped: grey, of the size of unknown
/// loads, and there until something new comes. The centre of pressure and arrows go: no force is
/// known now.
void MakeStale(double stature, visualization_msgs::MarkerArray& message);

}  // namespace kinescope::ros_bridge
