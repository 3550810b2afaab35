#include "server/ros/source/motion_joiner.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "server/ros/source/link_motion.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kSameNanos = 1000;  // stamps are whole microseconds in some programs
constexpr double kSamePlace = 1e-3;        // m; several people have samples of one stamp

struct Delivery {
  void operator()(const Character& character) const { to.OnCharacter(character); }
  void operator()(const BodySample& sample) const { to.OnSample(sample); }
  void operator()(const ObjectsSample& objects) const { to.OnObjects(objects); }
  void operator()(const RecordedSurroundings& all) const { to.OnSurroundings(all); }
  SampleSink& to;
};

}  // namespace

// False if the message is not of this sample.
bool MotionJoiner::Join(const Stamped& link_states, BodySample& sample) {
  if (std::abs(link_states.stamp_nanos - sample.stamp_nanos) > kSameNanos) return false;
  LinkStatesBySegment states{};
  if (FindLinks(link_states.message, states) != nullptr) return false;
  const auto& at = states[urdf::kPelvis]->pose.position;
  const Eigen::Vector3d apart =
      Eigen::Vector3d(at.x, at.y, at.z) - sample.segments[urdf::kPelvis].position;
  if (!(apart.norm() < kSamePlace)) return false;
  AddMotion(states, sample);
  return true;
}

void MotionJoiner::GiveUp(int character, std::size_t end) {
  for (std::size_t i = 0; i < end; ++i) {
    const auto* const sample = std::get_if<BodySample>(&queue_[i].content);
    if (sample != nullptr && sample->character == character) queue_[i].waits = false;
  }
}

// Link states come in their order: samples of the same person before this one have none.
bool MotionJoiner::JoinWaiting(const Stamped& link_states) {
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (!queue_[i].waits) continue;
    auto& sample = std::get<BodySample>(queue_[i].content);
    if (!Join(link_states, sample)) continue;
    without_[sample.character] = 0;
    GiveUp(sample.character, i + 1);
    return true;
  }
  return false;
}

bool MotionJoiner::JoinEarly(BodySample& sample) {
  const auto found = std::find_if(early_.begin(), early_.end(),
                                  [&](const Stamped& each) { return Join(each, sample); });
  if (found == early_.end()) return false;
  early_.erase(found);
  return true;
}

bool MotionJoiner::Take(const xsens_mvn_ros_msgs::LinkStateArray& message,
                        SourceCounters& counters) {
  LinkStatesBySegment states{};
  if (const char* const defect = FindLinks(message, states)) {
    ++counters.rejected[defect];
    return false;
  }
  are_there_ = true;
  Stamped link_states{StampOf(message, states), message};
  if (JoinWaiting(link_states)) {
    Deliver();
    return true;
  }
  early_.push_back(std::move(link_states));
  if (early_.size() > kMostWaiting) {
    early_.pop_front();
    without_.clear();  // a person's link states come again
  }
  return true;
}

template <class Content>
void MotionJoiner::Queue(const Content& content, bool waits) {
  if (queue_.empty() && !waits) return Delivery{*sink_}(content);
  queue_.push_back({content, waits});
}

void MotionJoiner::Deliver() {
  for (; !queue_.empty() && !queue_.front().waits; queue_.pop_front()) {
    std::visit(Delivery{*sink_}, queue_.front().content);
  }
}

void MotionJoiner::Flush() {
  for (Event& event : queue_) event.waits = false;
  Deliver();
}

void MotionJoiner::OnSample(const BodySample& sample) {
  if (!are_there_) return Queue(sample);
  BodySample joined = sample;
  std::size_t& without = without_[sample.character];
  if (JoinEarly(joined)) {
    without = 0;
    return Queue(joined);
  }
  const bool waits = without < kMostWaiting;
  if (waits) ++without;
  Queue(sample, waits);
  if (!waits) GiveUp(sample.character, queue_.size());
  Deliver();
}

void MotionJoiner::OnCharacter(const Character& character) { Queue(character); }
void MotionJoiner::OnObjects(const ObjectsSample& objects) { Queue(objects); }
void MotionJoiner::OnSurroundings(const RecordedSurroundings& all) { Queue(all); }

}  // namespace kinescope::ros_bridge
