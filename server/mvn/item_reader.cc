#include "server/mvn/item_reader.h"

#include <algorithm>
#include <cmath>

namespace kinescope::mvn {
namespace {

// Finite is not enough: 1e38 m would still spoil a picture. No position, rate or angle of a human
// in m, s, rad or degrees is near this limit.
constexpr double kLargestNumber = 1e6;

constexpr double kNormTolerance = 1e-3;

// Length of the UTF-8 sequence at the start of `text`; 0 if it is invalid or a control character.
std::size_t ValidSequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool surrogate = first == 0xED && byte(1) > 0x9F;
  const bool beyond_unicode = first == 0xF4 && byte(1) > 0x8F;
  const bool control = first == 0xC2 && byte(1) < 0xA0;
  return overlong || surrogate || beyond_unicode || control ? 0 : size;
}

}  // namespace

bool ItemReader::FindLayout(const Header& header, std::size_t known_bytes, ItemLayout& layout) {
  const std::size_t payload = bytes.remaining();
  if (header.item_count == 0) {
    if (payload == 0 || payload % known_bytes != 0 || payload / known_bytes > 255) {
      return Fail(Reason::kItemCount, 0);
    }
    layout = {static_cast<int>(payload / known_bytes), known_bytes};
    return true;
  }
  const auto count = static_cast<std::size_t>(header.item_count);
  const std::size_t stride = payload / count;
  // A later MVN may append fields to an item; but room for a whole second item means a wrong count.
  if (payload % count != 0 || stride < known_bytes || stride >= 2 * known_bytes) {
    return Fail(Reason::kItemCount, header.item_count);
  }
  layout = {header.item_count, stride};
  return true;
}

bool ItemReader::ReadId(std::uint32_t& id) {
  if (!bytes.Read(id)) return Fail(Reason::kPayloadSize, 0);
  return id != 0 || Fail(Reason::kIdZero, 0);
}

bool ItemReader::ReadNumber(double& value) {
  if (!bytes.ReadFloat(value)) return Fail(Reason::kPayloadSize, 0);
  if (!std::isfinite(value)) return Fail(Reason::kNotFinite, 0);
  if (std::abs(value) > kLargestNumber) {
    return Fail(Reason::kOutOfRange, value > 0 ? 1 : -1);
  }
  return true;
}

bool ItemReader::ReadVector(Eigen::Vector3d& value) {
  return ReadNumber(value.x()) && ReadNumber(value.y()) && ReadNumber(value.z());
}

bool ItemReader::ReadUnitQuaternion(Eigen::Quaterniond& value) {
  if (!ReadNumber(value.w()) || !ReadNumber(value.x()) || !ReadNumber(value.y()) ||
      !ReadNumber(value.z())) {
    return false;
  }
  const double norm = value.norm();
  if (std::abs(norm - 1.0) > kNormTolerance) {
    return Fail(Reason::kNotUnit, static_cast<std::int64_t>(norm * 1000));
  }
  value.coeffs() /= norm;
  return true;
}

bool ItemReader::ReadText(std::string_view& text) {
  std::uint32_t length = 0;
  if (!bytes.Read(length)) return Fail(Reason::kPayloadSize, 0);
  // Negative lengths (the field is signed) are huge here, so one comparison rejects both.
  if (!bytes.ReadBytes(length, text)) return Fail(Reason::kLyingLength, length);
  return true;
}

bool ItemReader::ReadCount(std::size_t bytes_each, std::uint32_t& count) {
  if (!bytes.Read(count)) return Fail(Reason::kPayloadSize, 0);
  return count <= bytes.remaining() / bytes_each || Fail(Reason::kLyingCount, count);
}

std::string CleanText(std::string_view text, std::size_t longest) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t size = ValidSequence(text);
    if (clean.size() + std::max<std::size_t>(size, 1) > longest) break;
    if (size == 0) {
      clean.push_back('?');
    } else {
      clean.append(text.substr(0, size));
    }
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return clean;
}

}  // namespace kinescope::mvn
