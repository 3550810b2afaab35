/// Converts what the node of a suit was told about its people: their masses, and what is in their
/// hands. Pure: no node, no clock; any thread.
#pragma once

#include <kinescope/PersonArray.h>

#include <cstdint>
#include <string>

#include "core/person_change.h"
#include "core/scene_state.h"
#include "core/system/clocks.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// Of kinescope/PersonArray, of all nodes; as /tf, no node's own. A latched message per node.
inline constexpr char kPeopleTopic[] = "/kinescope/people";
/// It comes again while samples come: a bag that is split has it in each file, and others notice
/// that a node has gone.
inline constexpr std::int64_t kTellEveryNanos = kNanosPerSecond;

/// `topics`: in front of the names of the person's topics, "/kinescope/".
void FillPerson(const PersonState& person, const PersonNames& names, const std::string& topics,
                kinescope_ros::Person& message);

/// Of all members, also of numbers that are none.
bool AreEqual(const kinescope_ros::Person& a, const kinescope_ros::Person& b);

/// Which of `message` was told; not checked otherwise.
PersonChange ToldOf(const kinescope_ros::Person& message);

/// Of a kinescope/HandLoad, or a request of kinescope/SetHandLoad. Returns why a centre of mass is
/// none, which is left out; "": all is well. Masses are not checked.
template <class Message>
std::string ReadHandLoad(const Message& message, HandLoad& load);

}  // namespace kinescope::ros_bridge
