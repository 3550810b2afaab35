#include "server/app/serve/hand_load_log.h"

#include <cmath>
#include <cstddef>

#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostPeople = 256;  // characters of a stream

bool Differ(const HandLoad& a, const HandLoad& b) {
  const auto differ = [](double x, double y) { return !(std::abs(x - y) < HandLoadLog::kLeastKg); };
  return a.is_known != b.is_known || differ(a.both_kg, b.both_kg) ||
         differ(a.mass_kg[0], b.mass_kg[0]) || differ(a.mass_kg[1], b.mass_kg[1]);
}

}  // namespace

HandLoad HandLoadLog::Held(int character) const {
  const auto held = held_.find(character);
  return held != held_.end() ? held->second.load : first_;
}

// An order takes precedence over what the node of the suit was told, and that over nothing.
HandLoad HandLoadLog::Before(int character, const HandLoad& stated) const {
  const bool was_set_here = held_.count(character) > 0 || first_.is_known;
  return was_set_here || !stated.is_known ? Held(character) : stated;
}

HandLoad HandLoadLog::Of(int character) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return Held(character);
}

std::map<int, HeldLoad> HandLoadLog::all() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return held_;
}

void HandLoadLog::OnOrder(int character, const std::string& name, const HandLoad& load,
                          std::string_view role, const HandLoad& stated) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto waiting = waiting_.find(character);
  if (waiting != waiting_.end()) {
    MarkRos(character, waiting->second);
    waiting->second.marked = load;
  }
  log_.Note(role, "hand load of " + name, TextOf(Before(character, stated)), TextOf(load));
  held_[character] = {load, WallNanos() / 1000, std::string(role)};
}

void HandLoadLog::OnRos(int character, const std::string& name, const HandLoad& load,
                        std::int64_t now_nanos, const HandLoad& stated) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (held_.size() >= kMostPeople && held_.count(character) == 0) return;
  const HandLoad before = Before(character, stated);
  Waiting& waiting = waiting_.try_emplace(character, Waiting{name, before, {}, 0}).first->second;
  waiting.name = name;
  held_[character] = {load, WallNanos() / 1000, "ROS"};
  if (!Differ(load, waiting.marked)) {
    waiting.since.reset();
  } else if (!waiting.since || Differ(load, before)) {
    waiting.since = log_.Now();
  }
  MarkIfDue(character, waiting, now_nanos);
}

void HandLoadLog::OnTime(std::int64_t now_nanos) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [character, waiting] : waiting_) MarkIfDue(character, waiting, now_nanos);
}

void HandLoadLog::Flush() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [character, waiting] : waiting_) MarkRos(character, waiting);
}

void HandLoadLog::MarkIfDue(int character, Waiting& waiting, std::int64_t now_nanos) {
  if (!waiting.since || now_nanos < waiting.next_nanos) return;
  MarkRos(character, waiting);
  waiting.next_nanos = now_nanos + kMarkEveryNanos;
}

void HandLoadLog::MarkRos(int character, Waiting& waiting) {
  if (!waiting.since) return;
  const HandLoad now = Held(character);
  log_.Note(kRosRole, "hand load of " + waiting.name, TextOf(waiting.marked), TextOf(now),
            *waiting.since);
  waiting.marked = now;
  waiting.since.reset();
}

}  // namespace kinescope::app
