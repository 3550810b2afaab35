#include "urdf/rig/glb_values.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

namespace kinescope::rig {
namespace {

using nlohmann::json;
using Fault = std::runtime_error;

template <class T>
T ValueAt(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

const json& ListOf(const json& object, const char* name) {
  static const json kNone = json::array();
  const auto member = object.find(name);
  if (member == object.end()) return kNone;
  if (!member->is_array()) throw Fault(std::string("its '") + name + "' is not a list");
  return *member;
}

std::size_t IndexOf(const json& object, const char* name, std::size_t limit,
                    std::size_t otherwise) {
  const auto member = object.find(name);
  if (member == object.end()) return otherwise;
  if (!member->is_number_unsigned() || member->get<std::uint64_t>() >= limit) {
    throw Fault(std::string("its '") + name + "' is " + member->dump().substr(0, 40) +
                "; expected a whole number below " + std::to_string(limit));
  }
  return member->get<std::size_t>();
}

const json& EntryOf(const json& list, std::size_t index, const char* what) {
  if (index >= list.size() || !list[index].is_object()) {
    throw Fault(std::string("it refers to entry ") + std::to_string(index) + " of '" + what +
                "', which is missing");
  }
  return list[index];
}

template <std::size_t count>
std::array<double, count> NumbersOf(const json& object, const char* name,
                                    const std::array<double, count>& otherwise) {
  const auto member = object.find(name);
  if (member == object.end()) return otherwise;
  std::array<double, count> numbers{};
  const bool is_list = member->is_array() && member->size() == count;
  for (std::size_t i = 0; is_list && i < count; ++i) {
    if (!(*member)[i].is_number()) break;
    numbers[i] = (*member)[i].template get<double>();
    if (i + 1 == count) return numbers;
  }
  throw Fault(std::string("a '") + name + "' is not a list of " + std::to_string(count) +
              " numbers");
}
template std::array<double, 3> NumbersOf(const json&, const char*, const std::array<double, 3>&);
template std::array<double, 4> NumbersOf(const json&, const char*, const std::array<double, 4>&);
template std::array<double, 16> NumbersOf(const json&, const char*, const std::array<double, 16>&);

std::string TextOf(const json& object, const char* name) {
  const auto member = object.find(name);
  return member != object.end() && member->is_string() ? member->get<std::string>() : "";
}

Accessor::Accessor(const json& document, std::string_view binary, std::size_t index,
                   const char* type) {
  static const std::map<std::string, std::size_t> kElements = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  const json& accessor = EntryOf(ListOf(document, "accessors"), index, "accessors");
  if (accessor.contains("sparse")) {
    throw Fault("sparse accessors are not supported: export it without them");
  }
  if (TextOf(accessor, "type") != type) {
    throw Fault("an accessor has the type '" + TextOf(accessor, "type").substr(0, 20) +
                "'; expected " + type);
  }
  component_ = static_cast<std::uint32_t>(IndexOf(accessor, "componentType", kFloat + 1, 0));
  switch (component_) {
    case kByte:
    case kUnsignedByte: component_bytes_ = 1; break;
    case kShort:
    case kUnsignedShort: component_bytes_ = 2; break;
    case kUnsignedInt:
    case kFloat: component_bytes_ = 4; break;
    default: throw Fault("an accessor has an unknown component type");
  }
  const json& views = ListOf(document, "bufferViews");
  const json& view =
      EntryOf(views, IndexOf(accessor, "bufferView", views.size(), views.size()), "bufferViews");
  const json& buffer =
      EntryOf(ListOf(document, "buffers"), IndexOf(view, "buffer", SIZE_MAX, 0), "buffers");
  if (buffer.contains("uri") || IndexOf(view, "buffer", SIZE_MAX, 0) != 0) {
    throw Fault("its vertices are in another file, '" + TextOf(buffer, "uri").substr(0, 60) +
                "': export it as one GLB");
  }
  const std::size_t element = component_bytes_ * kElements.at(type);
  const std::size_t begin = IndexOf(view, "byteOffset", SIZE_MAX, 0);
  const std::size_t length = IndexOf(view, "byteLength", SIZE_MAX, 0);
  stride_ = IndexOf(view, "byteStride", 253, element);
  const std::size_t offset = IndexOf(accessor, "byteOffset", SIZE_MAX, 0);
  count_ = IndexOf(accessor, "count", SIZE_MAX, 0);
  if (begin > binary.size() || length > binary.size() - begin) {
    throw Fault("a bufferView lies outside the file: it is truncated");
  }
  // The last element needs no room for the rest of its stride.
  if (stride_ < element || count_ == 0 || offset > length || element > length - offset ||
      count_ - 1 > (length - offset - element) / stride_) {
    throw Fault("an accessor declares " + std::to_string(count_) +
                " elements, but its bufferView has " + std::to_string(length) + " bytes");
  }
  bytes_ = binary.substr(begin + offset, length - offset);
}

const char* Accessor::At(std::size_t element, std::size_t component) const {
  return bytes_.data() + element * stride_ + component * component_bytes_;
}

double Accessor::Number(std::size_t element, std::size_t component, bool is_normalized) const {
  const char* const at = At(element, component);
  const auto signed_number = [&](double value, double most) {
    return is_normalized ? std::max(value / most, -1.0) : value;
  };
  switch (component_) {
    case kFloat: return ValueAt<float>(at);
    case kByte: return signed_number(ValueAt<std::int8_t>(at), INT8_MAX);
    case kShort: return signed_number(ValueAt<std::int16_t>(at), INT16_MAX);
    case kUnsignedByte: return signed_number(ValueAt<std::uint8_t>(at), UINT8_MAX);
    case kUnsignedShort: return signed_number(ValueAt<std::uint16_t>(at), UINT16_MAX);
    default: return signed_number(ValueAt<std::uint32_t>(at), UINT32_MAX);
  }
}

std::uint32_t Accessor::Whole(std::size_t element, std::size_t component) const {
  const char* const at = At(element, component);
  switch (component_) {
    case kUnsignedByte: return ValueAt<std::uint8_t>(at);
    case kUnsignedShort: return ValueAt<std::uint16_t>(at);
    case kUnsignedInt: return ValueAt<std::uint32_t>(at);
    default: throw Fault("an accessor of numbers of things is not of whole numbers");
  }
}

}  // namespace kinescope::rig
