/// The measured forces of a file at the times of the samples. The file is checked once from begin
/// to end; then only the rows around the newest time are kept. One thread.
///
/// A plate measures faster than a suit, and single rows would alias its vibration into the loads.
/// So a sample gets the mean over its own time, of the straight lines between the rows; the time is
/// shortened by that between two rows. Rows as rare as samples are therefore interpolated.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "core/force_inputs.h"
#include "server/wrenches/wrench_reader.h"
#include "server/wrenches/wrench_row.h"

namespace kinescope::wrenches {

/// Rows further apart, s, are a gap: no values between them.
constexpr double kLongestGap = 0.1;

struct BodyWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N·m, about the world's origin; without
                                                     // `point` about the grip of the hand
  std::optional<Eigen::Vector3d> point;              // m, that of the nearest row
};

/// By WrenchBody; nullopt: not measured at the time.
using BodyWrenches = std::array<std::optional<BodyWrench>, kWrenchBodyCount>;

class WrenchTrack {
 public:
  /// Reads the file of the settings.
  /// @throws SourceError with file, line, value and what was expected; UsageError if options do not
  /// fit the file.
  explicit WrenchTrack(WrenchSettings settings);

  /// Whether the file has rows of `body`.
  bool Has(WrenchBody body) const { return has_[At(body)]; }
  const std::string& path() const { return settings_.path; }

  /// The forces `secs` after the first sample; `period`: time of one sample, s. An earlier time
  /// than that of the last call reads the file again.
  /// @throws SourceError if the file has changed.
  BodyWrenches MeanAt(double secs, double period);

 private:
  struct Knot {
    double secs;
    BodyWrench wrench;
  };
  using Knots = std::deque<Knot>;

  std::unique_ptr<WrenchReader> Open() const;
  void CheckFile();
  void Rewind();
  void Seek(double secs, double period);
  static std::optional<BodyWrench> MeanOf(const Knots& knots, double secs, double period);

  const WrenchSettings settings_;
  const WrenchFormat format_;
  std::array<bool, kWrenchBodyCount> has_{};

  std::unique_ptr<WrenchReader> rows_;  // null: all were read
  std::array<Knots, kWrenchBodyCount> knots_;
  double newest_secs_, asked_secs_;
};

/// The force on feet or ground: where its line of action meets the floor. Below kMinGroundForce: no
/// force, at `last_point`. A force without horizontal part counts as that of a one-axis plate.
MeasuredGroundForce GroundForceOf(const BodyWrench& wrench, double floor_z,
                                  const Eigen::Vector3d& last_point);

/// @pre `wrench` is of a hand
MeasuredHandForce HandForceOf(const BodyWrench& wrench);

}  // namespace kinescope::wrenches
