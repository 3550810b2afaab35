#include "server/ros/bag_source.h"

#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "server/core/errors.h"
#include "server/ros/bag_file.h"
#include "server/ros/bag_frames.h"
#include "server/ros/bag_person.h"

namespace kinescope::ros_bridge {
namespace {

constexpr int kMessagesPerPoll = 256;
constexpr std::int64_t kNamesNanos = 10'000'000'000;  // read for frame names when opening
// A transform without names: header (sequence, stamp, empty frame_id), empty child, 7 doubles.
constexpr std::size_t kSmallestTransform = 4 + 8 + 4 + 4 + 7 * 8;
constexpr std::size_t kLargestMessage = 16 << 20;  // 100,000 transforms
constexpr double kFarthest = 1e6;                  // m; nobody stands there
constexpr double kNormTolerance = 1e-3;

constexpr char kNotFinite[] = "transform with a number that is not finite";
constexpr char kFarAway[] = "transform with a position out of range";
constexpr char kNotUnit[] = "transform with a quaternion that is not of unit length";
constexpr char kUnreadable[] = "message on /tf that is cut short or lies about its length";
constexpr char kOtherType[] = "message on /tf that is no TFMessage";
constexpr char kNotWhole[] = "sample without all 23 segments";
constexpr char kNoTree[] = "sample whose frames have no common parent";
constexpr char kNobody[] = "message on /tf without a person's segment";

std::int64_t Nanos(const ros::Time& time) {
  return std::int64_t{time.sec} * 1'000'000'000 + std::int64_t{time.nsec};
}

bool IsTransforms(const std::string& topic) { return topic == "/tf" || topic == "tf"; }

// tf2 has no slash before a frame's name, tf had one.
std::string WithoutSlash(const std::string& frame) {
  return frame.empty() || frame.front() != '/' ? frame : frame.substr(1);
}

// Nothing when it can be used, else the counter under which it goes.
const char* DefectOf(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  for (const double value : {t.x, t.y, t.z, r.x, r.y, r.z, r.w}) {
    if (!std::isfinite(value)) return kNotFinite;
  }
  if (std::max({std::abs(t.x), std::abs(t.y), std::abs(t.z)}) > kFarthest) return kFarAway;
  const double norm = Eigen::Quaterniond(r.w, r.x, r.y, r.z).norm();
  return std::abs(norm - 1) > kNormTolerance ? kNotUnit : nullptr;
}

urdf::Pose ToPose(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  return {{t.x, t.y, t.z}, Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized()};
}

struct Appearances {
  std::uint64_t count = 0;
  std::int64_t first_nanos = 0;
  std::int64_t last_nanos = 0;
};

class BagSource : public Source {
 public:
  explicit BagSource(const std::string& path) : name_(path), file_(path) {
    Guard([&] { Open(); });
  }

  State Poll(std::chrono::milliseconds /*timeout*/, SampleSink& sink) override {
    State state = State::kMore;
    Guard([&] { state = Read(sink); });
    return state;
  }

  SourceCounters counters() const override { return counters_; }
  std::string description() const override { return name_; }
  bool is_live() const override { return false; }
  double nominal_rate_hz() const override { return rate_hz_; }

 private:
  void Open();
  void ReadNames();
  State Read(SampleSink& sink);
  /// False: nothing of it can be used. Counts why.
  bool Decode(const rosbag::MessageInstance& instance);
  void TakeMessage(std::int64_t record_nanos, SampleSink& sink);
  void TakeTransform(const geometry_msgs::TransformStamped& transform, std::int64_t record_nanos);
  BagPerson& PersonAt(int index);
  void Give(int person, SampleSink& sink);
  void Reject(const char* reason) { ++counters_.rejected[reason]; }

