/// An MVNX file as a source: one sample a call, in body frames, on the file's own clock. One
/// thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/source.h"
#include "server/mvn/file/mvnx_reader.h"

namespace kinescope::mvn {

/// In version 3 files the orientations of upper arms, forearms and hands are those of anatomical
/// (ISB) axes: world_from_isb = world_from_segment * SegmentFromIsb(segment). Identity elsewhere.
/// Joint angles of every version are about these axes.
const Eigen::Quaterniond& SegmentFromIsb(int segment);

/// - Calibration frames are kept out by their type and counted as `ignored`.
/// - counter = frame index; time code = index / frame rate; stamp = `ms` of the first frame of
/// motion plus
///   (index - first index) / rate, since `ms` itself is rounded. A file without `ms` begins 1 s
///   after the Unix epoch (stamp 0 would mean "no time" to ROS).
/// - Neighbouring quaternions never change sign. Version 3 arms are converted to segment frames.
/// - Joint angles (jointAngle, degrees), centre of mass, derivatives and foot contacts where the
///   frame has them; contacts by the labels of footContactDefinition, whatever their order.
class MvnxSource : public Source {
 public:
  /// Reads the header; `name` is for people. @throws SourceError.
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
  void FillTimes(BodySample& sample) const;

  std::string name_;
  MvnxReader reader_;
  MvnxFrame frame_;
  Character character_;
  bool character_given_ = false;
  std::optional<std::int64_t> first_index_;
  std::int64_t first_unix_nanos_ = 0;
  std::int64_t index_ = 0;  // of the newest sample
  std::array<Eigen::Quaterniond, urdf::kSegmentCount> previous_;
  SourceCounters counters_;
};

}  // namespace kinescope::mvn
