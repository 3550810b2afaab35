#include "server/alarms/alarms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/system/clocks.h"

namespace kinescope::alarms {
namespace {

constexpr int kStream = -1;  // in place of a character

bool IsOfSilence(const Rule& rule) {
  return rule.quantity == Quantity::kStale || rule.quantity == Quantity::kLost;
}

bool IsReadOfStates(const Rule& rule) {
  return !IsOfSilence(rule) && rule.quantity != Quantity::kLoss;
}

std::vector<Rule> WithLost(Rules rules) {
  rules.rules.push_back(LostRule(rules.lost_secs));
  return std::move(rules.rules);
}

std::string ValueText(const Rule& rule, double value) {
  switch (rule.quantity) {
    case Quantity::kClass: return Name(static_cast<LoadClass>(std::lround(value)));
    case Quantity::kCompression: return fmt::format("{:.2f} kN", value / 1000);
    case Quantity::kMargin: return fmt::format("{:.1f} cm", value * 100);
    case Quantity::kStale:
    case Quantity::kLost: return fmt::format("{:.1f} s", value);
    case Quantity::kLoss: return fmt::format("{:.1f} %", value * 100);
    case Quantity::kRatio:
    case Quantity::kExposure: break;
  }
  return fmt::format("{:.0f} %", value * 100);
}

std::string SubjectText(const Alarm& alarm) {
  const std::string joint(alarm.joint ? urdf::kJoints[urdf::At(*alarm.joint)].label : "");
  switch (alarm.rule.quantity) {
    case Quantity::kRatio: return joint + " load";
    case Quantity::kClass: return joint + " load class";
    case Quantity::kExposure:
      return fmt::format("{} time in class {}{}", joint, Name(alarm.rule.least_class),
                         alarm.rule.least_class == LoadClass::kMedium ? " or high" : "");
    case Quantity::kCompression: return "L5/S1 compression";
    case Quantity::kMargin: return "margin of stability";
    case Quantity::kLoss: return "samples lost or incomplete in 10 s";
    case Quantity::kStale: return "no sample for";
    case Quantity::kLost: return "lost for";
  }
  return "";
}

std::string LimitText(const Rule& rule) {
  if (IsOfSilence(rule) || rule.quantity == Quantity::kClass) return "";
  return fmt::format(", {} than {}", rule.quantity == Quantity::kMargin ? "less" : "more",
                     ValueText(rule, rule.limit));
}

}  // namespace

std::string Describe(const Alarm& alarm) {
  return fmt::format("{}: {} {}{}", alarm.person.empty() ? "stream" : alarm.person,
                     SubjectText(alarm), ValueText(alarm.rule, alarm.worst), LimitText(alarm.rule));
}

const char* Name(Change change) {
  switch (change) {
    case Change::kBegan: return "began";
    case Change::kAcknowledged: return "acknowledged";
    case Change::kOver: return "over";
  }
  return "";
}

Alarms::Alarms(Rules rules, bool is_live, OnChange on_change)
    : tells_webhook_(!rules.webhook.empty()),
      is_live_(is_live),
      on_change_(std::move(on_change)),
      rules_(WithLost(std::move(rules))) {}

std::vector<Rule> Alarms::rules() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rules_;
}

void Alarms::OnState(const SceneState& state) {
  if (state.liveness == Liveness::kNoData || state.liveness == Liveness::kNoPerson) return;
  Changes changes;
  Events events;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = {state.number, state.made_nanos, state.stamp_nanos};
    for (Rule& rule : rules_) FollowClassLimits(state.class_limits, rule);
    const bool is_live = state.liveness == Liveness::kLive;
    if (is_live) sample_nanos_ = state.made_nanos;
    for (const PersonState& person : state.people) {
      if (is_live) Meet(person);
      LookAtPerson(state, person, changes);
    }
    if (is_live) EndLoadsOfAbsent(state, changes);
    LookAtSilence(newest_, changes);
    events = EventsOf(changes);
  }
  Tell(events);
}

