/// What ROS hears beside the samples: whether the stream is live, diagnostics of stream and alarms,
/// marks and the log; and marks that come from ROS. Reading thread only, except where stated.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "core/system/latest.h"
#include "core/system/line_limit.h"
#include "server/alarms/alarms.h"
#include "server/app/log.h"
#include "server/app/serve/stream_health.h"
#include "server/marks/mark_book.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

/// One diagnosis of the stream, of each clock, and of each rule. `state` may be null.
std::vector<ros_bridge::Diagnosis> DiagnosesOf(const SceneState* state, const StreamHealth& stream,
                                               const alarms::Alarms& alarms);

class RosNews {
 public:
  /// `marks` and `log` may be null. All references are borrowed.
  RosNews(ros_bridge::RosBridge& ros, const alarms::Alarms& alarms, marks::MarkBook* marks,
          const Latest<SceneState>& states, std::shared_ptr<LogTail> log);

  /// An alarm has changed: its diagnosis is due. Any thread.
  void OnAlarm() { is_due_ = true; }
  /// Call it many times a second.
  void OnTime(std::int64_t now_nanos, const StreamHealth& stream);
  /// Marks the newest sample with a text of `~mark`; "1" to "9" mean the mark of that button.
  void OnMark(const std::string& text);

 private:
  void PublishMarks();
  void PublishState(std::int64_t now_nanos);
  void PublishLog();

  ros_bridge::RosBridge& ros_;
  const alarms::Alarms& alarms_;
  marks::MarkBook* const marks_;
  const Latest<SceneState>& states_;
  std::atomic<bool> is_due_{true};
  std::int64_t diagnosed_nanos_ = 0;
  std::uint64_t published_revision_;  // of the marks
  LineLimit refused_marks_;
  const std::shared_ptr<LogTail> log_;
  std::deque<LogLine> unheard_;  // lines of the log
  std::string published_state_;
  std::int64_t stale_since_ = 0;  // monotonic clock; 0: it is not
};

}  // namespace kinescope::app
