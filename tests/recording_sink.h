/// A sink that keeps everything that a source delivers.
#pragma once

#include <optional>
#include <vector>

#include "core/source.h"

namespace kinescope::testing {

struct RecordingSink : SampleSink {
  std::vector<Character> characters;
  std::vector<BodySample> samples;
  std::vector<ObjectsSample> objects;
  std::vector<MarkerList> markers;                      // of each sample
  std::vector<RobotList> robots;                        // of each sample
  std::vector<std::optional<urdf::Pose>> camera_bases;  // of each sample
  RecordedSurroundings shown;

  void OnCharacter(const Character& character) override { characters.push_back(character); }
  void OnSample(const BodySample& sample) override {
    samples.push_back(sample);
    markers.push_back(shown.markers);
    robots.push_back(shown.robots);
    camera_bases.push_back(shown.camera_base);
  }
  void OnSurroundings(const RecordedSurroundings& all) override { shown = all; }
  void OnObjects(const ObjectsSample& sample) override { objects.push_back(sample); }
};

}  // namespace kinescope::testing
