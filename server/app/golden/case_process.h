/// A process of this program that compares golden cases on request (golden_jobs.h), so that one
/// that crashes or hangs takes no other with it. One thread.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace kinescope::app {

class CaseProcess {
 public:
  /// `command[0]` is a path. Standard input and output of the process are connected with this
  /// object; the rest is inherited. @throws std::runtime_error if it cannot be started.
  explicit CaseProcess(const std::vector<std::string>& command);
  /// Ends it.
  ~CaseProcess();
  CaseProcess(const CaseProcess&) = delete;
  CaseProcess& operator=(const CaseProcess&) = delete;

  /// Readable when it has answered or ended.
  int fd() const { return socket_; }

  /// Asks for a case. That the process has ended is seen by Read().
  void Ask(const std::string& case_name);

  /// Adds the lines that have arrived. @return false if it has ended, or says more than a verdict
  /// can have.
  bool Read(std::vector<std::string>& lines);

  /// Ends it, and says how it had ended before: "ended with signal 11 (Segmentation fault)", "ended
  /// with exit code 3".
  std::string End();

 private:
  pid_t process_ = -1;
  int socket_ = -1;
  std::string received_;  // of the line that is not complete
};

}  // namespace kinescope::app
