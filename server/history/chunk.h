/// Some successive states of one form, compressed. Immutable; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::history {

/// Whether both have the same people with the same models, gloves, props and scored joints, the
/// same tracked objects, robots and people left out: what a chunk keeps once.
bool SameForm(const SceneState& a, const SceneState& b);

class Chunk {
 public:
  /// `before`: the chunk before, whose form is shared if it is the same; may be null.
  /// @pre `states` is not empty, and all have the form of its first.
  Chunk(const std::vector<std::shared_ptr<const SceneState>>& states, const Chunk* before);

  /// The values of all states, each a row.
  class Rows {
   public:
    std::size_t count() const { return count_; }
    std::uint64_t number(std::size_t row) const {
      return static_cast<std::uint64_t>(values_[row * columns_]);
    }
    std::int64_t made_nanos(std::size_t row) const { return values_[row * columns_ + 1]; }

   private:
    friend class Chunk;
    std::size_t count_ = 0, columns_ = 0;
    std::vector<std::int64_t> values_;
  };
  Rows Unpack() const;

  /// A state of Unpack(). Lengths are rounded to 0.01 mm, orientations to 0.004 degrees, forces to
  /// 0.1 N and ratios to 0.00001. What the history does not keep is empty: the samples as they were
  /// received, joint angles and forces, velocities, and external markers. Links of robots that are
  /// not drawn are nowhere.
  std::shared_ptr<SceneState> At(const Rows& rows, std::size_t row) const;

  std::uint64_t first_number() const { return first_number_; }
  std::uint64_t last_number() const { return last_number_; }
  std::int64_t first_nanos() const { return first_nanos_; }  // SceneState::made_nanos
  std::int64_t last_nanos() const { return last_nanos_; }
  /// Of memory, without what others share: models, and the form of the chunk before.
  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t count_ = 0, columns_ = 0, length_ = 0, bytes_ = 0;
  std::uint64_t first_number_ = 0, last_number_ = 0;
  std::int64_t first_nanos_ = 0, last_nanos_ = 0;
  std::shared_ptr<const SceneState> form_;  // its other values are those of some state
  std::vector<std::string_view> texts_;
  std::vector<std::uint8_t> packed_;  // `length_` bytes, compressed
};

}  // namespace kinescope::history
