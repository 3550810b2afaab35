/// Frequency and time stamps of the published samples, as diagnostic_updater judges them: what
/// rqt_robot_monitor and others expect of a driver. Publishing thread only.
#pragma once

#include <diagnostic_updater/update_functions.h>
#include <ros/time.h>

#include <vector>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

class StreamStatus {
 public:
  StreamStatus();  // @pre roscpp was started, so that there is a time

  void OnSample(const ros::Time& stamp);

  /// Since the last calls: "frequency", against that of the suit, within 10 %, and "time stamps",
  /// from 1 s ahead of the clock to 5 s behind it. `suit_hz`: 0 while it is unknown.
  std::vector<Diagnosis> Diagnose(double suit_hz);

 private:
  double suit_hz_ = 0;
  diagnostic_updater::FrequencyStatus frequency_;
  diagnostic_updater::TimeStampStatus stamps_;
};

}  // namespace kinescope::ros_bridge
