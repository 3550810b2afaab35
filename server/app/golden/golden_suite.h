/// The golden cases of a folder: those that can be drawn, those that cannot be read, what is
/// accepted of them, and what is accepted of none. One thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/app/golden/golden_case.h"
#include "server/app/golden/golden_lock.h"
#include "server/app/shard.h"

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
  std::vector<std::filesystem::path> unread;   // names of files that look like cases: *.yml
  GoldenLock lock;
  std::string pictures;  // folder of the accepted pictures, relative to `folder`; "": the same
  std::vector<std::string> unknown_locks;  // names in `lock` that no case has

  /// @param picture  its name (golden_frame.h)
  std::filesystem::path PictureOf(const std::string& picture) const;
  std::filesystem::path CaseFileOf(const FoundCase& found) const;
  std::filesystem::path lock_file() const;
  /// @throws std::runtime_error with file and reason.
  void WriteLockFile() const;
  /// What is accepted of a picture; nullptr: nothing yet.
  const AcceptedCase* AcceptedOf(const std::string& picture) const;
  /// The names of the pictures that are accepted of a case.
  std::vector<std::string> AcceptedPicturesOf(const FoundCase& found) const;
};

/// Those cases of `folder` that are named, or whose pictures are; all of them, and the orphans, if
/// none is.
/// @throws UsageError if the folder cannot be read, has no case, or not one that is named;
/// std::runtime_error if `golden.lock` cannot be read.
GoldenSuite FindGoldenSuite(const std::filesystem::path& folder,
                            const std::vector<std::string>& names);

/// What one of several processes compares, by a hash of the names. What belongs to no case is in
/// one share, too. A share may be empty.
GoldenSuite ShareOf(GoldenSuite suite, const Shard& shard);

}  // namespace kinescope::app
