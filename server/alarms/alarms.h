/// The alarms of a server: watches every state by the rules, and keeps what is on and what was. Any
/// thread; states and losses come from one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "server/alarms/reading.h"
#include "server/alarms/rule.h"
#include "server/alarms/watch.h"

namespace kinescope::alarms {

struct Acknowledgement {
  std::string role;
  std::int64_t nanos = 0;  // wall clock
};

struct Alarm {
  std::uint64_t id = 0;          // from 1
  Rule rule;                     // that it is of
  std::optional<int> character;  // of the person; nullopt: of the stream
  std::string person;            // name; "": of the stream
  std::optional<int> joint;      // urdf::Joint of the worst value
  Moment began;                  // the first sample beyond the limit
  std::optional<Moment> over;    // nullopt: it is on
  double value = 0;              // the last known one; of Quantity::kClass a LoadClass
  double worst = 0;
  int times = 1;  // that it was on; more than 1: it began again before it was acknowledged
  std::optional<Acknowledgement> acknowledged;

  bool is_on() const { return !over; }
  /// What people should still see: it is on, or it waits for being acknowledged.
  bool is_shown() const { return is_on() || (rule.latches && !acknowledged); }
};

/// "Anna: compression 3.72 kN, more than 3.40 kN"; "lost for 3.1 s". One line.
std::string Describe(const Alarm& alarm);

enum class Change { kBegan, kAcknowledged, kOver };

/// "began", "acknowledged", "over".
const char* Name(Change change);

class Alarms {
 public:
  using OnChange = std::function<void(const Alarm& alarm, Change change)>;

  /// A recording that ends is not lost: `is_live` is false then. `on_change` is called by the
  /// thread that changes an alarm, and must return at once; may be null.
  Alarms(Rules rules, bool is_live, OnChange on_change = nullptr);

  /// A state with new samples, or with what became of old ones.
  void OnState(const SceneState& state);
  /// Between states, a few times a second; `now_nanos`: of the clock of SceneState::made_nanos.
  /// `loss`: share of the samples lost or incomplete in the last 10 s; nullopt: unknown.
  void OnTime(std::int64_t now_nanos, std::optional<double> loss);

  /// Of one that is shown. @return the alarm, or why it is not possible, one line
  tl::expected<Alarm, std::string> Acknowledge(std::uint64_t id, const std::string& role);

  std::vector<Alarm> shown() const;  // highest priority first, then newest first
  std::vector<Alarm> log(std::size_t most = kMostKept) const;  // newest first, with those shown
  /// With the one that is always watched, and limits as they are now.
  std::vector<Rule> rules() const;
  bool tells_webhook() const { return tells_webhook_; }

  static constexpr std::size_t kMostKept = 1000;

 private:
  struct Person {
    std::string name;
    std::int64_t stamp_nanos = 0;  // of the newest sample
    std::int64_t seen_nanos = 0;   // made_nanos of the state that brought it
    /// Between that state and the one with the sample before; in a burst that before it, less what
    /// has passed since.
    std::int64_t period_nanos = 0;
  };
  using Key = std::pair<std::size_t, int>;  // place of the rule; character, or the whole stream
  struct Watched {
    Watch watch;
    std::uint64_t alarm = 0;  // id of the last one; 0: none
  };
  using Changes = std::vector<std::pair<std::uint64_t, Change>>;  // id
  using Events = std::vector<std::pair<Alarm, Change>>;

  // With mutex_ held:
  void Meet(const PersonState& person);
  /// Others make states while this person sends nothing: what the last sample says is not now.
  bool IsSilent(int character) const;
  void LookAtPerson(const SceneState& state, const PersonState& person, Changes& changes);
  void LookAtSilence(const Moment& now, Changes& changes);
  void EndLoadsOfAbsent(const SceneState& state, Changes& changes);
  void Look(const Key& key, const Reading& reading, const Moment& at, Changes& changes);
  void Begin(const Key& key, Watched& watched, Changes& changes);
  void End(const Watched& watched, const Moment& at, Changes& changes);
  void Forget(const Key& key, const Moment& at, Changes& changes);
  void DropOldest();
  Alarm* Find(std::uint64_t id);
  Events EventsOf(const Changes& changes);
  // Without it:
  void Tell(const Events& events) const;

  const bool tells_webhook_, is_live_;
  const OnChange on_change_;
  mutable std::mutex mutex_;
  // Guarded by mutex_:
  std::vector<Rule> rules_;
  std::map<Key, Watched> watched_;
  std::map<int, Person> people_;  // by character, who have been seen and are expected again
  std::deque<Alarm> alarms_;      // by ascending id
  std::uint64_t last_id_ = 0;
  Moment newest_;                             // of the newest state
  std::optional<std::int64_t> sample_nanos_;  // made_nanos of the newest live state; none came
};

}  // namespace kinescope::alarms
