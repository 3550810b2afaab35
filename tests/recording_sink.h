/// A sink that keeps everything that a source delivers.
#pragma once

#include <vector>

#include "core/source.h"

namespace kinescope::testing {

struct RecordingSink : SampleSink {
  std::vector<Character> characters;
  std::vector<BodySample> samples;
  std::vector<ObjectsSample> objects;
  std::vector<MarkerList> markers;  // of each sample
  MarkerList shown;

  void OnCharacter(const Character& character) override { characters.push_back(character); }
  void OnSample(const BodySample& sample) override {
    samples.push_back(sample);
    markers.push_back(shown);
  }
  void OnRecordedMarkers(const MarkerList& all) override { shown = all; }
  void OnObjects(const ObjectsSample& sample) override { objects.push_back(sample); }
};

}  // namespace kinescope::testing
