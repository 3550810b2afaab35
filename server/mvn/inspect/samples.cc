#include <algorithm>
#include <utility>

#include "server/mvn/inspect/character.h"
#include "server/mvn/inspect/inspection.h"

namespace kinescope::mvn {

class SampleInspection::Person {
 public:
  explicit Person(int id) : id_(id) {}

  int id() const { return id_; }
  CharacterTally& tally() { return tally_; }

  void AddFrame(std::uint32_t counter, std::int64_t time_code_millis, std::int64_t stamp_nanos) {
    frames_.Add(static_cast<int>(Type::kPose), counter,
                static_cast<std::uint32_t>(time_code_millis), {stamp_nanos, stamp_nanos});
  }

  CharacterReport Report(std::int64_t begin_nanos) const {
    CharacterReport report;
    report.id = id_;
    tally_.Fill(report);
    FillFrames(frames_, begin_nanos, report);
    report.capture_rate_hz = 0;  // a file states its acquisition rate: that is rate_hz
    return report;
  }

 private:
  const int id_;
  CharacterTally tally_;
  FrameTrack frames_{FrameTrack::Confirmation::kConfirmed};
};

SampleInspection::SampleInspection() = default;
SampleInspection::~SampleInspection() = default;

SampleInspection::Person* SampleInspection::Find(int id) {
  for (const auto& person : people_) {
    if (person->id() == id) return person.get();
  }
  if (people_.size() >= kMaxCharacters) return nullptr;
  people_.push_back(std::make_unique<Person>(id));
  return people_.back().get();
}

void SampleInspection::NoteTime(std::int64_t stamp_nanos) {
  if (samples_++ == 0) first_stamp_ = last_stamp_ = stamp_nanos;
  first_stamp_ = std::min(first_stamp_, stamp_nanos);
  last_stamp_ = std::max(last_stamp_, stamp_nanos);
}

void SampleInspection::OnCharacter(const Character& character) {
  if (Person* person = Find(character.id)) person->tally().OnCharacter(character);
}

void SampleInspection::OnSample(const BodySample& sample) {
  NoteTime(sample.stamp_nanos);
  Person* const person = Find(sample.character);
  if (person == nullptr) return;
  person->tally().OnSample(sample);
  person->AddFrame(sample.counter, sample.time_code_millis, sample.stamp_nanos);
}

void SampleInspection::OnObjects(const ObjectsSample& sample) {
  NoteTime(sample.stamp_nanos);
  Person* const person = Find(sample.character);
  if (person == nullptr) return;
  person->tally().OnObjects(sample);
  person->AddFrame(sample.counter, sample.time_code_millis, sample.stamp_nanos);
}

InspectionReport SampleInspection::Report(const Source& source) const {
  InspectionReport report;
  const SourceCounters counters = source.counters();
  report.source = source.description();
  report.is_live = source.is_live();
  report.has_datagrams = false;
  report.begin_wall_nanos = first_stamp_;
  report.end_wall_nanos = last_stamp_;
  report.secs = static_cast<double>(last_stamp_ - first_stamp_) * 1e-9;
  report.bytes = counters.bytes;
  for (const auto& person : people_) report.characters.push_back(person->Report(first_stamp_));
  for (const auto& [reason, count] : counters.rejected) {
    ErrorReport error;
    error.reason = reason;
    error.count = count;
    report.errors.push_back(std::move(error));
  }
  report.ignored = counters.ignored;
  report.advice = counters.problems;
  return report;
}

}  // namespace kinescope::mvn
