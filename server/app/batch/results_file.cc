#include "server/app/batch/results_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/words.h"
#include "server/app/batch/json_lines.h"

namespace kinescope::app {
namespace {

[[noreturn]] void Fail(const std::string& path, const char* what) {
  throw std::runtime_error(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

// Whether `path` still is the file that is open.
bool IsThere(int file, const std::string& path) {
  struct stat open = {}, named = {};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

void Lock(int file, const std::string& path) {
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) Fail(path, "cannot be locked");
  throw UsageError(path +
                   ": another process writes these results; wait for it, or give each process "
                   "its own --results");
}

}  // namespace

FoundResults ReadResults(const std::string& path) {
  FoundResults found;
  found.path = path;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return found;
  InputFile file = OpenInputFile(path);
  JsonLines lines(file, kMostResultBytes);
  while (auto line = lines.Next()) {
    if (line->text.empty() && !line->is_too_long) continue;
    if (!line->is_whole) {
      found.has_unfinished_line = true;
      break;
    }
    try {
      if (line->is_too_long) throw std::runtime_error("too long");
      JobResult result = ReadResult(line->text);
      found.results.push_back({line->number, std::move(line->text), std::move(result)});
    } catch (const std::exception& error) {
      found.faults.push_back(
          fmt::format("{}:{}: not a result of a job: {}", path, line->number, error.what()));
      found.faulty_lines.push_back(std::move(line->text));
    }
  }
  if (!lines.failure().empty()) throw SourceError(path + ": " + lines.failure());
  return found;
}

ResultsFile::ResultsFile(std::string path) : path_(std::move(path)) { Open(); }

ResultsFile::~ResultsFile() { Close(); }

void ResultsFile::Open() {
  while (true) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file_ < 0) Fail(path_, "cannot be written");
    try {
      Lock(file_, path_);
    } catch (...) {
      Close();
      throw;
    }
    // Another process may have replaced it before it was locked.
    if (IsThere(file_, path_)) return;
    Close();
  }
}

void ResultsFile::Close() {
  if (file_ >= 0) ::close(std::exchange(file_, -1));
}

void ResultsFile::KeepOnly(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  // Under a name of its own first: a process that is killed here leaves the old ones whole.
  const std::string other = path_ + ".new";
  const int file = ::open(other.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) Fail(path_, "cannot be replaced");
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 || !Write(file, text) || ::fsync(file) != 0 ||
      ::rename(other.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    ::close(file);
    ::unlink(other.c_str());
    errno = reason;
    Fail(path_, "cannot be replaced");
  }
  Close();
  file_ = file;
}

bool ResultsFile::Write(int file, std::string_view text) {
  struct stat before = {};
  ::fstat(file, &before);
  std::size_t at = 0;
  while (at < text.size()) {
    const ssize_t count = ::write(file, text.data() + at, text.size() - at);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      problem_ = std::strerror(errno);
      const int reason = errno;
      [[maybe_unused]] const int cut = ::ftruncate(file, before.st_size);
      errno = reason;
      return false;
    }
    at += static_cast<std::size_t>(count);
  }
  return true;
}

void ResultsFile::Add(const JobResult& result) {
  waiting_ += ToLine(result) + '\n';
  ++waiting_lines_;
  if (!Write(file_, waiting_)) return;
  waiting_.clear();
  waiting_lines_ = 0;
}

void ResultsFile::Finish() {
  if (waiting_.empty() || Write(file_, waiting_)) return;
  throw std::runtime_error(fmt::format(
      "{}: cannot be written: {}; {} missing in it: make room and run the same command again",
      path_, problem_,
      waiting_lines_ == 1 ? "1 result is" : fmt::format("{} results are", waiting_lines_)));
}

}  // namespace kinescope::app
