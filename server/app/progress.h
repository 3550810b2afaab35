/// Progress of long work on stderr: done, rate, time left. One thread.
#pragma once

#include <chrono>
#include <string>

namespace kinescope::app {

enum class ProgressForm {
  kAuto,  // a line that is drawn anew, if stderr is a terminal
  kJson,  // lines for programs, one a second: {"progress":"samples","done":60,"total":480,…}
  kOff,
};

/// Of everything that begins from now on. Call it before threads are started.
void SetProgressForm(ProgressForm form);

class Progress {
 public:
  /// `total` 0: unknown. `quiet_secs`: for so long nothing is printed, as it may be done by then.
  Progress(std::string what, int total, double quiet_secs = 0);
  ~Progress();  // ends the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Step();
  /// One step less than expected.
  void Skip();
  double secs() const;

 private:
  void Draw() const;
  void PrintJson() const;

  const std::string what_;
  int total_;
  const double quiet_secs_;
  const ProgressForm form_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point drawn_{};
  int done_ = 0;
  int drawn_done_ = 0;  // when it was drawn
};

}  // namespace kinescope::app
