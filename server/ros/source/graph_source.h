/// Reads people from a running ROS graph: assembles the transforms on its /tf to samples, so that
/// Kinescope can be used with an existing bridge (docs/ros.md). In a build without ROS OpenGraph
/// throws a SourceError.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/graph_view.h"
#include "core/source.h"

namespace kinescope::ros_bridge {

/// `ros:`, `ros:/tf`, `ros:/xsens/link_states`.
bool IsGraphUrl(std::string_view url);

/// A live source. `url`: `ros:` for /tf, or `ros:` and a topic of tf2_msgs/TFMessage or
/// xsens_mvn_ros_msgs/LinkStateArray; the type is taken from the publisher. With a topic whose name
/// ends in "tf", its `..._static` is subscribed, too.
///
/// - Frames, samples, arms, skeletons and counters are as in bag_source.h, with receive times in
///   place of the bag's times; people are searched when no new frame has appeared for 0.25 s.
/// - People whose frames hang on different ones are brought into one (common_frame.h):
///   `view.reference_frame`, "": that of the first person.
/// - A link state topic belongs to one person; its samples have velocities and accelerations if
///   these are published.
/// - Messages of Kinescope's own node are counted in `ignored`.
/// - transport: `ros_master_answers` (0 or 1), `publishers` (connected now).
/// - The source waits for a master that is not reachable or restarts; Poll never blocks on it.
///   `rosnode kill` ends the source.
///
/// A source is used by one thread. Make one per process, destroy it after a RosBridge.
/// Starts roscpp, unless it was started before.
/// @throws SourceError if the topic name is invalid or one of Kinescope's own, or if another node
/// has this node's name: starting would shut it down.
std::unique_ptr<Source> OpenGraph(const std::string& url, const GraphView& view = {});

/// Whether a master answers the source of a graph.
bool HasMaster(const Source& graph);

/// What keeps the source of a graph from data, with the way out: no master answers, or no node
/// publishes. "": neither.
std::string MissingInGraph(const Source& graph);

}  // namespace kinescope::ros_bridge