void Alarms::Meet(const PersonState& person) {
  const auto [known, is_new] = people_.try_emplace(person.character);
  known->second.name = person.name;
  if (!is_new && known->second.stamp_nanos == person.sample.stamp_nanos) return;
  known->second.stamp_nanos = person.sample.stamp_nanos;
  if (!is_new) {
    const std::int64_t interval = newest_.made_nanos - known->second.seen_nanos;
    known->second.period_nanos = std::max(interval, known->second.period_nanos - interval);
  }
  known->second.seen_nanos = newest_.made_nanos;
}

bool Alarms::IsSilent(int character) const {
  constexpr std::int64_t kShortest = 250'000'000, kLongest = 1'000'000'000;
  const auto known = people_.find(character);
  if (known == people_.end()) return false;
  const Person& person = known->second;
  return newest_.made_nanos - person.seen_nanos >
         std::clamp(2 * person.period_nanos, kShortest, kLongest);
}

void Alarms::LookAtPerson(const SceneState& state, const PersonState& person, Changes& changes) {
  const bool is_silent = IsSilent(person.character);
  for (std::size_t place = 0; place < rules_.size(); ++place) {
    const Rule& rule = rules_[place];
    if (!IsReadOfStates(rule)) continue;
    const auto watched = watched_.find({place, person.character});
    const Alarm* const alarm = watched == watched_.end() ? nullptr : Find(watched->second.alarm);
    const auto joint = alarm == nullptr ? std::nullopt : alarm->joint;
    const Reading reading = is_silent ? Reading{} : ReadingOf(rule, state, person, joint);
    Look({place, person.character}, reading, newest_, changes);
  }
}

void Alarms::EndLoadsOfAbsent(const SceneState& state, Changes& changes) {
  if (state.people.size() == people_.size()) return;
  for (const auto& [character, person] : people_) {
    const auto is_this = [character = character](const PersonState& each) {
      return each.character == character;
    };
    if (std::any_of(state.people.begin(), state.people.end(), is_this)) continue;
    for (std::size_t place = 0; place < rules_.size(); ++place) {
      if (IsReadOfStates(rules_[place])) Forget({place, character}, newest_, changes);
    }
  }
}

void Alarms::OnTime(std::int64_t now_nanos, std::optional<double> loss) {
  Changes changes;
  Events events;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Moment now = newest_;
    now.made_nanos = std::max(now_nanos, newest_.made_nanos);
    for (std::size_t place = 0; place < rules_.size(); ++place) {
      if (rules_[place].quantity != Quantity::kLoss) continue;
      Look({place, kStream}, {loss, std::nullopt}, now, changes);
    }
    LookAtSilence(now, changes);
    events = EventsOf(changes);
  }
  Tell(events);
}

// While the whole stream is silent, no person is lost.
void Alarms::LookAtSilence(const Moment& now, Changes& changes) {
  if (!is_live_ || !sample_nanos_) return;
  const double stream_secs = Secs(now.made_nanos - *sample_nanos_);
  for (std::size_t place = 0; place < rules_.size(); ++place) {
    const Rule& rule = rules_[place];
    if (!IsOfSilence(rule)) continue;
    Look({place, kStream}, {stream_secs, std::nullopt}, now, changes);
    if (rule.quantity != Quantity::kLost) continue;
    for (const auto& [character, person] : people_) {
      const double secs = Secs(*sample_nanos_ - person.seen_nanos);
      Look({place, character}, {secs, std::nullopt}, now, changes);
    }
  }
}

void Alarms::Look(const Key& key, const Reading& reading, const Moment& at, Changes& changes) {
  const Rule& rule = rules_[key.first];
  Watched& watched = watched_[key];
  const Watch::Step step = watched.watch.OnValue(rule, reading.value, at);
  if (step == Watch::Step::kBegins) Begin(key, watched, changes);
  if (step == Watch::Step::kEnds) End(watched, at, changes);
  Alarm* const alarm = watched.watch.is_on() ? Find(watched.alarm) : nullptr;
  if (alarm == nullptr || !reading.value) return;
  alarm->value = *reading.value;
  const bool is_worst =
      step == Watch::Step::kBegins || Worse(rule, *reading.value, alarm->worst) != alarm->worst;
  if (!is_worst) return;
  alarm->worst = watched.watch.worst();
  alarm->joint = reading.joint;
}

