/// Collects the samples and scale data of one character for the report. Memory does not grow; one
/// thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/source.h"
#include "server/mvn/inspect/inspection.h"

namespace kinescope::mvn {

class CharacterTally : public SampleSink {
 public:
  void OnCharacter(const Character& character) override { character_ = character; }
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;

  bool has_scale() const {
    return character_ && (character_->skeleton || !character_->scaled_segments.empty());
  }
  bool has_name() const { return character_ && !character_->name.empty(); }

  /// Sets name, kind, size, segments and quantities.
  void Fill(CharacterReport& report) const;

 private:
  void AddFingersAndProps(const FingerAndPropSegments& segments);

  enum Quantity { kLinear, kAngular, kCom, kAngles, kTrackers, kUtc, kGloves, kProps, kQuantities };

  std::optional<Character> character_;  // the newest
  std::uint64_t people_samples_ = 0;
  std::uint64_t objects_samples_ = 0;
  std::array<std::uint64_t, kQuantities> quantities_{};
  decltype(FingerAndPropSegments::present) fingers_and_props_seen_;
  decltype(ObjectsSample::present) objects_seen_;
};

/// Sets counters, losses, rates and gaps. `begin_monotonic`: start of the whole stream, ns.
void FillFrames(const FrameTrack& frames, std::int64_t begin_monotonic, CharacterReport& report);

/// What a stream lacks for Kinescope to show it, or to show it well, each with the setting in MVN
/// that adds it. Most important first.
std::vector<std::string> AdviceFor(const CharacterReport& character, bool has_scale, bool has_name);
std::vector<std::string> AdviceFor(const InspectionReport& report);

}  // namespace kinescope::mvn
