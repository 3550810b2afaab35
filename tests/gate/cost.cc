// Runs a command and appends a line to the file KINESCOPE_COSTS: its kind, its name, and the CPU
// seconds of it and of all its descendants. Without KINESCOPE_COSTS it becomes the command.
//   cost unit COMMAND...        the name is the word after -o
//   cost test:NAME COMMAND...   NAME; for a program of many tests (NAME empty), the program and its
//   --gtest_filter
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

double CpuSeconds(const rusage& usage) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string NameOf(const std::string& kind, char** command) {
  const std::string test = "test:", filter = "--gtest_filter=";
  if (kind.size() > test.size()) return kind.substr(test.size());
  std::string name = *command;
  name.erase(0, name.rfind('/') + 1);
  for (char** word = command; *word != nullptr; ++word) {
    if (kind == "unit" && std::strcmp(*word, "-o") == 0 && word[1] != nullptr) return word[1];
    if (std::strncmp(*word, filter.c_str(), filter.size()) == 0)
      return name + "." + (*word + filter.size());
  }
  return name;
}

void Append(const char* path, const std::string& line) {
  const int file = ::open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return;  // the figures are missing, and nothing else
  static_cast<void>(!::write(file, line.data(), line.size()));
  ::close(file);
}

[[noreturn]] void Become(char** command) {
  ::execvp(*command, command);
  std::perror(*command);
  std::_Exit(127);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: cost unit|test:NAME COMMAND...\n");
    return 2;
  }
  const char* const path = std::getenv("KINESCOPE_COSTS");
  if (path == nullptr) Become(argv + 2);

  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // what the command leaves behind is counted, too
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // ctest ends a test by killing this process
    if (::getppid() != parent) std::_Exit(127);
    Become(argv + 2);
  }
  if (child < 0) {
    std::perror("cost: fork");
    return 127;
  }
  std::signal(SIGINT, SIG_IGN);  // of the terminal: the command has it, too, and decides
  int status = 0;
  for (;;) {
    int other = 0;
    const pid_t ended = ::wait(&other);
    if (ended < 0) return 127;
    if (ended != child) continue;
    status = other;
    break;
  }
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const std::string kind = argv[1];
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3f", CpuSeconds(usage));
  Append(path, kind.substr(0, 4) + "\t" + NameOf(kind, argv + 2) + "\t" + seconds + "\n");
  if (WIFSIGNALED(status)) {
    std::signal(WTERMSIG(status), SIG_DFL);
    ::raise(WTERMSIG(status));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 127;
}
