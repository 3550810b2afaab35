#include "server/ros/source/bag_source.h"

#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <vector>

#include "core/system/errors.h"
#include "server/ros/raw_message.h"
#include "server/ros/source/bag_file.h"
#include "server/ros/source/transform_people.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

constexpr int kMessagesPerPoll = 256;
constexpr std::int64_t kNamesNanos = 10'000'000'000;  // read on opening for frame names

constexpr char kUnreadableTransforms[] =
    "message on /tf that is truncated or has a wrong length field";
constexpr char kOtherType[] = "message on /tf that is not a TFMessage";

bool IsStatic(const std::string& topic) { return topic == "/tf_static" || topic == "tf_static"; }
bool IsMoving(const std::string& topic) { return topic == "/tf" || topic == "tf"; }

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
  /// False if nothing of it can be used; counts the reason.
  bool Decode(const rosbag::MessageInstance& instance);
  void Reject(const char* reason) { ++counters_.rejected[reason]; }

  // Converts exceptions of rosbag to one line.
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
      throw fail(std::string("is damaged (") + error.what() + "); `rosbag fix` may repair it");
    } catch (const std::exception& error) {
      throw fail(std::string("is truncated or damaged (") + error.what() +
                 "); `rosbag reindex` may repair it");
    }
  }

  const std::string name_;
  BagFile file_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;  // of /tf and /tf_static
  rosbag::View::iterator next_;
  std::vector<std::uint8_t> buffer_;
  tf2_msgs::TFMessage message_;
  TransformPeople people_{0};
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
  bool has_transforms = false;
  for (const auto& [topic, connection] : topics) {
    has_transforms = has_transforms || IsMoving(topic);
    if (IsMoving(topic) || IsStatic(topic)) {
      used.push_back(topic);
      continue;
    }
    const std::uint64_t messages = rosbag::View(bag_, rosbag::TopicQuery(topic)).size();
    counters_.ignored["topic " + topic + " (" + connection->datatype + ")"] = messages;
    counters_.datagrams += messages;
  }
  if (!has_transforms) {
    throw SourceError("bag '" + name_ +
                      "': contains no /tf topic, so no poses; record it with `rosbag record /tf`");
  }
  view_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(used));
  const SourceCounters before = counters_;
  ReadNames();
  counters_ = before;  // the same messages will be read again as samples
  next_ = view_->begin();
}

void BagSource::ReadNames() {
  std::map<std::string, Appearances> appearances;
  std::int64_t end = 0;
  for (const rosbag::MessageInstance& instance : *view_) {
    const std::int64_t now = ToNanos(instance.getTime());
    if (end == 0) end = now + kNamesNanos;
    if (now > end && people_.people().empty()) people_.FindPeople();
    if (now > end && !people_.people().empty()) break;
    if (!Decode(instance)) continue;
    for (const geometry_msgs::TransformStamped& transform : message_.transforms) {
      if (!people_.AddName(transform.child_frame_id)) continue;
      Appearances& of_frame = appearances[WithoutSlash(transform.child_frame_id)];
      if (of_frame.count++ == 0) of_frame.first_nanos = now;
      of_frame.last_nanos = now;
    }
  }
  people_.FindPeople();
  if (people_.people().empty()) {
    throw SourceError("bag '" + name_ +
                      "': no person found on /tf; expected 23 frames with segment names, such as "
                      "skeleton_pelvis, skeleton_l5, ..., skeleton_left_toe");
  }
  const Appearances& pelvis = appearances[people_.people().front().frames[urdf::kPelvis]];
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
      people_.End(counters_);
      return State::kEnded;
    }
    const rosbag::MessageInstance& instance = *next_;
    ++counters_.datagrams;
    counters_.bytes += instance.size();
    if (Decode(instance)) {
      if (IsStatic(instance.getTopic())) {
        people_.TakeStatic(message_, counters_);
      } else {
        people_.Take(message_, {ToNanos(instance.getTime()), 0}, counters_, sink);
      }
    }
    ++next_;
  }
  return State::kMore;
}

bool BagSource::Decode(const rosbag::MessageInstance& instance) {
  // tf/tfMessage in old recordings is the same message with another name.
  if (instance.getMD5Sum() != ros::message_traits::md5sum<tf2_msgs::TFMessage>()) {
    Reject(kOtherType);
    return false;
  }
  if (instance.size() > kLargestMessage) {
    Reject(kUnreadableTransforms);
    return false;
  }
  buffer_.resize(instance.size());
  ros::serialization::OStream to_buffer(buffer_.data(), instance.size());
  instance.write(to_buffer);
  if (kinescope::ros_bridge::Decode(buffer_, message_)) return true;
  Reject(kUnreadableTransforms);
  return false;
}

}  // namespace

std::unique_ptr<Source> OpenBag(const std::string& path) {
  return std::make_unique<BagSource>(path);
}

}  // namespace kinescope::ros_bridge
