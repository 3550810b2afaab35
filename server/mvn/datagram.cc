#include "server/mvn/datagram.h"

#include <algorithm>
#include <utility>

#include "server/mvn/datagram_extent.h"
#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

// Classifies bytes that do not begin with "MXTP": MVN's own sync texts, text of another program, or
// other bytes.
Reason ReasonForForeign(std::string_view datagram) {
  const std::size_t first = datagram.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos) {
    if (datagram[first] == '{' || datagram[first] == '[') return Reason::kJsonText;
    if (datagram[first] == '<') return Reason::kXmlText;
  }
  const bool is_text = std::all_of(datagram.begin(), datagram.end(), [](char c) {
    return (c >= ' ' && c <= '~') || c == '\t' || c == '\r' || c == '\n';
  });
  return is_text ? Reason::kForeignText : Reason::kForeign;
}

// The type of `digits`, or why it is not supported.
tl::expected<Type, Reason> FindType(std::string_view digits) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (!is_digit(digits[0]) || !is_digit(digits[1])) return tl::unexpected(Reason::kUnknownType);
  switch (const int number = (digits[0] - '0') * 10 + (digits[1] - '0')) {
    case 1:
    case 2:
    case 3:
    case 12:
    case 13:
    case 20:
    case 21:
    case 22:
    case 23:
    case 24:
    case 25: return static_cast<Type>(number);
    case 4: return tl::unexpected(Reason::kType04);
    case 5: return tl::unexpected(Reason::kType05);
    case 10: return tl::unexpected(Reason::kType10);
    case 11: return tl::unexpected(Reason::kType11);
    default: return tl::unexpected(Reason::kUnknownType);
  }
}

// Reads a number into a wider field, so that arithmetic with it is signed.
template <class Unsigned>
[[nodiscard]] bool ReadInt(ByteReader& in, int& value) {
  Unsigned number = 0;
  if (!in.Read(number)) return false;
  value = number;
  return true;
}

bool ReadHeader(ItemReader& in, std::string_view datagram, Header& header) {
  if (datagram.empty()) return in.Fail(Reason::kEmpty, 0);
  constexpr std::string_view kMagic = "MXTP";
  const std::string_view start = datagram.substr(0, kMagic.size());
  if (start != kMagic.substr(0, start.size())) return in.Fail(ReasonForForeign(datagram), 0);
  const auto cut_short = [&] {
    return in.Fail(Reason::kShortHeader, static_cast<std::int64_t>(datagram.size()));
  };
  if (datagram.size() < kHeaderBytes) return cut_short();
  std::string_view id_string;
  if (!in.bytes.ReadBytes(kIdStringBytes, id_string)) return cut_short();
  const auto type = FindType(id_string.substr(kMagic.size()));
  if (!type) return in.Fail(type.error(), 0);
  header.type = *type;
  int datagram_counter = 0;
  std::uint16_t reserved = 0;  // not checked, because a later version may use it
  const bool is_whole =
      in.bytes.Read(header.sample_counter) && ReadInt<std::uint8_t>(in.bytes, datagram_counter) &&
      ReadInt<std::uint8_t>(in.bytes, header.item_count) &&
      in.bytes.Read(header.time_code_millis) && ReadInt<std::uint8_t>(in.bytes, header.character) &&
      ReadInt<std::uint8_t>(in.bytes, header.body_segments) &&
      ReadInt<std::uint8_t>(in.bytes, header.props) &&
      ReadInt<std::uint8_t>(in.bytes, header.finger_segments) && in.bytes.Read(reserved) &&
      ReadInt<std::uint16_t>(in.bytes, header.payload_bytes);
  if (!is_whole) return cut_short();
  header.part = datagram_counter & 0x7F;
  header.is_last_part = (datagram_counter & 0x80) != 0;
  return true;
}

// Limits reading to the payload: the size in the header if there is one, else the end of the
// datagram.
bool LimitToPayload(ItemReader& in, const Header& header) {
  const auto announced = static_cast<std::size_t>(header.payload_bytes);
  if (announced > in.bytes.remaining()) return in.Fail(Reason::kShortPayload, header.payload_bytes);
  if (announced > 0) in.bytes.CutAt(kHeaderBytes + announced);
  return true;
}

