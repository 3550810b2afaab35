/// Live settings as messages of dynamic_reconfigure: the parameters class_medium, class_high, mass,
/// height, sex and camera. Pure functions, any thread.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include <string>
#include <vector>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

/// `cameras`: to choose from; without one, there is no parameter for it. `start`: the default.
dynamic_reconfigure::ConfigDescription DescribeSettings(const LiveSettings& start,
                                                        const std::vector<std::string>& cameras);

/// The camera is left out if it is "".
dynamic_reconfigure::Config ToConfig(const LiveSettings& settings);

struct WantedSettings {
  LiveSettings all;                  // as they are to be
  SettingsChange change;             // of `now`
  std::vector<std::string> refused;  // why not, of each parameter that is not taken
};
/// What a client asks for. Numbers outside the range of their parameter become its nearest limit,
/// as dynamic_reconfigure does it. Unknown names, numbers that are none and texts that are not
/// among the choices are refused.
WantedSettings ReadConfig(const dynamic_reconfigure::Config& wanted, const LiveSettings& now,
                          const std::vector<std::string>& cameras);

}  // namespace kinescope::ros_bridge
