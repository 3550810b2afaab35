#include "urdf/robot/xml_outline.h"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

namespace kinescope::urdf {
namespace {

struct Scan {
  XML_Parser parser = nullptr;
  const XmlLimits& limits;
  const OnXmlElement& on_element;
  std::size_t elements = 0;
  int depth = 0;
  std::exception_ptr fault;  // ours or the caller's; exceptions do not fly through expat

  int line() const { return static_cast<int>(XML_GetCurrentLineNumber(parser)); }
  void Stop(const std::string& why) { Stop(std::make_exception_ptr(UrdfError(why, line()))); }
  void Stop(std::exception_ptr why) {
    if (!fault) fault = std::move(why);
    XML_StopParser(parser, XML_FALSE);
  }
};

void OnStart(void* user, const char* tag, const char** attributes) {
  Scan& scan = *static_cast<Scan*>(user);
  if (scan.fault) return;  // expat finishes the tag that it is in
  if (++scan.elements > scan.limits.elements) {
    return scan.Stop("more than " + std::to_string(scan.limits.elements) + " XML elements");
  }
  if (scan.depth >= scan.limits.depth) {
    return scan.Stop("<" + std::string(tag).substr(0, 40) + "> is nested more than " +
                     std::to_string(scan.limits.depth) + " elements deep");
  }
  try {
    scan.on_element(tag, attributes, scan.line(), scan.depth++);
  } catch (...) {
    scan.Stop(std::current_exception());
  }
}

void OnEnd(void* user, const char*) { --static_cast<Scan*>(user)->depth; }

void OnDoctype(void* user, const char*, const char*, const char*, int) {
  static_cast<Scan*>(user)->Stop(
      "DOCTYPE is not supported, because its entities can grow without bound; remove it");
}

}  // namespace

const std::string* XmlElement::Attribute(std::string_view name) const {
  const auto match = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& each) { return each.first == name; });
  return match == attributes.end() ? nullptr : &match->second;
}

int XmlOutline::Child(int parent, std::string_view tag) const {
  int child = (*this)[parent].first_child;
  while (child >= 0 && (*this)[child].tag != tag) child = (*this)[child].next_sibling;
  return child;
}

void ScanXml(std::string_view xml, const XmlLimits& limits, const OnXmlElement& on_element) {
  if (xml.size() > limits.bytes) {
    throw UrdfError("the document has " + std::to_string(xml.size()) + " bytes; the limit is " +
                    std::to_string(limits.bytes));
  }
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), XML_ParserFree);
  if (parser == nullptr) throw std::bad_alloc();
  Scan scan{parser.get(), limits, on_element, 0, 0, nullptr};
  XML_SetUserData(parser.get(), &scan);
  XML_SetElementHandler(parser.get(), OnStart, OnEnd);
  XML_SetStartDoctypeDeclHandler(parser.get(), OnDoctype);
  const XML_Status status =
      XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), XML_TRUE);
  if (scan.fault) std::rethrow_exception(scan.fault);
  if (status != XML_STATUS_OK) {
    throw UrdfError(
        "not well-formed XML: " + std::string(XML_ErrorString(XML_GetErrorCode(parser.get()))),
        scan.line());
  }
}

XmlOutline ReadOutline(std::string_view xml, const XmlLimits& limits) {
  XmlOutline outline;
  std::vector<int> open;        // from the root to the newest element
  std::vector<int> last_child;  // of each of them
  ScanXml(xml, limits, [&](const char* tag, const char* const* attributes, int line, int depth) {
    const int index = static_cast<int>(outline.elements.size());
    open.resize(static_cast<std::size_t>(depth));
    last_child.resize(static_cast<std::size_t>(depth));
    XmlElement element;
    element.tag = tag;
    element.line = line;
    for (; *attributes != nullptr; attributes += 2) {
      element.attributes.emplace_back(attributes[0], attributes[1]);
    }
    if (!open.empty()) {
      element.parent = open.back();
      auto& elements = outline.elements;
      int& newest = last_child.back();
      if (newest < 0) {
        elements[static_cast<std::size_t>(element.parent)].first_child = index;
      } else {
        elements[static_cast<std::size_t>(newest)].next_sibling = index;
      }
      newest = index;
    }
    outline.elements.push_back(std::move(element));
    open.push_back(index);
    last_child.push_back(-1);
  });
  return outline;
}

}  // namespace kinescope::urdf
