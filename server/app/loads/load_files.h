/// Writes the loads of a recording as CSV and JSON, sample by sample: memory does not grow with the
/// recording. A file gets its name only when it is complete. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/scene_state.h"
#include "server/table/load_rows.h"

namespace kinescope::app {

/// kWide: one row per sample with all joints side by side. kLong: one row per sample and joint.
enum class Layout { kWide, kLong };

class LoadFile {
 public:
  virtual ~LoadFile() = default;
  virtual void Add(const PersonState& person, std::int64_t begin_nanos) = 0;
  /// Completes the file. `summary`: data beside the samples, for formats that support it.
  virtual void Finish(const nlohmann::json& summary) = 0;
};

// `path` "-": standard output. Both functions and all calls of the result @throw std::runtime_error
// with the path and the reason.

/// RFC 4180 (with plain line feeds), with a header line; unknown values are empty.
std::unique_ptr<LoadFile> MakeCsv(const std::string& path, Layout layout,
                                  const Columns& columns = {});
/// {"schema": kLoadsSchema, "columns": [...], "samples": [[...], ...], and the members of
/// `summary`}; unknown values are null. `has_samples` false: both arrays are empty.
std::unique_ptr<LoadFile> MakeJson(const std::string& path, const Columns& columns = {},
                                   bool has_samples = true);

/// The $id of docs/loads.schema.json, which describes the JSON. Its number changes when a member
/// is removed or gets another meaning.
inline constexpr char kLoadsSchema[] = "urn:kinescope:loads:1";

}  // namespace kinescope::app
