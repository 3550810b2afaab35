/// The container of GLB files (glTF 2.0): its chunks, and its JSON as a document. Counts and
/// nesting are checked before anything is allocated. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

namespace kinescope::urdf {

/// Parts of the bytes that were split.
struct GlbChunks {
  std::string_view json, binary;  // binary: empty if there is none
};

/// @throws std::runtime_error for a wrong magic or version, and for lengths that exceed `bytes`.
GlbChunks SplitGlb(std::string_view bytes);

inline constexpr std::size_t kMaxGlbJsonBytes = 8u << 20;  // numbers are in the binary part
inline constexpr int kMaxGlbDepth = 100;                   // of JSON, and of nodes

/// An object. @throws std::runtime_error if `text` is too large, too deep, or no JSON object.
nlohmann::json ParseGlbJson(std::string_view text);

}  // namespace kinescope::urdf
