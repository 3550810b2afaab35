#include "server/table/output_file.h"

#include <cstdio>
#include <stdexcept>

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
  } else if (std::fflush(stdout) != 0) {
    throw std::runtime_error("cannot write to standard output");
  }
}

void OutputFile::Flush() {
  if (file_) {
    file_->Write(buffer_.data(), buffer_.size());
  } else if (std::fwrite(buffer_.data(), 1, buffer_.size(), stdout) != buffer_.size()) {
    throw std::runtime_error("cannot write to standard output");
  }
  buffer_.clear();
}

}  // namespace kinescope::app
