/// Adds the velocities and accelerations of link_states to the samples that /tf makes, which have
/// none. Both are recorded from one sample of the suit, with one stamp, in any order: a recorder on
/// a busy computer writes some messages of one topic, then those of the other.
///
/// A sample waits for its link states, and all that comes after it waits with it, so the order
/// stays. It goes on without them when a later sample of its person has some, or when too many
/// samples wait. Of a person without link states only the first samples wait. A bag without
/// link_states is read as if this was not here. One thread.
#pragma once

#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <variant>

#include "core/source.h"

namespace kinescope::ros_bridge {

class MotionJoiner : public SampleSink {
 public:
  static constexpr std::size_t kMostWaiting = 128;  // samples of a person: half a second at 240 Hz

  /// Messages of link states will come.
  void Expect() { are_there_ = true; }
  /// Where samples go from now on; not null while samples come.
  void SetSink(SampleSink* sink) { sink_ = sink; }

  /// False: the message cannot be used, and was counted.
  bool Take(const xsens_mvn_ros_msgs::LinkStateArray& message, SourceCounters& counters);
  /// Delivers all that waits.
  void Flush();

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& objects) override;
  void OnSurroundings(const RecordedSurroundings& all) override;

 private:
  struct Stamped {
    std::int64_t stamp_nanos = 0;
    xsens_mvn_ros_msgs::LinkStateArray message;
  };
  struct Event {
    std::variant<Character, BodySample, ObjectsSample, RecordedSurroundings> content;
    bool waits = false;  // a sample: for its link states
  };

  template <class Content>
  void Queue(const Content& content, bool waits = false);
  void Deliver();                               // those at the front that do not wait
  void GiveUp(int character, std::size_t end);  // its samples among the first `end` events
  bool JoinWaiting(const Stamped& link_states);
  bool JoinEarly(BodySample& sample);
  static bool Join(const Stamped& link_states, BodySample& sample);

  SampleSink* sink_ = nullptr;
  bool are_there_ = false;  // messages of link states have come, or will
  std::deque<Event> queue_;
  std::map<int, std::size_t> without_;  // by character: samples in a row that found none
  std::deque<Stamped> early_;           // no sample has been found for them yet
};

}  // namespace kinescope::ros_bridge
