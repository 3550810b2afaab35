/// Common steps of parsing all message types: reads numbers and texts, and remembers the first
/// error. Only for the parser. One thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/mvn/byte_order.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// Layout of the items in the payload of a message.
struct ItemLayout {
  int count = 0;
  std::size_t stride = 0;
};

class ItemReader {
 public:
  explicit ItemReader(std::string_view datagram) : bytes(datagram) {}

  ByteReader bytes;
  ParseError error;

  bool Fail(Reason reason, std::int64_t value) {
    error = {bytes.offset(), reason, value};
    return false;
  }

  /// Computes the layout of items that are at least `known_bytes` long.
  [[nodiscard]] bool FindLayout(const Header& header, std::size_t known_bytes, ItemLayout& layout);
  /// Moves to the start of item `index` in a payload that begins directly after the header.
  [[nodiscard]] bool GoTo(const ItemLayout& layout, int index) {
    return bytes.Seek(kHeaderBytes + layout.stride * static_cast<std::size_t>(index));
  }

  [[nodiscard]] bool ReadId(std::uint32_t& id);
  [[nodiscard]] bool ReadVector(Eigen::Vector3d& value);
  [[nodiscard]] bool ReadUnitQuaternion(Eigen::Quaterniond& value);  // in the stream: w x y z
  [[nodiscard]] bool ReadText(std::string_view& text);
  /// Reads a count of elements that have at least `bytes_each` bytes.
  [[nodiscard]] bool ReadCount(std::size_t bytes_each, std::uint32_t& count);

 private:
  [[nodiscard]] bool ReadNumber(double& value);
};

inline constexpr std::size_t kLongestName = 128;  // of a character, segment or point, in bytes

/// Converts a vector from the Y-up axes of types 01 and 03 to the Z-up world frame, and back.
inline Eigen::Vector3d FromYUp(const Eigen::Vector3d& yup) { return {yup.z(), yup.x(), yup.y()}; }
inline Eigen::Vector3d ToYUp(const Eigen::Vector3d& zup) { return {zup.y(), zup.z(), zup.x()}; }
inline constexpr double kMetresPerCentimetre = 0.01;

/// `text` as valid UTF-8: invalid bytes and control characters become '?'. At most `longest` bytes.
std::string CleanText(std::string_view text, std::size_t longest);

/// Parse the bodies of single types; false after setting `in.error`.
[[nodiscard]] bool ParseSegments(ItemReader& in, const Header& header, PoseMessage& out);
[[nodiscard]] bool ParseSegments(ItemReader& in, const Header& header, EulerPoseMessage& out);
[[nodiscard]] bool ParseSegments(ItemReader& in, const Header& header, LinearMessage& out);
[[nodiscard]] bool ParseSegments(ItemReader& in, const Header& header, AngularMessage& out);
[[nodiscard]] bool ParseMarkers(ItemReader& in, const Header& header, MarkersMessage& out);
[[nodiscard]] bool ParseTrackers(ItemReader& in, const Header& header, TrackersMessage& out);
[[nodiscard]] bool ParseTimeCode(ItemReader& in, TimeCodeMessage& out);
[[nodiscard]] bool ParseJointAngles(ItemReader& in, const Header& header, JointAnglesMessage& out);
[[nodiscard]] bool ParseMetaData(ItemReader& in, MetaDataMessage& out);
[[nodiscard]] bool ParseScale(ItemReader& in, ScaleMessage& out);

}  // namespace kinescope::mvn
