#include "server/ros/stream_status.h"

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

namespace kinescope::ros_bridge {
namespace {

Diagnosis Run(diagnostic_updater::DiagnosticTask& task) {
  diagnostic_updater::DiagnosticStatusWrapper status;
  task.run(status);
  Diagnosis diagnosis;
  diagnosis.level = static_cast<Diagnosis::Level>(status.level);
  diagnosis.name = task.getName();
  diagnosis.message = status.message;
  for (const auto& value : status.values) diagnosis.values.emplace_back(value.key, value.value);
  return diagnosis;
}

}  // namespace

StreamStatus::StreamStatus()
    : frequency_({&suit_hz_, &suit_hz_}, "frequency"), stamps_({}, "time stamps") {}

void StreamStatus::OnSample(const ros::Time& stamp) {
  frequency_.tick();
  stamps_.tick(stamp);
}

std::vector<Diagnosis> StreamStatus::Diagnose(double suit_hz) {
  if (suit_hz > 0) suit_hz_ = suit_hz;
  return {Run(frequency_), Run(stamps_)};
}

}  // namespace kinescope::ros_bridge
