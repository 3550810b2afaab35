#include "server/mvn/file/mvnx_elements.h"

#include <charconv>

namespace kinescope::mvn {
namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n";
constexpr double kLargestMvnxNumber = 1e6;  // as in the stream: beyond any human motion

struct Rule {
  Element parent;
  std::string_view name;
  Element element;
};

// The parent decides the meaning: <segment> in a finger list is not a segment of the body.
constexpr Rule kRules[] = {
    {Element::kDocument, "mvnx", Element::kMvnx},
    {Element::kMvnx, "subject", Element::kSubject},
    {Element::kSubject, "segments", Element::kSegments},
    {Element::kSegments, "segment", Element::kSegment},
    {Element::kSegment, "points", Element::kPoints},
    {Element::kPoints, "point", Element::kPoint},
    {Element::kPoint, "pos_s", Element::kPointPosition},
    {Element::kPoint, "pos_b", Element::kPointPosition},
    {Element::kSubject, "joints", Element::kJoints},
    {Element::kJoints, "joint", Element::kJoint},
    {Element::kSubject, "sensors", Element::kSensors},
    {Element::kSensors, "sensor", Element::kSensor},
    {Element::kSubject, "footContactDefinition", Element::kContacts},
    {Element::kContacts, "contactDefinition", Element::kContact},
    {Element::kSubject, "frames", Element::kFrames},
    {Element::kFrames, "frame", Element::kFrame},
};

constexpr const char* kListNames[kMvnxListCount] = {
    "orientation",
    "position",
    "velocity",
    "acceleration",
    "angularVelocity",
    "angularAcceleration",
    "jointAngle",
    "centerOfMass",
    "footContacts",
    "sensorOrientation",
    "sensorFreeAcceleration",
    "sensorAcceleration",
    "sensorAngularVelocity",
    "sensorMagneticField",
};

}  // namespace

const char* Name(MvnxList list) { return kListNames[static_cast<std::size_t>(list)]; }

Element FindElement(Element parent, std::string_view name, MvnxList& list) {
  const std::size_t colon = name.find(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  if (parent == Element::kFrame) {
    for (std::size_t i = 0; i < kMvnxListCount; ++i) {
      if (name != kListNames[i]) continue;
      list = static_cast<MvnxList>(i);
      return Element::kList;
    }
  }
  for (const Rule& rule : kRules) {
    if (rule.parent == parent && rule.name == name) return rule.element;
  }
  return Element::kOther;
}

std::string ParseNumbers(std::string_view text, std::vector<double>& numbers) {
  numbers.clear();
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (;;) {
    while (at != end && kWhiteSpace.find(*at) != std::string_view::npos) ++at;
    if (at == end) return "";
    double number = 0;
    const auto parsed = std::from_chars(at, end, number);
    const bool ends_well =
        parsed.ptr == end || kWhiteSpace.find(*parsed.ptr) != std::string_view::npos;
    if (parsed.ec != std::errc() || !ends_well) {
      return "'" + std::string(at, std::min<std::size_t>(static_cast<std::size_t>(end - at), 16)) +
             "' is not a number";
    }
    if (!std::isfinite(number)) return "a number is NaN or infinite";
    if (std::abs(number) > kLargestMvnxNumber) {
      return std::to_string(number) + " is out of range";
    }
    numbers.push_back(number);
    at = parsed.ptr;
  }
}

std::optional<std::int64_t> ParseInteger(std::string_view text) {
  std::int64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return number;
}

std::optional<std::uint32_t> ParseColor(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + 1, end, rgb, 16);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return rgb;
}

}  // namespace kinescope::mvn
