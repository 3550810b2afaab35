/// Passes the samples of a recording on with their motion filtered without lag, in their order,
/// together with all that came between them. One thread.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <variant>

#include "core/source.h"
#include "server/loads/zero_phase_filter.h"

namespace kinescope::app {

class SmoothSampleSink {
 public:
  virtual ~SmoothSampleSink() = default;
  virtual void OnCharacter(const Character& character) = 0;
  /// `motion`: null where the sample has none.
  virtual void OnSample(const BodySample& sample, const loads::BodyMotion* motion) = 0;
  virtual void OnObjects(const ObjectsSample& sample) = 0;
  virtual void OnSurroundings(const RecordedSurroundings& all) = 0;
  virtual void OnMoment(const SourceMoment& moment) = 0;
};

class SampleSmoother : public SampleSink {
 public:
  SampleSmoother(double cutoff_hz, SmoothSampleSink& to) : cutoff_hz_(cutoff_hz), to_(to) {}

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;
  void OnSurroundings(const RecordedSurroundings& all) override;
  void OnMoment(const SourceMoment& moment) override;
  /// No sample follows: passes everything on.
  void End();

 private:
  struct Waiting {
    std::variant<Character, BodySample, ObjectsSample, RecordedSurroundings, SourceMoment> event;
    bool has_motion = false;
  };
  struct Person {
    explicit Person(double cutoff_hz) : filter(cutoff_hz) {}
    loads::ZeroPhaseFilter filter;
    bool continues = false;
    std::int64_t last_nanos = 0;
  };
  void PassOn();

  double cutoff_hz_;
  SmoothSampleSink& to_;
  std::deque<Waiting> waiting_;
  std::map<int, Person> people_;  // by character
};

}  // namespace kinescope::app
