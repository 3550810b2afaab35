#include "server/marks/mark_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/system/json_text.h"
#include "server/marks/mark_json.h"

namespace kinescope::marks {
namespace {

// A pipe or a device could let the start wait for ever. "", or why it is not read.
std::string CheckIsFile(int descriptor, off_t& size) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    return "it is no file, but a folder, a pipe or a device";
  }
  size = status.st_size;
  if (static_cast<std::uint64_t>(size) <= MarkFile::kMostBytes) return "";
  return "it has " + std::to_string(size) + " bytes, more than " +
         std::to_string(MarkFile::kMostBytes) + "; choose another file";
}

// "", or why it cannot be read.
std::string ReadText(int descriptor, std::string& text) {
  char piece[1 << 16];
  for (ssize_t count = 0;
       (count = ::pread(descriptor, piece, sizeof piece, static_cast<off_t>(text.size()))) != 0;) {
    if (count < 0) return std::strerror(errno);
    text.append(piece, static_cast<std::size_t>(count));
    if (text.size() > MarkFile::kMostBytes) return "it grows while it is read; choose another file";
  }
  return "";
}

// @return how many lines are no marks
int ReadLines(std::string_view text, std::vector<Mark>& marks) {
  int unread = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.empty()) continue;
    if (auto mark = ReadMark(line)) {
      marks.push_back(*std::move(mark));
    } else {
      ++unread;
    }
  }
  return unread;
}

}  // namespace

tl::expected<std::vector<Mark>, std::string> ReadMarks(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return tl::unexpected(path.string() + ": " + std::strerror(errno));
  off_t size = 0;
  std::string text;
  std::string problem = CheckIsFile(descriptor, size);
  if (problem.empty()) problem = ReadText(descriptor, text);
  ::close(descriptor);
  std::vector<Mark> marks;
  const int unread = problem.empty() ? ReadLines(text, marks) : 0;
  if (problem.empty() && marks.empty() && unread > 0) {
    problem = "none of its " + std::to_string(unread) + " lines is a mark (docs/http.md)";
  }
  if (!problem.empty()) return tl::unexpected(path.string() + ": " + problem);
  return marks;
}

MarkFile::MarkFile(MarkFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      unread_lines_(other.unread_lines_) {}

MarkFile::~MarkFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

tl::expected<MarkFile, std::string> MarkFile::Open(const std::filesystem::path& path,
                                                   std::vector<Mark>& marks) {
  const auto fail = [&](const std::string& reason) {
    return tl::unexpected(path.string() + ": " + reason);
  };
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  constexpr mode_t kMode = 0644;
  MarkFile file(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, kMode),
                path);
  if (file.descriptor_ < 0) return fail(std::strerror(errno));
  off_t size = 0;
  std::string problem = CheckIsFile(file.descriptor_, size);
  if (!problem.empty()) return fail(problem);
  if (::flock(file.descriptor_, LOCK_EX | LOCK_NB) != 0) {
    return fail("another server writes its marks there; choose another file");
  }
  problem = file.Read(marks);
  if (!problem.empty()) return fail(problem);
  return file;
}

std::string MarkFile::Read(std::vector<Mark>& marks) {
  std::string text;
  std::string problem = ReadText(descriptor_, text);
  if (!problem.empty()) return problem;
  unread_lines_ = ReadLines(text, marks);
  // A line that a full disk or a power failure cut must not get the next one at its end.
  return text.empty() || text.back() == '\n' ? "" : Write("\n");
}

std::string MarkFile::Append(const Mark& mark) {
  const std::string problem = Write(JsonText(ToJson(mark)) + "\n");
  return problem.empty() ? "" : path_.string() + ": " + problem;
}

std::string MarkFile::Write(const std::string& text) {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) return std::strerror(errno);
  const ssize_t written = ::write(descriptor_, text.data(), text.size());
  if (written == static_cast<ssize_t>(text.size())) return "";
  const int reason = written < 0 ? errno : ENOSPC;
  if (written > 0 && ::ftruncate(descriptor_, status.st_size) != 0) return std::strerror(errno);
  return std::strerror(reason);
}

}  // namespace kinescope::marks
