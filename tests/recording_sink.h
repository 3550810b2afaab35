/// A sink that keeps everything that a source delivers.
#pragma once

#include <vector>

#include "core/source.h"

namespace kinescope::testing {

struct RecordingSink : SampleSink {
  std::vector<Character> characters;
  std::vector<BodySample> samples;
  std::vector<ObjectsSample> objects;

  void OnCharacter(const Character& character) override { characters.push_back(character); }
  void OnSample(const BodySample& sample) override { samples.push_back(sample); }
  void OnObjects(const ObjectsSample& sample) override { objects.push_back(sample); }
};

}  // namespace kinescope::testing
