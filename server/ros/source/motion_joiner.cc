#include "server/ros/source/motion_joiner.h"

#include <cstdlib>

#include "server/ros/source/link_motion.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kSameNanos = 1000;  // stamps are whole microseconds in some programs
constexpr double kSamePlace = 1e-3;        // m; several people have samples of one stamp

}  // namespace

// False if the message is not of this sample.
bool MotionJoiner::Join(const xsens_mvn_ros_msgs::LinkStateArray& message, BodySample& sample) {
  LinkStatesBySegment states{};
  if (FindLinks(message, states) != nullptr) return false;
  if (std::abs(StampOf(message, states) - sample.stamp_nanos) > kSameNanos) return false;
  const auto& at = states[urdf::kPelvis]->pose.position;
  const Eigen::Vector3d apart =
      Eigen::Vector3d(at.x, at.y, at.z) - sample.segments[urdf::kPelvis].position;
  if (!(apart.norm() < kSamePlace)) return false;
  AddMotion(states, sample);
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
  for (auto waiting = waiting_.begin(); waiting != waiting_.end(); ++waiting) {
    if (!Join(message, waiting->second)) continue;
    sink_->OnSample(waiting->second);
    waiting_.erase(waiting);
    return true;
  }
  early_.push_back(message);
  if (early_.size() > kMostMessages) early_.pop_front();
  return true;
}

void MotionJoiner::Flush() {
  for (const auto& [character, sample] : waiting_) sink_->OnSample(sample);
  waiting_.clear();
}

void MotionJoiner::FlushOf(int character) {
  const auto waiting = waiting_.find(character);
  if (waiting == waiting_.end()) return;
  sink_->OnSample(waiting->second);
  waiting_.erase(waiting);
}

// Another person's sample goes on waiting: its link states may be the next message.
void MotionJoiner::OnCharacter(const Character& character) {
  FlushOf(character.id);
  sink_->OnCharacter(character);
}

void MotionJoiner::OnSample(const BodySample& sample) {
  FlushOf(sample.character);
  if (!are_there_) return sink_->OnSample(sample);
  BodySample joined = sample;
  for (auto message = early_.begin(); message != early_.end(); ++message) {
    if (!Join(*message, joined)) continue;
    early_.erase(message);
    return sink_->OnSample(joined);
  }
  waiting_.emplace(sample.character, sample);
}

}  // namespace kinescope::ros_bridge
