/// Progress line on stderr: done, rate, time left. Prints nothing if stderr is not a terminal. One
/// thread.
#pragma once

#include <chrono>
#include <string>

namespace kinescope::app {

class Progress {
 public:
  /// `total` 0: unknown.
  Progress(std::string what, int total);
  ~Progress();  // ends the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Step();
  /// One step less than expected.
  void Skip();
  double secs() const;

 private:
  void Draw() const;

  const std::string what_;
  int total_;
  const bool is_terminal_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point drawn_{};
  int done_ = 0;
};

}  // namespace kinescope::app
