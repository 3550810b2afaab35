#include <array>

#include "server/mvn/datagram.h"

namespace kinescope::mvn {

const char* Text(Reason reason) {
  switch (reason) {
    case Reason::kEmpty: return "empty datagram";
    case Reason::kJsonText: return "JSON text (MVN network sync)";
    case Reason::kXmlText: return "XML text (MVN network sync)";
    case Reason::kForeignText: return "text that is not MXTP";
    case Reason::kForeign: return "no MXTP id string";
    case Reason::kShortHeader: return "truncated header";
    case Reason::kUnknownType: return "unknown message type";
    case Reason::kType04:
      return "type 04 (Siemens Tecnomatix): switch on Position + Orientation (Quaternion) instead";
    case Reason::kType05:
      return "type 05 (Unity 3D): switch on Position + Orientation (Quaternion) instead";
    case Reason::kType10: return "type 10 (old scale data): switch on Scaling Data instead";
    case Reason::kType11:
      return "type 11 (old props): switch on Position + Orientation (Quaternion) instead";
    case Reason::kShortPayload: return "shorter than the size in its header";
    case Reason::kItemCount: return "number of items does not fit the payload";
    case Reason::kPayloadSize: return "payload size does not fit the message type";
    case Reason::kLyingCount: return "count larger than the payload";
    case Reason::kLyingLength: return "text length larger than the payload";
    case Reason::kNotFinite: return "number is NaN or infinite";
    case Reason::kOutOfRange: return "number out of range";
    case Reason::kNotUnit: return "quaternion not of unit length";
    case Reason::kIdZero: return "id 0";
    case Reason::kRepeatedId: return "repeated id";
    case Reason::kTimeOfDay: return "time code outside 00:00 to 24:00";
    case Reason::kPartsContradict: return "datagram counter contradicts the other parts";
    case Reason::kNoWholePose: return "sample without a complete body pose (type 02)";
    case Reason::kTooManyStreams: return "too many senders or characters";
    case Reason::kSecondSender:
      return "second sender at one address (new or restarted sender, not yet decided)";
    case Reason::kScaleWithoutBody: return "scale data without all 23 segments";
    case Reason::kScaleNotHuman: return "implausible scale data";
  }
  return "unknown reason";
}

std::string Describe(const ParseError& error) {
  return "byte " + std::to_string(error.offset) + ": " + Text(error.reason) + " (value " +
         std::to_string(error.value) + ")";
}

}  // namespace kinescope::mvn
