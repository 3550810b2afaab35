/// Reads an MVNX file as a source: one sample per call, in segment frames, on the clock of the
/// file. One thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/source.h"
#include "server/mvn/file/mvnx_reader.h"

namespace kinescope::mvn {

/// - Calibration frames are excluded by their type and counted as `ignored`.
/// - counter = frame index; time code = index / frame rate; stamp = `ms` of the first motion frame
///   + (index - first index) / rate, because `ms` is rounded. A file without `ms` begins 1 s after
///   the Unix epoch (stamp 0 would mean "no time" in ROS).
/// - Neighbouring quaternions never change sign. Version 3 arms, which are about anatomical axes,
///   are converted to segment frames.
/// - Joint angles (jointAngle, degrees), centre of mass, derivatives and foot contacts are present
///   if the frame has them; contacts are assigned by the labels of footContactDefinition, in any
///   order.
/// - Trackers are present if the frame has orientation, acceleration and magnetic field of the
///   sensors. Version 4 has no acceleration with gravity and no angular velocity of them.
class MvnxSource : public Source {
 public:
  /// Reads the header; `name` is for messages. @throws SourceError.
  MvnxSource(InputFile file, std::string name);

  [[nodiscard]] State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;
  SourceCounters counters() const override;
  std::string description() const override { return name_; }
  bool is_live() const override { return false; }
  double nominal_rate_hz() const override { return reader_.header().rate_hz; }

  const Character& character() const { return character_; }

 private:
  void CheckFrame();
  BodySample ToSample();
  void FillSegments(BodySample& sample);
  void FillAngles(BodySample& sample) const;
  void FillContacts(BodySample& sample) const;
  void FillTrackers(BodySample& sample) const;
  void FillTimes(BodySample& sample) const;

  std::string name_;
  MvnxReader reader_;
  MvnxFrame frame_;
  Character character_;
  bool character_given_ = false;
  std::optional<std::int64_t> first_index_;
  bool has_time_of_day_ = false;
  std::int64_t first_unix_nanos_ = 0;
  std::int64_t index_ = 0;  // of the newest sample
  std::array<Eigen::Quaterniond, urdf::kSegmentCount> previous_;
  SourceCounters counters_;
};

}  // namespace kinescope::mvn
