/// Reads a text file line by line. A line has a greatest length, so that a file without line breaks
/// takes no memory. One thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/system/input_file.h"

namespace kinescope::wrenches {

class BoundedLines {
 public:
  static constexpr std::size_t kLongestLine = 16 * 1024;  // bytes

  /// `name`: of the file, for errors.
  BoundedLines(InputFile file, std::string name);

  /// The next line without its break (LF or CR LF) and without a byte order mark; nullopt at the
  /// end. Valid until the next call.
  /// @throws SourceError with file, line and reason.
  std::optional<std::string_view> Next();

  /// Of the newest line, from 1.
  long number() const { return number_; }

  const std::string& name() const { return name_; }

  /// @throws SourceError: "forces.csv: line 3: <problem>".
  [[noreturn]] void Refuse(const std::string& problem) const;
  /// Of the whole file: "forces.csv: <problem>".
  [[noreturn]] void RefuseFile(const std::string& problem) const;

 private:
  bool Fill();

  InputFile file_;
  std::string name_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of what was read and not yet returned, in the buffer
  bool ended_ = false;
  long number_ = 0;
};

/// `text` for an error: in quotes, at most 40 bytes, with '?' for what cannot be printed.
std::string Quoted(std::string_view text);

}  // namespace kinescope::wrenches
