/// Reads and writes provenance in files and beside them. Functions without state; any thread.
#pragma once

#include <optional>
#include <string>

#include "server/app/render/output_plan.h"
#include "server/app/render/provenance.h"

namespace kinescope::app {

/// The keyword of a PNG's text chunk. Clips have it as their comment.
inline constexpr const char* kProvenanceKey = "Kinescope";

/// The provenance in the file `path`; nullopt if it has none, is missing or is not a picture.
std::optional<Json> ReadEmbedded(const std::string& path);

/// The path of the sidecar file of an output: FILE.json.
std::string SidecarOf(const std::string& path);
std::optional<Json> ReadSidecar(const std::string& path);

/// Writes FILE.json: `provenance`, the path of the source, the number of pictures and, except for a
/// sequence, size and SHA-256 of the finished file. @throws std::runtime_error.
void WriteSidecar(const Output& output, Json provenance, const std::string& source, long pictures);

}  // namespace kinescope::app
