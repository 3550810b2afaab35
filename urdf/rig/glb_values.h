/// Reads values out of a GLB: members of its JSON, and the numbers of accessors. Every count is
/// checked against the bytes that are there. Pure functions, any thread; all throw
/// std::runtime_error with the reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace kinescope::rig {

/// The member `name` of `object`, a list; an empty one if it is missing.
const nlohmann::json& ListOf(const nlohmann::json& object, const char* name);
/// A whole number below `limit`; `otherwise` if it is missing.
std::size_t IndexOf(const nlohmann::json& object, const char* name, std::size_t limit,
                    std::size_t otherwise);
/// An entry of `list`, an object. `what`: of the list, for the error.
const nlohmann::json& EntryOf(const nlohmann::json& list, std::size_t index, const char* what);
/// A list of `count` numbers; `otherwise` if it is missing.
template <std::size_t count>
std::array<double, count> NumbersOf(const nlohmann::json& object, const char* name,
                                    const std::array<double, count>& otherwise);
std::string TextOf(const nlohmann::json& object, const char* name);

/// The values of an accessor.
class Accessor {
 public:
  /// `index` of the document's accessors; `type`: "VEC3".
  Accessor(const nlohmann::json& document, std::string_view binary, std::size_t index,
           const char* type);

  std::size_t count() const { return count_; }
  bool is_float() const { return component_ == kFloat; }
  /// A component of an element; integers as glTF normalises them if `is_normalized`.
  /// @pre element < count()
  double Number(std::size_t element, std::size_t component, bool is_normalized = false) const;
  /// Of an accessor of integers.
  std::uint32_t Whole(std::size_t element, std::size_t component = 0) const;

 private:
  enum Component : std::uint32_t {
    kByte = 5120,
    kUnsignedByte,
    kShort,
    kUnsignedShort,
    kUnsignedInt = 5125,
    kFloat
  };
  const char* At(std::size_t element, std::size_t component) const;

  std::string_view bytes_;  // from the first element on
  std::size_t count_ = 0, stride_ = 0, component_bytes_ = 0;
  std::uint32_t component_ = 0;
};

}  // namespace kinescope::rig