bool ParseBody(ItemReader& in, const Header& header, JointAnglesMessage& out) {
  return ParseJointAngles(in, header, out);
}

bool ParseBody(ItemReader& in, const Header&, CenterOfMassMessage& out) {
  constexpr std::size_t kPositionOnly = 12;
  constexpr std::size_t kWhole = 36;
  const std::size_t payload = in.bytes.remaining();
  if (payload != kPositionOnly && payload < kWhole) {
    return in.Fail(Reason::kPayloadSize, static_cast<std::int64_t>(payload));
  }
  out.has_derivatives = payload >= kWhole;
  if (!in.ReadVector(out.position)) return false;
  return !out.has_derivatives || (in.ReadVector(out.velocity) && in.ReadVector(out.acceleration));
}

bool ParseBody(ItemReader& in, const Header&, MetaDataMessage& out) {
  return ParseMetaData(in, out);
}
bool ParseBody(ItemReader& in, const Header&, ScaleMessage& out) { return ParseScale(in, out); }

bool ParseBody(ItemReader& in, const Header& header, MarkersMessage& out) {
  return ParseMarkers(in, header, out);
}
bool ParseBody(ItemReader& in, const Header& header, TrackersMessage& out) {
  return ParseTrackers(in, header, out);
}
bool ParseBody(ItemReader& in, const Header&, TimeCodeMessage& out) {
  return ParseTimeCode(in, out);
}
template <class Item>
bool ParseBody(ItemReader& in, const Header& header, Item& out) {
  return ParseSegments(in, header, out);
}

template <class Content>
bool ParseInto(ItemReader& in, Message& message) {
  return ParseBody(in, message.header, message.body.emplace<Content>());
}

bool ParseBodyOfType(ItemReader& in, Message& message) {
  switch (message.header.type) {
    case Type::kEulerPose: return ParseInto<EulerPoseMessage>(in, message);
    case Type::kPose: return ParseInto<PoseMessage>(in, message);
    case Type::kMarkers: return ParseInto<MarkersMessage>(in, message);
    case Type::kMetaData: return ParseInto<MetaDataMessage>(in, message);
    case Type::kScale: return ParseInto<ScaleMessage>(in, message);
    case Type::kJointAngles: return ParseInto<JointAnglesMessage>(in, message);
    case Type::kLinear: return ParseInto<LinearMessage>(in, message);
    case Type::kAngular: return ParseInto<AngularMessage>(in, message);
    case Type::kTrackers: return ParseInto<TrackersMessage>(in, message);
    case Type::kCenterOfMass: return ParseInto<CenterOfMassMessage>(in, message);
    case Type::kTimeCode: break;
  }
  return ParseInto<TimeCodeMessage>(in, message);
}

}  // namespace

std::string TypeDigits(Type type) {
  const int number = static_cast<int>(type);
  return {static_cast<char>('0' + number / 10), static_cast<char>('0' + number % 10)};
}

tl::expected<Header, ParseError> ParseHeader(std::string_view datagram) {
  Header header;
  ItemReader in(datagram);
  if (!ReadHeader(in, datagram, header)) return tl::unexpected(in.error);
  return header;
}

tl::expected<Message, ParseError> ParseDatagram(std::string_view datagram) {
  tl::expected<Message, ParseError> result;
  ItemReader in(datagram);
  if (!ReadHeader(in, datagram, result->header) || !LimitToPayload(in, result->header) ||
      !ParseBodyOfType(in, *result)) {
    return tl::unexpected(in.error);
  }
  return result;
}

bool HasWholeBody(const Message& message) {
  if (const auto* poses = std::get_if<PoseMessage>(&message.body)) return poses->HasBody();
  if (const auto* poses = std::get_if<EulerPoseMessage>(&message.body)) return poses->HasBody();
  if (const auto* linear = std::get_if<LinearMessage>(&message.body)) return linear->HasBody();
  if (const auto* angular = std::get_if<AngularMessage>(&message.body)) return angular->HasBody();
  return false;
}

}  // namespace kinescope::mvn
