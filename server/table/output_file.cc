#include "server/table/output_file.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "core/system/standard_streams.h"
#include "core/system/utf8.h"

namespace kinescope::app {

OutputFile::OutputFile(const std::string& path) {
  if (path != "-") file_.emplace(path);
}

void OutputFile::FlushWhenLarge() {
  constexpr std::size_t kLarge = 1 << 16;
  if (buffer_.size() >= kLarge) Flush();
}

void OutputFile::Finish() {
  Flush();
  if (file_) {
    file_->Commit();
  } else {
    FlushStandardOutput();
  }
}

void OutputFile::Flush() {
  if (file_) {
    file_->Write(buffer_.data(), buffer_.size());
  } else {
    const std::string printable = PrintableLines(buffer_);
    if (std::fwrite(printable.data(), 1, printable.size(), stdout) != printable.size()) {
      FailOfStandardOutput(errno);
    }
  }
  buffer_.clear();
}

std::filesystem::path PlaceOfOutput(const std::string& path) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path);
  auto place = std::filesystem::weakly_canonical(absolute, error);
  if (error) place = absolute.lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

}  // namespace kinescope::app
