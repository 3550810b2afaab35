#include "server/app/golden/case_process.h"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace kinescope::app {
namespace {

constexpr std::size_t kMostLineBytes = 256 << 20;  // of a line

}  // namespace

CaseProcess::CaseProcess(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::runtime_error(std::string("cannot connect to a process: ") + std::strerror(errno));
  }
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, ends[1], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
  const int fault =
      ::posix_spawn(&process_, arguments[0], &files, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  socket_ = ends[0];
  if (fault == 0) return;
  process_ = -1;
  ::close(socket_);
  throw std::runtime_error("cannot start " + command[0] + ": " + std::strerror(fault));
}

CaseProcess::~CaseProcess() {
  End();
  ::close(socket_);
}

void CaseProcess::Ask(const std::string& case_name) {
  const std::string order = case_name + '\0';
  for (std::size_t at = 0; at < order.size();) {
    const ssize_t sent = ::send(socket_, order.data() + at, order.size() - at, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return;
    at += static_cast<std::size_t>(sent);
  }
}

bool CaseProcess::Read(std::vector<std::string>& lines) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), 0);
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;
  received_.append(buffer.data(), static_cast<std::size_t>(count));
  std::size_t begin = 0;
  for (std::size_t end = received_.find('\n'); end != std::string::npos;
       end = received_.find('\n', begin)) {
    lines.push_back(received_.substr(begin, end - begin));
    begin = end + 1;
  }
  received_.erase(0, begin);
  return received_.size() <= kMostLineBytes;
}

std::string CaseProcess::End() {
  if (process_ < 0) return "";
  ::kill(process_, SIGKILL);  // nothing to one that has ended
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFEXITED(status)) return fmt::format("ended with exit code {}", WEXITSTATUS(status));
  const int by = WTERMSIG(status);
  return fmt::format("ended with signal {} ({})", by, ::strsignal(by));
}

}  // namespace kinescope::app