void Alarms::Begin(const Key& key, Watched& watched, Changes& changes) {
  Alarm* alarm = Find(watched.alarm);
  if (alarm != nullptr && alarm->is_shown()) {
    alarm->over.reset();
    ++alarm->times;
  } else {
    Alarm begun;
    begun.id = watched.alarm = ++last_id_;
    begun.rule = rules_[key.first];
    begun.began = watched.watch.since();
    if (key.second != kStream) {
      const std::string& name = people_[key.second].name;
      begun.character = key.second;
      begun.person = name.empty() ? "character " + std::to_string(key.second) : name;
    }
    alarms_.push_back(std::move(begun));
    alarm = &alarms_.back();
    DropOldest();
  }
  changes.emplace_back(alarm->id, Change::kBegan);
}

void Alarms::DropOldest() {
  if (alarms_.size() <= kMostKept) return;
  const auto oldest = std::find_if(alarms_.begin(), alarms_.end(),
                                   [](const Alarm& alarm) { return !alarm.is_shown(); });
  if (oldest != alarms_.end()) alarms_.erase(oldest);
}

void Alarms::End(const Watched& watched, const Moment& at, Changes& changes) {
  Alarm* const alarm = Find(watched.alarm);
  if (alarm == nullptr) return;
  alarm->over = at;
  changes.emplace_back(alarm->id, Change::kOver);
}

void Alarms::Forget(const Key& key, const Moment& at, Changes& changes) {
  const auto watched = watched_.find(key);
  if (watched == watched_.end()) return;
  if (watched->second.watch.is_on()) End(watched->second, at, changes);
  watched_.erase(watched);
}

tl::expected<Alarm, std::string> Alarms::Acknowledge(std::uint64_t id, const std::string& role) {
  Changes changes;
  Events events;
  std::optional<Alarm> answer;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Alarm* const alarm = Find(id);
    if (alarm == nullptr) return tl::unexpected("alarm " + std::to_string(id) + " is not known");
    if (alarm->acknowledged) {
      return tl::unexpected("alarm " + std::to_string(id) + " has been acknowledged before");
    }
    if (!alarm->is_shown()) return tl::unexpected("alarm " + std::to_string(id) + " is over");
    alarm->acknowledged = {role, WallNanos()};
    answer = *alarm;
    changes.emplace_back(id, Change::kAcknowledged);
    // A person whose loss is known is expected no longer.
    if (alarm->rule.quantity == Quantity::kLost && alarm->character) {
      const int character = *alarm->character;
      people_.erase(character);
      Forget({rules_.size() - 1, character}, newest_, changes);
    }
    events = EventsOf(changes);
  }
  Tell(events);
  return *answer;
}

Alarms::Events Alarms::EventsOf(const Changes& changes) {
  Events events;
  events.reserve(changes.size());
  for (const auto& [id, change] : changes) {
    if (const Alarm* const alarm = Find(id)) events.emplace_back(*alarm, change);
  }
  return events;
}

void Alarms::Tell(const Events& events) const {
  if (!on_change_) return;
  for (const auto& [alarm, change] : events) on_change_(alarm, change);
}

Alarm* Alarms::Find(std::uint64_t id) {
  const auto found =
      std::lower_bound(alarms_.begin(), alarms_.end(), id,
                       [](const Alarm& alarm, std::uint64_t wanted) { return alarm.id < wanted; });
  return found == alarms_.end() || found->id != id ? nullptr : &*found;
}

std::vector<Alarm> Alarms::shown() const {
  std::vector<Alarm> shown;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::copy_if(alarms_.rbegin(), alarms_.rend(), std::back_inserter(shown),
                 [](const Alarm& alarm) { return alarm.is_shown(); });
  }
  std::stable_sort(shown.begin(), shown.end(), [](const Alarm& one, const Alarm& other) {
    return one.rule.priority > other.rule.priority;
  });
  return shown;
}

std::vector<Alarm> Alarms::log(std::size_t most) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto count = static_cast<std::ptrdiff_t>(std::min(most, alarms_.size()));
  return {alarms_.rbegin(), std::next(alarms_.rbegin(), count)};
}

}  // namespace kinescope::alarms
