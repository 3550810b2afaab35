/// Adds the velocities and accelerations of link_states to the samples that /tf makes, which have
/// none. Both are recorded from one sample of the suit, with one stamp, in any order.
///
/// A sample waits for its link states until the next sample of its person; markers do not, so a
/// sample that waits gets those that come meanwhile. A bag without link_states is read as if this
/// was not here. One thread.
#pragma once

#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <cstddef>
#include <deque>
#include <map>

#include "core/source.h"

namespace kinescope::ros_bridge {

class MotionJoiner : public SampleSink {
 public:
  /// Messages of link states will come.
  void Expect() { are_there_ = true; }
  /// Where samples go from now on; not null while samples come.
  void SetSink(SampleSink* sink) { sink_ = sink; }

  /// False: the message cannot be used, and was counted.
  bool Take(const xsens_mvn_ros_msgs::LinkStateArray& message, SourceCounters& counters);
  /// Delivers the samples that wait.
  void Flush();

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& objects) override { sink_->OnObjects(objects); }
  void OnSurroundings(const RecordedSurroundings& all) override { sink_->OnSurroundings(all); }

 private:
  static constexpr std::size_t kMostMessages = 32;  // that no sample has been found for yet

  void FlushOf(int character);
  static bool Join(const xsens_mvn_ros_msgs::LinkStateArray& message, BodySample& sample);

  SampleSink* sink_ = nullptr;
  bool are_there_ = false;             // messages of link states have come, or will
  std::map<int, BodySample> waiting_;  // by character
  std::deque<xsens_mvn_ros_msgs::LinkStateArray> early_;
};

}  // namespace kinescope::ros_bridge
