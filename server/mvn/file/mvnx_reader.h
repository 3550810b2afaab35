/// Reads an MVNX file (versions 3 and 4) as a stream: first the header, then frame by frame,
/// without interpretation; mvnx_source.h interprets the numbers. Memory use does not grow with the
/// file. A document type, entities and references outside the file are rejected. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/system/input_file.h"
#include "urdf/landmarks.h"

namespace kinescope::mvn {

struct MvnxHeader {
  int version = 0;                         // 3 or 4
  std::string subject;                     // label; "" if it has none
  std::optional<std::uint32_t> color_rgb;  // torsoColor
  double rate_hz = 0;
  std::vector<std::optional<urdf::Segment>> segments;  // in file order; absent: a prop
  std::vector<std::optional<urdf::Joint>> joints;      // in file order
  urdf::Landmarks points;                              // of body segments, in file order
  std::vector<std::optional<urdf::Segment>> sensors;   // in file order, by what carries them
  std::vector<std::string> foot_contacts;              // "LeftFoot_Heel", ..., in file order
};

/// The lists of a frame that are read; all others are skipped.
enum class MvnxList {
  kOrientation,
  kPosition,
  kVelocity,
  kAcceleration,
  kAngularVelocity,
  kAngularAcceleration,
  kJointAngle,
  kCenterOfMass,
  kFootContacts,
  kSensorOrientation,
  kSensorFreeAcceleration,  // version 4
  kSensorAcceleration,      // version 3
  kSensorAngularVelocity,   // version 3
  kSensorMagneticField,
};
inline constexpr std::size_t kMvnxListCount = 14;

constexpr bool IsOfSensors(MvnxList list) { return list >= MvnxList::kSensorOrientation; }

struct MvnxFrame {
  std::string type;                   // "normal", "tpose", ...; "" if absent
  std::optional<std::int64_t> index;  // absent or negative for a calibration frame
  std::optional<std::int64_t> unix_millis;
  std::array<std::vector<double>, kMvnxListCount> lists;  // empty: not in the frame

  const std::vector<double>& operator[](MvnxList list) const {
    return lists[static_cast<std::size_t>(list)];
  }
};

class MvnxReader {
 public:
  /// Reads the header; `name` is for messages.
  /// @throws SourceError with file, line and reason: not XML, not MVNX, wrong version, a missing
  /// segment.
  MvnxReader(InputFile file, std::string name);
  ~MvnxReader();

  const MvnxHeader& header() const;

  /// Reads the next frame. Every list that it contains has the length that the header requires, and
  /// finite numbers. False after the last frame.
  /// @throws SourceError as above, also if the file is truncated.
  [[nodiscard]] bool Next(MvnxFrame& frame);

  /// Throws a SourceError with file, current line and `reason`.
  [[noreturn]] void Refuse(const std::string& reason) const;

  std::uint64_t bytes_read() const;

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace kinescope::mvn
