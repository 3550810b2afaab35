/// Loads of a recording as CSV and JSON, written sample by sample: memory does not grow with the
/// recording, and a file has its name only when it is whole. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/scene_state.h"

namespace kinescope::app {

/// One row a sample with all joints side by side, or one row a sample and joint.
enum class Layout { kWide, kLong };

class LoadFile {
 public:
  virtual ~LoadFile() = default;
  virtual void Add(const PersonState& person, std::int64_t begin_nanos) = 0;
  /// Puts the file in place. `summary`: what goes beside the samples, where the format can.
  virtual void Finish(const nlohmann::json& summary) = 0;
};

// `path` "-": standard output. Both: @throws std::runtime_error naming the path and the reason,
// here and from every call.

/// RFC 4180 (but with plain line feeds), with a header line; what is not known is empty.
std::unique_ptr<LoadFile> MakeCsv(const std::string& path, Layout layout);
/// {"columns": [...], "samples": [[...], ...], and what `summary` has}; what is not known is null.
std::unique_ptr<LoadFile> MakeJson(const std::string& path);

}  // namespace kinescope::app
