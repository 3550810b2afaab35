/// A line on the terminal that tells how far long work is, how fast and how long still. Nothing
/// where stderr is no terminal. One thread.
#pragma once

#include <chrono>
#include <string>

namespace kinescope::app {

class Progress {
 public:
  /// `total` 0: not known.
  Progress(std::string what, int total);
  ~Progress();  // leaves the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Step();
  /// One less to do than was thought.
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
