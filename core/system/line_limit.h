/// For lines of the log that others can cause: at most one a second. One thread.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "core/system/clocks.h"

namespace kinescope {

class LineLimit {
 public:
  /// `line` if it is due, with the number of those that were left out before it; else "".
  /// @param now_nanos  monotonic clock
  std::string Pass(std::string line, std::int64_t now_nanos) {
    if (passed_nanos_ != 0 && now_nanos - passed_nanos_ < kNanosPerSecond) {
      ++left_out_;
      return "";
    }
    passed_nanos_ = now_nanos;
    if (left_out_ > 0) line += " (and " + std::to_string(std::exchange(left_out_, 0)) + " more)";
    return line;
  }

 private:
  std::int64_t passed_nanos_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace kinescope
