/// Turns option texts into what the parts take, refusing what makes no sense.
#pragma once

#include <string>
#include <utility>

#include "server/app/options.h"
#include "server/app/scene_builder.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

// All: @throws UsageError naming option, value and what was expected.
SceneOptions ToSceneOptions(const PersonOptions& person, double stale_secs,
                            const LoadOptions& loads = {});
urdf::BodyDescription ToBody(const PersonOptions& person);
loads::LoadSettings ToLoadSettings(const LoadOptions& loads);
ros_bridge::BridgeConfig ToBridgeConfig(const ServeOptions& options);
ros_bridge::RosMode ToRosMode(const std::string& ros);
mvn::Stamps ToStamps(const std::string& stamps);
bool ToSwitch(const std::string& name, const std::string& on_or_off);
std::pair<int, int> ToSize(const std::string& name, const std::string& width_x_height);

}  // namespace kinescope::app
