/// A budget that refills with time, and one such budget per address of a client. Time is an
/// argument. One thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <map>
#include <string>

namespace kinescope::http {

using Clock = std::chrono::steady_clock;

/// Full at first.
class Bucket {
 public:
  Bucket(double capacity, double per_second, Clock::time_point now)
      : capacity_(capacity), per_second_(per_second), level_(capacity), at_(now) {}

  /// Time until `amount` is there; zero or less: it is. @pre amount <= capacity
  [[nodiscard]] std::chrono::duration<double> WaitFor(double amount, Clock::time_point now) {
    Refill(now);
    return std::chrono::duration<double>((amount - level_) / per_second_);
  }
  void Take(double amount, Clock::time_point now) {
    Refill(now);
    level_ = std::max(0.0, level_ - amount);
  }
  [[nodiscard]] bool IsFull(Clock::time_point now) {
    Refill(now);
    return level_ >= capacity_;
  }

 private:
  void Refill(Clock::time_point now) {
    const double secs = std::chrono::duration<double>(now - at_).count();
    level_ = std::min(capacity_, level_ + std::max(0.0, secs) * per_second_);
    at_ = std::max(at_, now);
  }

  double capacity_, per_second_, level_;
  Clock::time_point at_;
};

/// A `Value` per address, made when it is first needed. Of more than kMaxAddresses, those for which
/// `is_idle` is true are forgotten, and if there are none, all: a client with very many addresses
/// costs no memory.
template <class Value>
class PerAddress {
 public:
  static constexpr std::size_t kMaxAddresses = 1024;

  template <class Make, class IsIdle>
  Value& At(const std::string& address, Make make, IsIdle is_idle) {
    const auto found = values_.find(address);
    if (found != values_.end()) return found->second;
    if (values_.size() >= kMaxAddresses) Forget(is_idle);
    return values_.emplace(address, make()).first->second;
  }
  [[nodiscard]] std::size_t size() const { return values_.size(); }

 private:
  template <class IsIdle>
  void Forget(IsIdle is_idle) {
    for (auto i = values_.begin(); i != values_.end();) {
      i = is_idle(i->second) ? values_.erase(i) : std::next(i);
    }
    if (values_.size() >= kMaxAddresses) values_.clear();
  }

  std::map<std::string, Value> values_;
};

}  // namespace kinescope::http
