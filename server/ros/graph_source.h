/// People out of a running ROS graph: the transforms on its /tf, joined to samples, so that
/// Kinescope can be put beside a bridge that is there already (docs/ros.md). In a build without ROS
/// the functions exist and say so.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/source.h"

namespace kinescope::ros_bridge {

/// `ros:`, `ros:/tf`, `ros:/xsens/link_states`.
bool IsGraphUrl(std::string_view url);

/// A live source. `url`: `ros:` for /tf, or `ros:` and a topic of tf2_msgs/TFMessage or
/// xsens_mvn_ros_msgs/LinkStateArray; which of them it is, its publisher says. Beside a topic whose
/// name ends in "tf" its `..._static` is heard, too.
///
/// - Frames, samples, arms, skeletons and counters are as in bag_source.h, times of arrival instead
///   of the bag's; people are looked for once no new frame came for a quarter of a second.
/// - A link state topic is one person's; its samples have velocities and accelerations, where they
///   are published.
/// - What our own node publishes is `ignored`.
/// - transport: `ros_master_answers` (0 or 1), `publishers` (connected now).
/// - A master that is not there, dies or is restarted is waited for; Poll never is held up by it.
///   After `rosnode kill` the source has ended.
///
/// One thread uses the source. Make one per process, destroy it after a RosBridge.
/// @pre InitRos was called.
/// @throws SourceError when the topic's name cannot be one, is one of our own, or when another node
/// has our name: starting would end that one.
std::unique_ptr<Source> OpenGraph(const std::string& url);

}  // namespace kinescope::ros_bridge
