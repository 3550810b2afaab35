/// Finds the MVNX elements that are read, and parses their text. Only for mvnx_reader.cc. Pure
/// functions.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/mvn/file/mvnx_reader.h"

namespace kinescope::mvn {

enum class Element {
  kDocument,
  kMvnx,
  kSubject,
  kSegments,
  kSegment,
  kPoints,
  kPoint,
  kPointPosition,
  kJoints,
  kJoint,
  kSensors,
  kSensor,
  kContacts,
  kContact,
  kFrames,
  kFrame,
  kList,
  kOther,  // skipped with all its content
};

/// The element `name` inside `parent`; sets `list` for Element::kList. A namespace prefix is
/// ignored.
Element FindElement(Element parent, std::string_view name, MvnxList& list);

const char* Name(MvnxList list);

/// Numbers separated by white space, independent of the locale. @return the problem; "" if none.
std::string ParseNumbers(std::string_view text, std::vector<double>& numbers);

std::optional<std::int64_t> ParseInteger(std::string_view text);
std::optional<std::uint32_t> ParseColor(std::string_view text);  // "#rrggbb"

}  // namespace kinescope::mvn
