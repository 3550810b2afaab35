/// The folder of recordings, clips and reports: names made of what people type, files found by
/// name, free space. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::recording {

/// A part of a file name from any text: letters, digits, "-" and "_" of ASCII stay, all else
/// becomes one "_". At most 40 characters; `instead` if nothing is left.
std::string NamePart(std::string_view text, std::string_view instead);

/// A part of a file name: "20261123T065549-123Z", of now.
std::string TimeName();

struct FileEntry {
  std::string name;
  std::uintmax_t bytes = 0;
  std::int64_t modified_micros = 0;  // wall clock
};

class Folder {
 public:
  using FreeBytes = std::function<std::optional<std::uintmax_t>(const std::filesystem::path&)>;

  /// `may_make`: the folder is made when it is needed. Otherwise it has to be there: it may be on a
  /// disk that is not mounted. `free_bytes`: of the file system, for tests.
  Folder(std::filesystem::path path, bool may_make, FreeBytes free_bytes = nullptr);

  const std::filesystem::path& path() const { return path_; }

  /// Makes the folder if it may. @return "", or why nothing can be written there, with the way out
  std::string Prepare() const;

  /// "S07_lift_003", or with "-2", "-3" ... if there are files of that name: no file is ever
  /// replaced.
  std::string FreeStem(const std::string& stem) const;

  /// The file of that name, if it is one of ours: a pcapng, pcap, mp4, png, html or json in this
  /// folder, no link, with a name as NamePart() and FreeStem() make them.
  std::optional<std::filesystem::path> Find(const std::string& name) const;

  /// Those that Find() finds, the newest first, at most `most`.
  std::vector<FileEntry> List(std::size_t most) const;

  /// Of the file system; nullopt: not known.
  std::optional<std::uintmax_t> free_bytes() const { return free_bytes_(path_); }

 private:
  const std::filesystem::path path_;
  const bool may_make_;
  const FreeBytes free_bytes_;
};

}  // namespace kinescope::recording
