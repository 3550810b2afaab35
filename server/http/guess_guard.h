/// Slows down and reports wrong tokens. An address may send kPerMinute different ones in any
/// minute; the same one again is no guess: pages with the cookie of an earlier token repeat it. The
/// right token is never slowed down, or a guesser could lock out its owner. A token is safe because
/// it is long (kMinTokenLength). Time is an argument. Server's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "server/http/bucket.h"

namespace kinescope::http {

class GuessGuard {
 public:
  static constexpr std::size_t kPerMinute = 10;

  /// `warn` receives a line about wrong tokens, never the token, at most once per minute.
  explicit GuessGuard(std::function<void(const std::string&)> warn) : warn_(std::move(warn)) {}

  /// Counts a wrong token. Returns the whole seconds after which `address` may send another one; 0:
  /// it has not used up its share.
  [[nodiscard]] int OnWrong(const std::string& address, std::string_view wrong,
                            Clock::time_point now);
  /// Reports what was counted since the last line, if that is a minute ago. Call it now and then.
  void Report(Clock::time_point now);

 private:
  struct Guesses {
    std::deque<Clock::time_point> counted;  // of the last minute, the oldest first
    std::deque<std::size_t> seen;           // hashes of the last wrong tokens
    std::uint64_t line = 0;                 // the last line that counts this address
  };
  /// What was counted for `address`, without what is older than a minute.
  Guesses& Of(const std::string& address, Clock::time_point now);

  std::function<void(const std::string&)> warn_;
  PerAddress<Guesses> addresses_;
  // Since the last line.
  std::uint64_t line_ = 1;  // number of the next one
  std::uint64_t count_ = 0;
  std::size_t address_count_ = 0;
  std::string last_address_;
  Clock::time_point next_line_{};
};

}  // namespace kinescope::http
