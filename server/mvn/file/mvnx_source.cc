#include "server/mvn/file/mvnx_source.h"

#include <bitset>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/mvn/open.h"
#include "urdf/anatomical_angles.h"

namespace kinescope::mvn {
namespace {

constexpr double kMvnxNormTolerance = 1e-3;
constexpr std::int64_t kFirstMillisWithoutClock = 1000;
constexpr std::int64_t kLatestMillis = 4'102'444'800'000;  // the year 2100
constexpr std::int64_t kLargestIndex = 0xFFFFFFFF;         // the largest sample counter

Eigen::Vector3d VectorAt(const std::vector<double>& numbers, std::size_t index) {
  return {numbers[3 * index], numbers[3 * index + 1], numbers[3 * index + 2]};
}

bool IsUnit(const double* wxyz) {
  const double norm = Eigen::Map<const Eigen::Vector4d>(wxyz).norm();
  return std::abs(norm - 1.0) <= kMvnxNormTolerance;
}

// Numbers that are a unit quaternion but for their rounding stay as they are, so that what was
// written exactly is read exactly.
Eigen::Quaterniond UnitQuaternion(const double* wxyz) {
  constexpr double kRounding = 1e-15;
  Eigen::Quaterniond turned(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (std::abs(turned.squaredNorm() - 1.0) > kRounding) turned.normalize();
  return turned;
}

// By urdf::Side, heel before forefoot.
constexpr std::array<std::string_view, 4> kContactNames = {"RightFoot_Heel", "RightFoot_Toe",
                                                           "LeftFoot_Heel", "LeftFoot_Toe"};

bool IsMotion(const MvnxFrame& frame) { return frame.type.empty() || frame.type == "normal"; }

// The key of a counter must not come from the file, which could fill the memory with keys.
std::string CounterOf(const MvnxFrame& frame) {
  for (const char* known : {"identity", "npose", "tpose", "tpose-isb"}) {
    if (frame.type == known) return std::string("frame ") + known;
  }
  return "frame of another type";
}

}  // namespace

MvnxSource::MvnxSource(InputFile file, std::string name)
    : name_(std::move(name)), reader_(std::move(file), name_) {
  previous_.fill(Eigen::Quaterniond::Identity());
  const MvnxHeader& header = reader_.header();
  character_.name = header.subject;
  character_.color_rgb = header.color_rgb;
  if (header.points.empty())
    return;  // a file reduced by another program: its poses are still
             // valid
  try {
    character_.skeleton = urdf::SkeletonFromLandmarks(header.points);
    character_.landmarks = header.points;
  } catch (const std::runtime_error& error) {
    reader_.Refuse(error.what());
  }
}

Source::State MvnxSource::Poll(std::chrono::milliseconds /*timeout*/, SampleSink& sink) {
  if (!std::exchange(character_given_, true)) sink.OnCharacter(character_);
  while (reader_.Next(frame_)) {
    if (!IsMotion(frame_)) {
      ++counters_.ignored[CounterOf(frame_)];
      continue;
    }
    CheckFrame();
    ++counters_.samples;
    sink.OnSample(ToSample());
    return State::kMore;
  }
  if (counters_.samples == 0) reader_.Refuse("the file contains no motion frame");
  return State::kEnded;
}

// Afterwards the frame has poses and an index above the one before.
void MvnxSource::CheckFrame() {
  if (frame_[MvnxList::kOrientation].empty() || frame_[MvnxList::kPosition].empty()) {
    reader_.Refuse("frame without orientation or position; select both when exporting MVNX");
  }
  const std::int64_t expected = first_index_ ? index_ + 1 : 0;
  const std::int64_t index = frame_.index.value_or(expected);
  if (index < expected || index > kLargestIndex) {
    reader_.Refuse("frame index " + std::to_string(index) + "; expected at least " +
                   std::to_string(expected));
  }
  index_ = index;
  if (first_index_) return;
  first_index_ = index;
  const std::int64_t millis = frame_.unix_millis.value_or(0);
  if (millis < 0 || millis > kLatestMillis) {
    reader_.Refuse("ms is " + std::to_string(millis) + "; expected the Unix time in milliseconds");
  }
  has_time_of_day_ = millis > 0;
  first_unix_nanos_ = (millis > 0 ? millis : kFirstMillisWithoutClock) * kNanosPerMilli;
}

BodySample MvnxSource::ToSample() {
  BodySample sample;
  FillTimes(sample);
  FillSegments(sample);
  const std::vector<double>& com = frame_[MvnxList::kCenterOfMass];
  if (!com.empty()) {
    sample.com = CenterOfMass();
    sample.com->position = VectorAt(com, 0);
    sample.com->has_derivatives = com.size() == 9;
    if (sample.com->has_derivatives) {
      sample.com->velocity = VectorAt(com, 1);
      sample.com->acceleration = VectorAt(com, 2);
    }
  }
  FillAngles(sample);
  FillContacts(sample);
  FillTrackers(sample);
  return sample;
}

void MvnxSource::FillContacts(BodySample& sample) const {
  const std::vector<double>& flags = frame_[MvnxList::kFootContacts];
  std::array<FootContactFlags, 2> feet;
  std::bitset<4> found;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    for (std::size_t known = 0; known < kContactNames.size(); ++known) {
      if (reader_.header().foot_contacts[i] != kContactNames[known]) continue;
      FootContactFlags& foot = feet[known / 2];
      (known % 2 == 0 ? foot.heel : foot.forefoot) = flags[i] != 0;
      found.set(known);
    }
  }
  if (found.all()) sample.foot_contacts = feet;
}

void MvnxSource::FillTrackers(BodySample& sample) const {
  const std::vector<double>& orientation = frame_[MvnxList::kSensorOrientation];
  const std::vector<double>& free = frame_[MvnxList::kSensorFreeAcceleration];
  const std::vector<double>& with_gravity = frame_[MvnxList::kSensorAcceleration];
  const std::vector<double>& rates = frame_[MvnxList::kSensorAngularVelocity];
  const std::vector<double>& field = frame_[MvnxList::kSensorMagneticField];
  if (orientation.empty() || field.empty() || (free.empty() && with_gravity.empty())) return;
  const auto& sensors = reader_.header().sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (!sensors[i]) continue;
    const auto segment = static_cast<std::size_t>(*sensors[i]);
    TrackerState& tracker = sample.trackers[segment];
    const double* const q = &orientation[4 * i];
    if (!IsUnit(q)) continue;  // zeros: this sensor was lost
    tracker.orientation = UnitQuaternion(q);
    tracker.magnetic_field = VectorAt(field, i);
    tracker.has_rates = !with_gravity.empty() && !rates.empty();
    if (tracker.has_rates) {
      tracker.acceleration = VectorAt(with_gravity, i);
      tracker.angular_velocity = VectorAt(rates, i);
    }
    constexpr double kMvnGravity = 9.81;  // m/s^2
    tracker.free_acceleration = !free.empty() ? VectorAt(free, i)
                                              : tracker.orientation * VectorAt(with_gravity, i) -
                                                    kMvnGravity * Eigen::Vector3d::UnitZ();
    sample.has_tracker.set(segment);
  }
}

