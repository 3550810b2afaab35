/// Reads the elements of an XML document with their lines, which urdfdom does not keep. It is also
/// the input check before any XML library: DOCTYPEs (and with them entity expansion) are rejected;
/// size, depth and the number of elements are limited. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "urdf/robot/urdf_error.h"

namespace kinescope::urdf {

struct XmlLimits {
  std::size_t bytes = 32u << 20;
  std::size_t elements = 500'000;
  int depth = 64;
};

struct XmlElement {
  std::string tag;
  int line = 0;     // of its `<`, from 1
  int parent = -1;  // indices into XmlOutline::elements; -1: none
  int first_child = -1;
  int next_sibling = -1;
  std::vector<std::pair<std::string, std::string>> attributes;

  /// Null if there is none.
  const std::string* Attribute(std::string_view name) const;
};

struct XmlOutline {
  std::vector<XmlElement> elements;  // in the document's order; the first is the root

  const XmlElement& operator[](int index) const {
    return elements[static_cast<std::size_t>(index)];
  }
  /// The first child named `tag`; -1 if there is none.
  int Child(int parent, std::string_view tag) const;
};

/// Called for each element in document order; `attributes` are name, value, ..., null.
using OnXmlElement =
    std::function<void(const char* tag, const char* const* attributes, int line, int depth)>;

/// @throws UrdfError with the line: not well-formed, a DOCTYPE, or a limit exceeded.
void ScanXml(std::string_view xml, const XmlLimits& limits, const OnXmlElement& on_element);

/// @throws UrdfError as ScanXml.
XmlOutline ReadOutline(std::string_view xml, const XmlLimits& limits = {});

}  // namespace kinescope::urdf
