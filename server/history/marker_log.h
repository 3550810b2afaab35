/// The external markers of former states. They change seldom, or ten times a second and all at
/// once: so each list is kept from the state on that had it first, and a marker that stays is
/// shared. Where that is too much, large markers, such as clouds, are forgotten first, each with a
/// word in its place (SceneMarker::text). One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>

#include "core/scene_state.h"

namespace kinescope::history {

class MarkerLog {
 public:
  /// Of more than `most_bytes`, the oldest large markers are forgotten, then the oldest lists. The
  /// newest list is always kept.
  explicit MarkerLog(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// @pre the number is above that of the state before.
  void Add(const SceneState& state);
  /// Of the state of this number. Empty if it had none, or if they are forgotten.
  const MarkerList& Of(std::uint64_t number) const;
  /// The lists that only states below `first_number` had.
  void ForgetBefore(std::uint64_t first_number);

  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::uint64_t first_number = 0;  // of the states that had this list
    MarkerList markers;
  };
  void Use(const std::shared_ptr<const SceneMarker>& marker);
  void Release(const std::shared_ptr<const SceneMarker>& marker);
  void ForgetLarge(std::size_t entry);
  void DropOldest();

  const std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::deque<Entry> entries_;
  std::size_t bare_ = 0;  // of the first entries, the large markers are forgotten
  std::unordered_map<const SceneMarker*, std::size_t> uses_;  // in how many lists a marker is
};

}  // namespace kinescope::history