void MvnxSource::FillAngles(BodySample& sample) const {
  const std::vector<double>& angles = frame_[MvnxList::kJointAngle];
  if (angles.empty()) return;
  std::array<Eigen::Vector3d, urdf::kJointCount> by_joint;
  std::bitset<urdf::kJointCount> found;
  const auto& joints = reader_.header().joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i]) continue;
    const auto joint = static_cast<std::size_t>(*joints[i]);
    by_joint[joint] = VectorAt(angles, i);
    found.set(joint);
  }
  if (found.all()) sample.streamed_angles_deg = by_joint;
}

void MvnxSource::FillTimes(BodySample& sample) const {
  const double rate = reader_.header().rate_hz;
  const auto since_first = static_cast<double>(index_ - *first_index_);
  sample.has_time_of_day = has_time_of_day_;
  sample.counter = static_cast<std::uint32_t>(index_);
  sample.time_code_millis =
      static_cast<std::int64_t>(std::llround(1000.0 * static_cast<double>(index_) / rate));
  sample.stamp_nanos = first_unix_nanos_ + static_cast<std::int64_t>(
                                               std::llround(since_first / rate * kNanosPerSecond));
}

void MvnxSource::FillSegments(BodySample& sample) {
  const MvnxHeader& header = reader_.header();
  const std::vector<double>& orientation = frame_[MvnxList::kOrientation];
  const auto vector_of = [this](MvnxList list, std::size_t i) {
    return frame_[list].empty() ? Eigen::Vector3d::Zero().eval() : VectorAt(frame_[list], i);
  };
  sample.has_linear =
      !frame_[MvnxList::kVelocity].empty() && !frame_[MvnxList::kAcceleration].empty();
  sample.has_angular = !frame_[MvnxList::kAngularVelocity].empty() &&
                       !frame_[MvnxList::kAngularAcceleration].empty();
  for (std::size_t i = 0; i < header.segments.size(); ++i) {
    if (!header.segments[i]) continue;  // a prop
    const auto segment = static_cast<std::size_t>(*header.segments[i]);
    const double* const q = &orientation[4 * i];
    if (!IsUnit(q)) {
      reader_.Refuse("orientation of " + std::string(urdf::kSegments[segment].mvn_name) +
                     " is not a unit quaternion");
    }
    Eigen::Quaterniond turned = UnitQuaternion(q);
    if (header.version == 3) {
      turned = turned * urdf::SegmentFromIsb(*header.segments[i]).conjugate();
    }
    if (turned.dot(previous_[segment]) < 0) turned.coeffs() = -turned.coeffs();
    previous_[segment] = turned;

    SegmentState& state = sample.segments[segment];
    state.orientation = turned;
    state.position = vector_of(MvnxList::kPosition, i);
    if (sample.has_linear) {
      state.velocity = vector_of(MvnxList::kVelocity, i);
      state.acceleration = vector_of(MvnxList::kAcceleration, i);
    }
    if (sample.has_angular) {
      state.angular_velocity = vector_of(MvnxList::kAngularVelocity, i);
      state.angular_acceleration = vector_of(MvnxList::kAngularAcceleration, i);
    }
  }
}

SourceCounters MvnxSource::counters() const {
  SourceCounters counters = counters_;
  counters.bytes = reader_.bytes_read();
  return counters;
}

std::unique_ptr<Source> OpenMvnx(const std::string& path) {
  return std::make_unique<MvnxSource>(OpenInputFile(path), NameOfInput(path));
}

}  // namespace kinescope::mvn
