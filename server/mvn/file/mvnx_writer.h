/// Writes MVNX 4 as MVN orders it (biomech-files.md A.3): one element per line, nested by tabs, for
/// readers that depend on it. Numbers are the shortest text that reads back as the same double, so
/// MvnxSource returns what was written. Appends text; memory does not grow with the recording.
/// One thread.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/body_sample.h"

namespace kinescope::mvn {

/// What stands before the frames.
struct MvnxSubject {
  std::string label;                       // of the person; "": unknown
  std::optional<std::uint32_t> color_rgb;  // 0xRRGGBB
  double rate_hz = 0;                      // of the frame index
  urdf::Skeleton skeleton;
  urdf::Landmarks landmarks;  // as read; joints that are missing are added from the skeleton
  std::bitset<urdf::kSegmentCount> sensors;  // which trackers the frames have
  bool has_foot_contacts = false;
  std::optional<std::int64_t> began_nanos;  // Unix time, ns; absent: unknown
  std::string original_file;                // where the motion comes from
  std::string program;                      // who writes
  std::string comment;                      // for people and programs: provenance
};

class MvnxWriter {
 public:
  explicit MvnxWriter(MvnxSubject subject) : subject_(std::move(subject)) {}

  /// Everything up to the calibration frames. They show the T-pose of the skeleton: a source has
  /// none that was recorded.
  void AppendHead(std::string& out) const;

  /// A motion frame with all that the sample has; `index` counts from 0 at the rate of the subject.
  /// Joint angles are those of the sample, or computed from its orientations; the angles that no
  /// stream has are always computed. Trackers are written if the sample has all of
  /// MvnxSubject::sensors. The orientation of a segment never changes its sign.
  /// @pre all numbers are finite; indices ascend
  void AppendFrame(const BodySample& sample, std::int64_t index, std::string& out);

  void AppendTail(std::string& out) const;

 private:
  void AppendSegments(std::string& out) const;
  void AppendDefinitions(std::string& out) const;
  void AppendCalibration(const char* type, bool is_isb, std::string& out) const;
  void AppendTimes(const BodySample& sample, std::int64_t index, std::string& out) const;
  void AppendTrackers(const BodySample& sample, std::string& out) const;

  const MvnxSubject subject_;
  std::optional<urdf::SegmentOrientations> previous_;
};

}  // namespace kinescope::mvn
