#include "server/app/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace kinescope::app {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what, int total)
    : what_(std::move(what)), total_(total), is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (is_terminal_ && done_ > 0) std::fputc('\n', stderr);
}

double Progress::secs() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::Step() {
  ++done_;
  if (!is_terminal_) return;
  const auto now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100) && done_ != total_) return;
  drawn_ = now;
  Draw();
}

void Progress::Skip() {
  if (total_ > done_) --total_;
}

void Progress::Draw() const {
  const double rate = done_ / secs();
  if (total_ > 0) {
    std::fprintf(stderr, "\r%s %d of %d, %.0f per second, %.0f s left   ", what_.c_str(), done_,
                 total_, rate, (total_ - done_) / rate);
  } else {
    std::fprintf(stderr, "\r%s %d, %.0f per second   ", what_.c_str(), done_, rate);
  }
}

}  // namespace kinescope::app
