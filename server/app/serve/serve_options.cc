#include "server/app/serve/serve_options.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace kinescope::app {

ros_bridge::BridgeConfig ToBridgeConfig(const ServeOptions& options) {
  if (options.tf != "flat" && options.tf != "tree" && options.tf != "off") {
    throw UsageError(fmt::format("--tf={}: expected flat, tree or off", options.tf));
  }
  if (options.joint_states != "computed" && options.joint_states != "streamed") {
    throw UsageError(
        fmt::format("--joint_states={}: expected computed or streamed", options.joint_states));
  }
  ros_bridge::BridgeConfig config;
  config.reference_frame = options.reference_frame;
  config.tf = options.tf;
  config.joint_states = options.joint_states;
  config.external_scale = options.external_scale;
  return config;
}

ros_bridge::RosMode ToRosMode(const std::string& ros) {
  if (ros == "off") return ros_bridge::RosMode::kOff;
  if (ros == "auto") return ros_bridge::RosMode::kAuto;
  if (ros == "required") return ros_bridge::RosMode::kRequired;
  throw UsageError(fmt::format("--ros={}: expected auto, off or required", ros));
}

mvn::Stamps ToStamps(const std::string& stamps) {
  if (stamps == "fitted") return mvn::Stamps::kFitted;
  if (stamps == "arrival") return mvn::Stamps::kArrival;
  throw UsageError(fmt::format("--stamps={}: expected fitted or arrival", stamps));
}

}  // namespace kinescope::app
