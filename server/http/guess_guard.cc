#include "server/http/guess_guard.h"

#include <algorithm>
#include <cmath>

#include "core/system/words.h"

namespace kinescope::http {
namespace {

constexpr std::size_t kRemembered = 32;  // wrong tokens of one address
constexpr std::chrono::minutes kGuessWindow{1};
constexpr std::chrono::minutes kLinePause{1};

}  // namespace

GuessGuard::Guesses& GuessGuard::Of(const std::string& address, Clock::time_point now) {
  const auto forget_old = [&](Guesses& guesses) {
    auto& counted = guesses.counted;
    while (!counted.empty() && now - counted.front() >= kGuessWindow) counted.pop_front();
  };
  Guesses& guesses = addresses_.At(
      address, [] { return Guesses{}; },
      [&](Guesses& each) {
        forget_old(each);
        return each.counted.empty();
      });
  forget_old(guesses);
  return guesses;
}

int GuessGuard::OnWrong(const std::string& address, std::string_view wrong, Clock::time_point now) {
  Guesses& guesses = Of(address, now);
  const std::size_t hash = std::hash<std::string_view>()(wrong);
  if (std::count(guesses.seen.begin(), guesses.seen.end(), hash) > 0) return 0;
  ++count_;
  if (std::exchange(guesses.line, line_) != line_) ++address_count_;
  last_address_ = address;
  Report(now);
  if (guesses.counted.size() >= kPerMinute) {
    const std::chrono::duration<double> wait = guesses.counted.front() + kGuessWindow - now;
    return static_cast<int>(std::ceil(wait.count()));
  }
  guesses.counted.push_back(now);
  guesses.seen.push_back(hash);
  if (guesses.seen.size() > kRemembered) guesses.seen.pop_front();
  return 0;
}

void GuessGuard::Report(Clock::time_point now) {
  if (count_ == 0 || now < next_line_) return;
  next_line_ = now + kLinePause;
  std::string line = "page: " + Counted(count_, "wrong token");
  if (address_count_ > 1)
    line += " from " + std::to_string(address_count_) + " addresses, the last";
  if (warn_) warn_(line + " from " + last_address_);
  ++line_;
  count_ = 0;
  address_count_ = 0;
}

}  // namespace kinescope::http
