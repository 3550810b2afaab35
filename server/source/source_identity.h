/// Names the content of a source, for provenance: two runs over sources of equal identity see the
/// same samples. Any thread.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/system/sha256.h"

namespace kinescope::app {

struct SourceIdentity {
  std::string name;  // of the file, without its folder; or "demo:lift", "pose:right_elbow=90"
  std::optional<FileDigest> digest;  // of a regular file
  bool is_repeatable = true;         // false: a pipe or a stream, which cannot be read again
};

/// Reads the whole file. @throws SourceError with the file and the reason, or for an invalid pose.
SourceIdentity IdentityOf(const std::string& url);

/// Members `name` and, of a regular file, `sha256` and `bytes`.
nlohmann::ordered_json ToJson(const SourceIdentity& source);

}  // namespace kinescope::app
