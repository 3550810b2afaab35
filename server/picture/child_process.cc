#include "server/picture/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace kinescope::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxOutputBytes = 1 << 20;

class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error(std::string("cannot create a pipe to a child process: ") +
                               std::strerror(errno));
    }
  }
  ~Pipe() {
    CloseWriter();
    ::close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reader() const { return ends_[0]; }
  int writer() const { return ends_[1]; }
  void CloseWriter() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  std::array<int, 2> ends_{};
};

pid_t Start(const std::vector<std::string>& command, int out, int err) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, err, STDERR_FILENO);
  pid_t child = -1;
  const int fault = ::posix_spawn(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (fault != 0) throw std::runtime_error("cannot start " + command[0] + ": " + strerror(fault));
  return child;
}

// False at the end of the stream.
bool ReadSome(int from, std::string& to) {
  std::array<char, 4096> buffer{};
  const ssize_t count = ::read(from, buffer.data(), buffer.size());
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;
  if (to.size() < kMaxOutputBytes) to.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

// Until both streams end. @return whether they did in time.
bool ReadAll(int out, int err, Clock::time_point deadline, const std::function<bool()>& is_wanted,
             ChildResult& result) {
  std::array<pollfd, 2> wanted = {pollfd{out, POLLIN, 0}, pollfd{err, POLLIN, 0}};
  while (wanted[0].fd >= 0 || wanted[1].fd >= 0) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0 || !is_wanted()) return false;
    constexpr std::int64_t kLookEvery = 200;  // ms
    const auto wait = static_cast<int>(std::min<std::int64_t>(left, kLookEvery));
    if (::poll(wanted.data(), wanted.size(), wait) <= 0) continue;
    if (wanted[0].revents != 0 && !ReadSome(out, result.out)) wanted[0].fd = -1;
    if (wanted[1].revents != 0 && !ReadSome(err, result.err)) wanted[1].fd = -1;
  }
  return true;
}

}  // namespace

ChildResult RunChild(const std::vector<std::string>& command, std::chrono::milliseconds limit,
                     const std::function<bool()>& is_wanted) {
  Pipe out, err;
  ChildResult result;
  const pid_t child = Start(command, out.writer(), err.writer());
  out.CloseWriter();
  err.CloseWriter();
  result.was_too_slow =
      !ReadAll(out.reader(), err.reader(), Clock::now() + limit, is_wanted, result);
  // Also when both streams have ended: nothing if it exits, the end of one that closed them and
  // stays.
  ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status) && !result.was_too_slow) result.signal = WTERMSIG(status);
  return result;
}

std::string LastLineOf(const std::string& messages) {
  const std::size_t last = messages.find_last_not_of(" \r\n");
  if (last == std::string::npos) return "";
  const std::size_t before = messages.find_last_of('\n', last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return messages.substr(first, last + 1 - first);
}

}  // namespace kinescope::app
