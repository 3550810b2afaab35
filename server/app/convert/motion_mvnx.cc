#include "server/app/convert/motion_mvnx.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "server/mvn/file/mvnx_writer.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

bool IsFinite(const BodySample& sample) {
  for (const SegmentState& segment : sample.segments) {
    if (!segment.position.allFinite() || !segment.orientation.coeffs().allFinite() ||
        !segment.velocity.allFinite() || !segment.acceleration.allFinite() ||
        !segment.angular_velocity.allFinite() || !segment.angular_acceleration.allFinite()) {
      return false;
    }
  }
  return true;
}

mvn::MvnxSubject SubjectOf(const PersonState& person, const MotionOutline& outline) {
  mvn::MvnxSubject subject;
  const PersonModel& model = *person.model;
  subject.label = person.name.empty() ? fmt::format("Person {}", person.character) : person.name;
  subject.color_rgb = model.color_rgb;
  subject.rate_hz = outline.rate_hz;
  subject.skeleton = model.human.skeleton;
  subject.landmarks = model.landmarks;
  subject.sensors = outline.trackers;
  subject.has_foot_contacts = outline.has_foot_contacts;
  if (person.sample.has_time_of_day) subject.began_nanos = person.sample.stamp_nanos;
  subject.original_file = outline.source;
  subject.program = "Kinescope " KINESCOPE_VERSION;
  subject.comment = outline.provenance;
  return subject;
}

// The file of one person.
class PersonMvnx {
 public:
  PersonMvnx(const std::string& path, const PersonState& first, const MotionOutline& outline)
      : path_(path),
        out_(path),
        writer_(SubjectOf(first, outline)),
        skeleton_(first.model->human.skeleton) {
    writer_.AppendHead(out_.buffer());
  }

  void Add(const PersonState& person, std::int64_t frame) {
    if (!IsFinite(person.sample)) {
      ++unfit_;
      return;
    }
    writer_.AppendFrame(person.sample, frame, out_.buffer());
    out_.FlushWhenLarge();
    has_other_parts_ |= person.sample.fingers_and_props.present.any();
    has_rates_ |= HasRates(person.sample);
    lengths_changed_ |= !(person.model->human.skeleton == skeleton_);
  }

  void Finish() {
    writer_.AppendTail(out_.buffer());
    out_.Finish();
  }

  const std::string& path() const { return path_; }
  void AddNotes(std::vector<std::string>& notes) const {
    const auto add = [&](bool is_so, const char* text) {
      if (is_so) notes.push_back(path_ + ": " + text);
    };
    add(unfit_ > 0, "samples with numbers that are not finite are left out");
    add(has_other_parts_, "gloves and props are left out");
    add(has_rates_, "MVNX 4 has no acceleration with gravity and no angular velocity of sensors");
    add(lengths_changed_, "the segment lengths are those of the first sample; others came later");
  }

 private:
  static bool HasRates(const BodySample& sample) {
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      if (sample.has_tracker.test(i) && sample.trackers[i].has_rates) return true;
    }
    return false;
  }

  const std::string path_;
  OutputFile out_;
  mvn::MvnxWriter writer_;
  const urdf::Skeleton skeleton_;
  std::uint64_t unfit_ = 0;
  bool has_other_parts_ = false, has_rates_ = false, lengths_changed_ = false;
};

class MotionMvnx : public MotionFile {
 public:
  MotionMvnx(std::string path, const MotionOutline& outline)
      : path_(std::move(path)), outline_(outline) {}

  void Add(const PersonState& person, std::int64_t frame) override {
    auto found = people_.find(person.character);
    if (found == people_.end()) {
      auto file = std::make_unique<PersonMvnx>(PathOf(people_.size()), person, outline_);
      found = people_.emplace(person.character, std::move(file)).first;
      order_.push_back(found->second.get());
    }
    found->second->Add(person, frame);
  }

  void Finish() override {
    for (PersonMvnx* file : order_) file->Finish();
  }
  std::vector<std::string> paths() const override {
    std::vector<std::string> paths;
    for (const PersonMvnx* file : order_) paths.push_back(file->path());
    return paths;
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    for (const PersonMvnx* file : order_) file->AddNotes(notes);
    return notes;
  }

 private:
  std::string PathOf(std::size_t number) const {
    if (number == 0) return path_;
    const std::filesystem::path path(path_);
    return (path.parent_path() /
            fmt::format("{}_{}{}", path.stem().string(), number + 1, path.extension().string()))
        .string();
  }

  const std::string path_;
  const MotionOutline outline_;
  std::map<int, std::unique_ptr<PersonMvnx>> people_;
  std::vector<PersonMvnx*> order_;
};

}  // namespace

std::unique_ptr<MotionFile> MakeMotionMvnx(const std::string& path, const MotionOutline& outline) {
  if (outline.rate_hz <= 0) {
    throw std::runtime_error(path + ": MVNX needs a sample rate, and " + outline.source +
                             " has only one sample; write a .csv instead");
  }
  return std::make_unique<MotionMvnx>(path, outline);
}

}  // namespace kinescope::app
