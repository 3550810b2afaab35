/// What people hold, who said so and since when. Each change is a mark at its sample. Loads that
/// come over ROS, perhaps many times a second from a load cell, are marked if they differ by
/// kLeastKg from the one that was marked last: at most one a second and person, the newest. Any
/// thread.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/force_inputs.h"
#include "server/app/serve/control_status.h"
#include "server/app/serve/operator_log.h"

namespace kinescope::app {

class HandLoadLog {
 public:
  static constexpr std::int64_t kMarkEveryNanos = 1'000'000'000;
  static constexpr double kLeastKg = 0.1;  // the noise of load cells is less

  /// `log` is borrowed. `first`: of all people, as the server was started.
  HandLoadLog(OperatorLog& log, const HandLoad& first) : log_(log), first_(first) {}

  [[nodiscard]] HandLoad Of(int character) const;
  /// By character; without people who hold what they held at the start.
  [[nodiscard]] std::map<int, HeldLoad> all() const;

  /// `name`: of the person, for the mark. `stated`: what counts for them now, perhaps as the node
  /// of the suit was told.
  void OnOrder(int character, const std::string& name, const HandLoad& load, std::string_view role,
               const HandLoad& stated = HandLoad());
  /// A load that came over ROS at `now_nanos` of the monotonic clock.
  void OnRos(int character, const std::string& name, const HandLoad& load, std::int64_t now_nanos,
             const HandLoad& stated = HandLoad());
  /// Marks what is due. Call it many times a second, with the clock of OnRos.
  void OnTime(std::int64_t now_nanos);
  /// Marks what waits, before the end.
  void Flush();

 private:
  // Of loads over ROS.
  struct Waiting {
    std::string name;
    HandLoad marked;                     // last
    std::optional<marks::Moment> since;  // of what is held, if it has not been marked
    std::int64_t next_nanos = 0;         // no mark before
  };

  // Called with mutex_ locked.
  HandLoad Held(int character) const;
  HandLoad Before(int character, const HandLoad& stated) const;
  void MarkIfDue(int character, Waiting& waiting, std::int64_t now_nanos);
  void MarkRos(int character, Waiting& waiting);

  OperatorLog& log_;
  const HandLoad first_;
  mutable std::mutex mutex_;
  std::map<int, HeldLoad> held_;    // by character; guarded by mutex_
  std::map<int, Waiting> waiting_;  // by character; guarded by mutex_
};

}  // namespace kinescope::app
