/// Reads an MVNX file (versions 3 and 4) as a stream: the header, then frame by frame, as the file
/// says it. What the numbers mean is mvnx_source.h's business. Memory does not grow with the file;
/// a document type, entities and anything outside the file are refused. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/input_file.h"
#include "urdf/skeleton.h"

namespace kinescope::mvn {

struct MvnxHeader {
  int version = 0;                         // 3 or 4
  std::string subject;                     // label; "" where it has none
  std::optional<std::uint32_t> color_rgb;  // torsoColor
  double rate_hz = 0;
  std::vector<std::optional<urdf::Segment>> segments;  // in file order; none: a prop
  std::vector<std::optional<urdf::Joint>> joints;      // in file order
  urdf::Landmarks points;                              // of body segments, metres
  std::vector<std::string> foot_contacts;              // "LeftFoot_Heel", ..., in file order
};

/// The lists of a frame that are read; the others are skipped.
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
};
inline constexpr std::size_t kMvnxListCount = 9;

struct MvnxFrame {
  std::string type;                   // "normal", "tpose", ...; "" where it says none
  std::optional<std::int64_t> index;  // of a calibration frame: absent or negative
  std::optional<std::int64_t> unix_millis;
  std::array<std::vector<double>, kMvnxListCount> lists;  // empty: not in the frame

  const std::vector<double>& operator[](MvnxList list) const {
    return lists[static_cast<std::size_t>(list)];
  }
};

class MvnxReader {
 public:
  /// Reads the header; `name` is for errors.
  /// @throws SourceError naming file, line and reason: not XML, not MVNX, wrong version, a segment
  /// missing.
  MvnxReader(InputFile file, std::string name);
  ~MvnxReader();

  const MvnxHeader& header() const;

  /// The next frame; every list that is there has the length that the header asks for, and finite
  /// numbers. False after the last.
  /// @throws SourceError as above, also when the file breaks off.
  [[nodiscard]] bool Next(MvnxFrame& frame);

  /// Throws the SourceError for `reason`, with file and current line.
  [[noreturn]] void Refuse(const std::string& reason) const;

  std::uint64_t bytes_read() const;

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace kinescope::mvn
