#include "server/subject/subject.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "core/system/words.h"
#include "server/subject/motions.h"

namespace kinescope::subject {
namespace {

// 2020-01-01T00:00:00Z: when every recording of the subject began. Fixed, so that the same demo
// gives the same bytes.
constexpr std::int64_t kEpochNanos = 1'577'836'800'000'000'000;

constexpr double kHighestRateHz = 10'000;

std::unique_ptr<MotionGenerator> MakeGenerator(const std::string& name,
                                               const urdf::Skeleton& skeleton) {
  if (name == "lift") return MakeLift(skeleton);
  if (name == "walk") return MakeWalk(skeleton);
  if (name == "n_pose") return MakeStand(skeleton, Arms::kHanging);
  if (name == "t_pose") return MakeStand(skeleton, Arms::kSideways);
  if (name == "squat") return MakeStaticPosture(skeleton, StaticPosture::kSquat);
  if (name == "overhead") return MakeStaticPosture(skeleton, StaticPosture::kOverhead);
  if (name == "sit") return MakeStaticPosture(skeleton, StaticPosture::kSit);
  throw SourceError("demo:" + name + ": unknown motion; expected " + Alternatives(MotionNames()) +
                    SuggestionFor(name, MotionNames()));
}

class BuiltInMotion final : public Motion {
 public:
  /// `make` gets a skeleton to borrow and returns a MotionGenerator.
  template <class Make>
  BuiltInMotion(const char* person, double height_m, const Make& make)
      : skeleton_(urdf::DefaultSkeleton(height_m)),
        body_(urdf::MakeBodyParameters({}, skeleton_)),
        generator_(make(skeleton_)) {
    character_.name = person;
    character_.skeleton = skeleton_;
    character_.landmarks = urdf::LandmarksOf(skeleton_);
  }

  BodySample At(double seconds) const override {
    // Time within the period: late samples are as exact as the first.
    const double period = generator_->period_secs();
    const double within = seconds - period * std::floor(seconds / period);
    BodySample sample = generator_->PoseAt({within, 1, 0}).ToSample(body_);
    sample.time_code_millis = std::llround(seconds * 1e3);
    sample.stamp_nanos = kEpochNanos + std::llround(seconds * 1e9);
    sample.has_time_of_day = false;
    return sample;
  }

  const Character& character() const override { return character_; }

 private:
  const urdf::Skeleton skeleton_;
  const urdf::BodyParameters body_;
  const std::unique_ptr<MotionGenerator> generator_;  // borrows skeleton_
  Character character_;
};

class SubjectSource final : public Source {
 public:
  SubjectSource(std::unique_ptr<Motion> motion, std::string url, double rate_hz, double seconds)
      : motion_(std::move(motion)),
        description_(std::move(url)),
        rate_hz_(rate_hz),
        endless_(seconds == 0),
        sample_count_(endless_ ? 0 : static_cast<std::uint64_t>(std::llround(seconds * rate_hz))) {}

  State Poll(std::chrono::milliseconds, SampleSink& sink) override {
    if (!endless_ && next_ >= sample_count_) return State::kEnded;
    if (next_ == 0) sink.OnCharacter(motion_->character());
    BodySample sample = motion_->At(static_cast<double>(next_) / rate_hz_);
    sample.counter = static_cast<std::uint32_t>(next_);
    ++next_;
    sink.OnSample(sample);
    return State::kMore;
  }

  SourceCounters counters() const override {
    SourceCounters counters;
    counters.samples = next_;
    return counters;
  }
  std::string description() const override { return description_; }
  bool is_live() const override { return false; }
  double nominal_rate_hz() const override { return rate_hz_; }

 private:
  const std::unique_ptr<Motion> motion_;
  const std::string description_;
  const double rate_hz_;
  const bool endless_;
  const std::uint64_t sample_count_;
  std::uint64_t next_ = 0;
};

std::unique_ptr<Source> Open(std::unique_ptr<Motion> motion, const std::string& url, double rate_hz,
                             double seconds) {
  const auto refuse = [&](const char* what, double value, const char* expected) {
    std::ostringstream message;
    message << url << ": " << what << " " << value << ": expected " << expected;
    throw SourceError(message.str());
  };
  if (!(rate_hz > 0 && rate_hz <= kHighestRateHz))
    refuse("rate", rate_hz, "more than 0, at most 10000 Hz");
  if (!(seconds >= 0 && seconds <= 1e9)) refuse("duration", seconds, "0 (endless) to 1e9 s");
  return std::make_unique<SubjectSource>(std::move(motion), url, rate_hz, seconds);
}

std::unique_ptr<Motion> MakePose(const WrittenPose& pose, double height_m) {
  KINESCOPE_CHECK(height_m >= 0.5 && height_m <= 2.5);
  return std::make_unique<BuiltInMotion>("Pose", height_m, [&](const urdf::Skeleton& skeleton) {
    return MakeWrittenPose(skeleton, pose, *MakeGenerator(pose.base, skeleton));
  });
}

}  // namespace

const std::vector<std::string>& MotionNames() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names = {"lift", "walk"};
    names.insert(names.end(), StaticPoseNames().begin(), StaticPoseNames().end());
    return names;
  }();
  return kNames;
}

const std::vector<std::string>& StaticPoseNames() {
  static const std::vector<std::string> kNames = {"n_pose", "t_pose", "squat", "overhead", "sit"};
  return kNames;
}

std::unique_ptr<Motion> MakeMotion(const std::string& name, double height_m) {
  KINESCOPE_CHECK(height_m >= 0.5 && height_m <= 2.5);
  return std::make_unique<BuiltInMotion>("Demo", height_m, [&](const urdf::Skeleton& skeleton) {
    return MakeGenerator(name, skeleton);
  });
}

std::unique_ptr<Motion> MakePose(const std::string& text, double height_m) {
  return MakePose(ParsePose(text), height_m);
}

std::unique_ptr<Source> OpenSubject(const std::string& motion, double rate_hz, double seconds,
                                    double height_m) {
  return Open(MakeMotion(motion, height_m), "demo:" + motion, rate_hz, seconds);
}

std::unique_ptr<Source> OpenPose(const std::string& text, double rate_hz, double height_m) {
  const WrittenPose pose = ParsePose(text);
  return Open(MakePose(pose, height_m), "pose:" + pose.text, rate_hz, 0);
}

}  // namespace kinescope::subject
