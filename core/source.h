/// Interface of all sources of samples: sockets, files, the ROS graph, the built-in subject. A
/// source is used by one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/body_sample.h"
#include "core/camera_image.h"
#include "core/duration_histogram.h"
#include "core/node_clock.h"
#include "core/playback.h"
#include "core/robot_state.h"
#include "core/scene_marker.h"
#include "core/system/clocks.h"

namespace kinescope {

/// Statistics of a source. Every datagram is counted in exactly one place: as part of a sample or
/// character, under a reason in `rejected`, in `ignored`, `duplicates`, `late` or `outliers`.
struct SourceCounters {
  std::uint64_t datagrams = 0;  // all that were read
  std::uint64_t bytes = 0;
  std::uint64_t samples = 0;     // delivered
  std::uint64_t incomplete = 0;  // of these, delivered without a type that the stream normally
                                 // contains
  std::uint64_t duplicates = 0;
  std::uint64_t late = 0;          // datagrams of a sample that was already delivered
  std::uint64_t counter_gaps = 0;  // steps of the sample counter above the usual step
  std::uint64_t lost = 0;          // samples that never came, as the counter shows
  std::uint64_t restarts = 0;      // the counter started over
  std::uint64_t outliers = 0;      // inconsistent counter or character, not confirmed by another
                                   // datagram
  std::map<std::string, std::uint64_t> types;     // datagrams read, by type: "02"
  std::map<std::string, std::uint64_t> ignored;   // valid but not needed: "frame of type tpose"
  std::map<std::string, std::uint64_t> rejected;  // invalid, by reason: "no MXTP id string"
  /// Of the samples: by how much each came later than the fastest ones of the seconds before, by
  /// the sender's clock. Empty for a source without such a clock.
  DurationHistogram delays;
  /// Of a recording that begins later than its first sample: how far it has been passed over, ns
  /// after that one; 0 once it begins.
  std::int64_t passed_nanos = 0;
  /// What is wrong with samples that were delivered, now, in sentences without a full stop: people
  /// whose frames TF does not connect.
  std::vector<std::string> problems;
  /// Of a ROS graph: the clocks of the nodes whose people are read.
  std::vector<NodeClock> clocks;
  /// Counters of the transport, such as "receive_buffer_bytes" or "connections_open"; empty without
  /// a transport.
  std::map<std::string, std::uint64_t> transport;
};

/// What a recording has beside the people, in the world frame.
struct RecordedSurroundings {
  MarkerList markers;
  RobotList robots;
  ImageList images;
  std::optional<urdf::Pose> camera_base = {};  // SceneState::camera_base
};

/// A moment of a source that has no person: of a ROS graph, or of a bag, of robots and what is
/// about them.
struct SourceMoment {
  std::int64_t stamp_nanos = 0;    // as BodySample::stamp_nanos
  std::int64_t arrival_nanos = 0;  // as BodySample::arrival_nanos; 0: from a file
};

class SampleSink {
 public:
  virtual ~SampleSink() = default;
  virtual void OnCharacter(const Character& character) = 0;
  virtual void OnSample(const BodySample& sample) = 0;
  virtual void OnObjects(const ObjectsSample&) {}
  /// Those of a recording from the next sample on, in place of those before.
  virtual void OnSurroundings(const RecordedSurroundings&) {}
  /// Takes the place of samples, in ascending order of time, while there is no person: before the
  /// first sample, and in a recording also after people have left.
  virtual void OnMoment(const SourceMoment&) {}
};

class Source {
 public:
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  enum class State { kMore, kEnded };

  /// Waits at most `timeout` for input and delivers the samples to `sink` on the calling thread. A
  /// live source never ends. A file delivers a few samples per call without pacing, with stamps
  /// from the file's clock.
  /// @throws SourceError if it cannot continue (a truncated file, a socket that fails).
  [[nodiscard]] virtual State Poll(std::chrono::milliseconds timeout, SampleSink& sink) = 0;

  /// Of a live source that is not read any more: delivers the samples that still wait for a part of
  /// them.
  virtual void Flush(SampleSink&) {}

  virtual SourceCounters counters() const = 0;
  virtual std::string description() const = 0;  // "udp://0.0.0.0:9763", for messages
  virtual bool is_live() const = 0;  // true: samples arrive in real time; false: as fast as polled

  /// Samples per second as the source states it (a file, the subject); 0 if only the receive times
  /// show it.
  virtual double nominal_rate_hz() const { return 0; }

  /// The moment up to which it has been read, monotonic clock: now, unless its samples come faster
  /// than they were measured.
  virtual std::int64_t now_nanos() const { return MonotonicNanos(); }

  /// Of a source that is played at its true rate, once its first sample has been delivered: when it
  /// began, and the time of a round once that is known.
  virtual std::optional<Playback> playback() const { return std::nullopt; }

 protected:
  Source() = default;
};

}  // namespace kinescope
