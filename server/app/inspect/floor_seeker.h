/// Finds the floor under the people of a recording, as `loads` does, while the recording is
/// inspected. One thread.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/source.h"
#include "server/mvn/assembler.h"
#include "server/mvn/inspect/inspection.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class FloorSeeker : public SampleSink {
 public:
  FloorSeeker();

  /// Of a recording of datagrams, in place of the samples.
  void OnDatagram(const mvn::ReceivedDatagram& datagram);

  void OnCharacter(const Character& character) override { builder_.OnCharacter(character); }
  void OnSample(const BodySample& sample) override { builder_.OnSample(sample); }

  /// To be called once, at the end: sets the floor of each person in `report`.
  void Fill(mvn::InspectionReport& report);

 private:
  struct Floor {
    double height = 0;  // m
    std::string_view why_not;
  };
  std::map<int, Floor> floors_;  // by character; bounded by the source
  mvn::Assembler assembler_;
  SceneBuilder builder_;
};

}  // namespace kinescope::app