  // What rosbag throws, as one line.
  template <class Function>
  void Guard(Function function) {
    const auto fail = [&](const std::string& what) {
      return SourceError("bag '" + name_ + "': " + what);
    };
    try {
      function();
    } catch (const SourceError&) {
      throw;
    } catch (const rosbag::BagUnindexedException&) {
      throw fail("was not closed when it was recorded; `rosbag reindex` repairs it");
    } catch (const rosbag::BagFormatException& error) {
      throw fail(std::string("is broken (") + error.what() + "); `rosbag fix` may repair it");
    } catch (const std::exception& error) {
      throw fail(std::string("breaks off or is broken (") + error.what() +
                 "); `rosbag reindex` may repair it");
    }
  }

  const std::string name_;
  BagFile file_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;  // of /tf
  rosbag::View::iterator next_;
  std::vector<std::uint8_t> buffer_;
  tf2_msgs::TFMessage message_;
  BagFrames frames_;
  std::vector<BagPerson> people_;  // by index of frames_.people()
  std::set<int> touched_;          // people of whom the present message had something
  bool has_ended_ = false;
  SourceCounters counters_;
  double rate_hz_ = 0;
};

void BagSource::Open() {
  bag_.open(file_.path(), rosbag::bagmode::Read);
  rosbag::View everything(bag_);
  std::map<std::string, const rosbag::ConnectionInfo*> topics;
  for (const rosbag::ConnectionInfo* connection : everything.getConnections()) {
    topics.emplace(connection->topic, connection);
  }
  std::vector<std::string> used;
  for (const auto& [topic, connection] : topics) {
    if (IsTransforms(topic)) {
      used.push_back(topic);
      continue;
    }
    const std::uint64_t messages = rosbag::View(bag_, rosbag::TopicQuery(topic)).size();
    counters_.ignored["topic " + topic + " (" + connection->datatype + ")"] = messages;
    counters_.datagrams += messages;
  }
  if (used.empty()) {
    throw SourceError("bag '" + name_ +
                      "': has no /tf, so no poses; record one with `rosbag record /tf`");
  }
  view_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(used));
  const SourceCounters before = counters_;
  ReadNames();
  counters_ = before;  // the same messages are about to be read as samples
  next_ = view_->begin();
}

void BagSource::ReadNames() {
  std::map<std::string, Appearances> appearances;
  std::int64_t end = 0;
  for (const rosbag::MessageInstance& instance : *view_) {
    const std::int64_t now = Nanos(instance.getTime());
    if (end == 0) end = now + kNamesNanos;
    if (now > end && frames_.people().empty()) frames_.Find();
    if (now > end && !frames_.people().empty()) break;
    if (!Decode(instance)) continue;
    for (const geometry_msgs::TransformStamped& transform : message_.transforms) {
      const std::string frame = WithoutSlash(transform.child_frame_id);
      frames_.Add(frame);
      if (!frames_.IsCandidate(frame)) continue;
      Appearances& of_frame = appearances[frame];
      if (of_frame.count++ == 0) of_frame.first_nanos = now;
      of_frame.last_nanos = now;
    }
  }
  frames_.Find();
  if (frames_.people().empty()) {
    throw SourceError("bag '" + name_ +
                      "': nobody on its /tf: expected 23 frames named after the segments, such as "
                      "skeleton_pelvis, skeleton_l5, ..., skeleton_left_toe");
  }
  const Appearances& pelvis = appearances[frames_.people().front().frames[urdf::kPelvis]];
  if (pelvis.count < 2 || pelvis.last_nanos <= pelvis.first_nanos) return;
  rate_hz_ = static_cast<double>(pelvis.count - 1) * 1e9 /
             static_cast<double>(pelvis.last_nanos - pelvis.first_nanos);
}

Source::State BagSource::Read(SampleSink& sink) {
  const std::uint64_t samples_before = counters_.samples;
  for (int i = 0; i < kMessagesPerPoll && counters_.samples == samples_before; ++i) {
    if (next_ == view_->end()) {
      if (has_ended_) return State::kEnded;
      has_ended_ = true;
      for (const BagPerson& person : people_) {
        if (person.End()) Reject(kNotWhole);
      }
      return State::kEnded;
    }
    const rosbag::MessageInstance& instance = *next_;
    ++counters_.datagrams;
    counters_.bytes += instance.size();
    if (Decode(instance)) TakeMessage(Nanos(instance.getTime()), sink);
    ++next_;
  }
  return State::kMore;
}

bool BagSource::Decode(const rosbag::MessageInstance& instance) {
  // tf/tfMessage of old recordings is the same message under another name.
  if (instance.getMD5Sum() != ros::message_traits::md5sum<tf2_msgs::TFMessage>()) {
    Reject(kOtherType);
    return false;
  }
  const std::size_t size = instance.size();
  std::uint32_t count = 0;
  if (size < sizeof(count) || size > kLargestMessage) {
    Reject(kUnreadable);
    return false;
  }
  buffer_.resize(size);
  ros::serialization::OStream to_buffer(buffer_.data(), static_cast<std::uint32_t>(size));
  instance.write(to_buffer);
  // Before anything is allocated: the count is the recording's claim, the size is a fact.
  std::memcpy(&count, buffer_.data(), sizeof(count));  // little-endian, as this machine is
  if (count > (size - sizeof(count)) / kSmallestTransform) {
    Reject(kUnreadable);
    return false;
  }
  try {
    ros::serialization::IStream in(buffer_.data(), static_cast<std::uint32_t>(size));
    ros::serialization::deserialize(in, message_);
  } catch (const ros::serialization::StreamOverrunException&) {
    Reject(kUnreadable);
    return false;
  }
  return true;
}

void BagSource::TakeMessage(std::int64_t record_nanos, SampleSink& sink) {
  bool found_names = false;
  for (const geometry_msgs::TransformStamped& transform : message_.transforms) {
    if (frames_.Add(WithoutSlash(transform.child_frame_id))) found_names = true;
  }
  if (found_names) frames_.Find();
  touched_.clear();
  for (const geometry_msgs::TransformStamped& transform : message_.transforms) {
    TakeTransform(transform, record_nanos);
  }
  if (touched_.empty()) ++counters_.ignored[kNobody];
  for (const int person : touched_) Give(person, sink);
}

void BagSource::TakeTransform(const geometry_msgs::TransformStamped& transform,
                              std::int64_t record_nanos) {
  const BagFrames::Place place = frames_.PlaceOf(WithoutSlash(transform.child_frame_id));
  if (place.person < 0) return;
  touched_.insert(place.person);
  if (const char* defect = DefectOf(transform.transform)) return Reject(defect);
  FrameTransform known;
  known.slot = place.slot;
  known.parent = WithoutSlash(transform.header.frame_id);
  const BagFrames::Place parent = frames_.PlaceOf(known.parent);
  known.parent_slot = parent.person == place.person ? parent.slot : -1;
  known.parent_from_child = ToPose(transform.transform);
  known.header_nanos = Nanos(transform.header.stamp);
  known.record_nanos = record_nanos;
  if (PersonAt(place.person).Add(known)) Reject(kNotWhole);
}

BagPerson& BagSource::PersonAt(int index) {
  while (people_.size() <= static_cast<std::size_t>(index)) {
    people_.emplace_back(static_cast<int>(people_.size()));
  }
  return people_[static_cast<std::size_t>(index)];
}

void BagSource::Give(int index, SampleSink& sink) {
  BagPerson& person = PersonAt(index);
  switch (person.Finish()) {
    case BagPerson::Result::kNothing: return;
    case BagPerson::Result::kDuplicate: ++counters_.duplicates; return;
    case BagPerson::Result::kNoTree: return Reject(kNoTree);
    case BagPerson::Result::kSample: break;
  }
  if (person.sample().counter == 0) {
    Character character;
    character.id = index;
    character.name = frames_.people()[static_cast<std::size_t>(index)].name;
    character.skeleton = person.MeasureSkeleton();
    sink.OnCharacter(character);
  }
  ++counters_.samples;
  sink.OnSample(person.sample());
}

}  // namespace

std::unique_ptr<Source> OpenBag(const std::string& path) {
  return std::make_unique<BagSource>(path);
}

}  // namespace kinescope::ros_bridge
