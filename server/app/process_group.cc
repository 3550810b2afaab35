#include "server/app/process_group.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"

namespace kinescope::app {
namespace {

using GroupClock = ProcessGroup::Clock;

constexpr int kChannelIn = 3, kChannelOut = 4;  // of the program
constexpr int kLeastDescriptor = 10;            // of ours: above those that the program is to have
constexpr std::size_t kMostLogBytes = 256 << 10;
constexpr std::size_t kReadBytes = 256 << 10;
constexpr int kLookEveryMillis = 100;  // whether the user stops this program

[[noreturn]] void ThrowStart(const std::string& program) {
  throw std::runtime_error("cannot start " + program + ": " + std::strerror(errno));
}

// Two ends of a stream for both directions.
std::array<int, 2> MakeStream(const std::string& program) {
  std::array<int, 2> low{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, low.data()) != 0) ThrowStart(program);
  std::array<int, 2> ends{};
  for (std::size_t i = 0; i < 2; ++i) {
    ends[i] = ::fcntl(low[i], F_DUPFD_CLOEXEC, kLeastDescriptor);
    ::close(low[i]);
  }
  if (ends[0] < 0 || ends[1] < 0) ThrowStart(program);
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return ends;
}

std::vector<std::string> EnvironmentWith(const std::vector<std::string>& changes) {
  const auto is_changed = [&](const std::string& entry) {
    const std::string name = entry.substr(0, entry.find('='));
    return std::any_of(changes.begin(), changes.end(), [&](const std::string& change) {
      return change.substr(0, change.find('=')) == name;
    });
  };
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!is_changed(*entry)) all.emplace_back(*entry);
  }
  for (const std::string& change : changes) {
    if (change.find('=') != std::string::npos) all.push_back(change);
  }
  return all;
}

std::vector<char*> PointersTo(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

// All that the new process needs; it may not allocate.
struct Launch {
  const char* folder = nullptr;  // null: the current one
  int log = -1, channel = -1;
  char* const* arguments = nullptr;
  char* const* environment = nullptr;
  pid_t parent = -1;
};

[[noreturn]] void RunInNewProcess(const Launch& launch) {
  ::setpgid(0, 0);
  // A second Ctrl-C ends this program at once.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != launch.parent) ::_exit(127);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(launch.log, STDOUT_FILENO);
  ::dup2(launch.log, STDERR_FILENO);
  if (launch.channel >= 0) {
    ::dup2(launch.channel, kChannelIn);
    ::dup2(launch.channel, kChannelOut);
  }
  if (launch.folder == nullptr || ::chdir(launch.folder) == 0) {
    ::execve(launch.arguments[0], launch.arguments, launch.environment);
  }
  constexpr char kFailed[] = "the program cannot be executed, or its folder is missing\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kFailed, sizeof kFailed - 1);
  ::_exit(127);
}

int MillisUntil(GroupClock::time_point deadline) {
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(deadline - GroupClock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, kLookEveryMillis));
}

// Closes `stream` at its end.
void ReadSomeOf(int& stream, std::string& to) {
  std::string buffer(kReadBytes, '\0');
  const ssize_t count = ::read(stream, buffer.data(), buffer.size());
  if (count > 0) {
    to.append(buffer, 0, static_cast<std::size_t>(count));
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    ::close(std::exchange(stream, -1));
  }
}

}  // namespace

ProcessGroup::ProcessGroup(const Settings& settings) : ends_on_stop_(settings.ends_on_stop) {
  const std::string& program = settings.command[0];
  std::array<int, 2> channel = {-1, -1};
  const std::array<int, 2> log = MakeStream(program);
  if (settings.has_channel) channel = MakeStream(program);
  const std::vector<std::string> environment = EnvironmentWith(settings.environment);
  const std::vector<char*> arguments = PointersTo(settings.command);
  const std::vector<char*> variables = PointersTo(environment);
  const Launch launch = {settings.folder.empty() ? nullptr : settings.folder.c_str(),
                         log[1],
                         channel[1],
                         arguments.data(),
                         variables.data(),
                         ::getpid()};
  process_ = ::fork();
  if (process_ == 0) RunInNewProcess(launch);
  const int reason = errno;
  ::close(log[1]);
  if (channel[1] >= 0) ::close(channel[1]);
  log_ = log[0];
  channel_ = channel[0];
  if (process_ > 0) {
    ::setpgid(process_, process_);  // whichever of the two is first
    exit_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));
    return;
  }
  ::close(log_);
  if (channel_ >= 0) ::close(channel_);
  errno = reason;
  ThrowStart(program);
}

