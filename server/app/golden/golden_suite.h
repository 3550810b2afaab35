/// The golden cases of a folder: those that can be drawn, those that cannot be read, and accepted
/// pictures that belong to no case. One thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/app/golden/golden_case.h"

namespace kinescope::app {

struct FoundCase {
  std::string name;
  std::optional<GoldenCase> read;  // nullopt: see `error`
  std::string error;               // file, line, key and reason
};

struct GoldenSuite {
  std::filesystem::path folder;
  std::vector<FoundCase> cases;                // by name
  std::vector<std::filesystem::path> orphans;  // names of files; by name

  std::filesystem::path PictureOf(const FoundCase& found) const;
  std::filesystem::path ObjectsOf(const FoundCase& found) const;
};

/// Those cases of `folder` that are named; all of them, and the orphans, if none is.
/// @throws UsageError if the folder cannot be read, has no case, or not one that is named.
GoldenSuite FindGoldenSuite(const std::filesystem::path& folder,
                            const std::vector<std::string>& names);

}  // namespace kinescope::app
