/// The trials of a folder of recordings. Each is a JSON file beside its recording, so that a folder
/// explains itself, and a server that is started again goes on with the study. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/recording/folder.h"
#include "server/recording/trial.h"

namespace kinescope::recording {

class TrialBook {
 public:
  /// Reads the trials that are there. `folder` is borrowed.
  explicit TrialBook(const Folder& folder);

  /// Writes the trial to its file; one of the same stem is replaced. @return "", or why it was not
  /// written: nothing has changed then
  [[nodiscard]] std::string Put(const Trial& trial);

  /// In the order of their start.
  const std::vector<Trial>& trials() const { return trials_; }
  /// Null if there is none of that stem.
  const Trial* Find(const std::string& stem) const;

  static constexpr std::size_t kMost = 2000;           // of those read; the newest
  static constexpr std::uintmax_t kMostBytes = 65536;  // of a file

 private:
  const Folder& folder_;
  std::vector<Trial> trials_;
};

}  // namespace kinescope::recording