ProcessGroup::~ProcessGroup() { End(); }

void ProcessGroup::StopIfUserStops() const {
  if (ends_on_stop_ && StopRequested()) throw std::runtime_error("interrupted");
}

void ProcessGroup::Signal(int signal) const {
  if (process_ > 0) ::kill(process_, signal);
}

void ProcessGroup::ReadLog() {
  ReadSomeOf(log_, lines_);
  // The oldest are of no use if there are so many.
  if (lines_.size() > kMostLogBytes) lines_.erase(0, lines_.size() - kMostLogBytes / 2);
}

void ProcessGroup::ReadChannel() { ReadSomeOf(channel_, received_); }

bool ProcessGroup::Read(Clock::time_point deadline) {
  while (!has_ended()) {
    StopIfUserStops();
    std::array<pollfd, 2> streams = {pollfd{channel_, POLLIN, 0}, pollfd{log_, POLLIN, 0}};
    if (::poll(streams.data(), streams.size(), MillisUntil(deadline)) > 0) {
      if (streams[0].revents != 0) ReadChannel();
      if (streams[1].revents != 0) ReadLog();
      has_closed_ = channel_ != streams[0].fd || log_ != streams[1].fd;
      return true;
    }
    if (Clock::now() >= deadline) return false;
  }
  return true;
}

bool ProcessGroup::Send(std::string_view bytes, Clock::time_point deadline) {
  while (!bytes.empty()) {
    StopIfUserStops();
    if (channel_ < 0) return false;
    const ssize_t count = ::send(channel_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
      continue;
    }
    if (errno != EAGAIN && errno != EINTR) return false;
    if (Clock::now() >= deadline) return false;
    pollfd writable = {channel_, POLLOUT, 0};
    ::poll(&writable, 1, MillisUntil(deadline));
  }
  return true;
}

std::string ProcessGroup::TakeReceived() { return std::exchange(received_, std::string()); }

std::optional<std::string> ProcessGroup::TakeLine() {
  const std::size_t end = lines_.find('\n');
  if (end == std::string::npos) {
    if (log_ >= 0 || lines_.empty()) return std::nullopt;
    return std::exchange(lines_, std::string());
  }
  std::string line = lines_.substr(0, end);
  lines_.erase(0, end + 1);
  return line;
}

// Ends when the last of its processes has: they have all inherited it.
void ProcessGroup::DrainLog() {
  constexpr std::chrono::seconds kPatience(5);  // one of them may be stuck in the kernel
  const Clock::time_point deadline = Clock::now() + kPatience;
  while (log_ >= 0 && Clock::now() < deadline) {
    pollfd readable = {log_, POLLIN, 0};
    if (::poll(&readable, 1, MillisUntil(deadline)) > 0) ReadLog();
  }
}

// One that has closed a stream is about to end: how, says more than that it was killed.
void ProcessGroup::AwaitEnd() const {
  constexpr int kPatienceMillis = 2000;
  pollfd end = {exit_, POLLIN, 0};
  if (has_closed_ && exit_ >= 0) ::poll(&end, 1, kPatienceMillis);
}

const std::string& ProcessGroup::End() {
  if (process_ < 0) return ending_;
  AwaitEnd();
  int status = 0;
  // One that has ended by itself keeps its status and, until it is waited for, the group's number.
  ::kill(-process_, SIGKILL);
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  ending_ = WIFSIGNALED(status)
                ? fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)))
                : fmt::format("exit code {}", WEXITSTATUS(status));
  DrainLog();
  if (channel_ >= 0) ::close(std::exchange(channel_, -1));
  if (log_ >= 0) ::close(std::exchange(log_, -1));
  if (exit_ >= 0) ::close(std::exchange(exit_, -1));
  return ending_;
}

}  // namespace kinescope::app
