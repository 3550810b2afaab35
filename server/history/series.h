/// The numbers that plots and the strip of time show, beside the states of a history: per person
/// and sample the joint loads, compression, margin of stability, CoM, CoP, rate and loss, as whole
/// steps, about 64 bytes. Asking gives the smallest and the largest value per column of time, so
/// that a peak of one sample is seen in an hour. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::history {

/// How many joints have a ratio of their own: the first keys, in the order of urdf::kScoredJoints.
inline constexpr std::size_t kSeriesJoints = urdf::kScoredJointCount;

/// A value of each sample. `steps`: per unit; what is kept is rounded to one step.
struct SeriesKey {
  std::string_view name;  // "l5_s1", "compression"
  std::string_view unit;  // "1" for ratios and numbers of joints
  double steps = 1;
};

enum SeriesIndex : std::size_t {
  kCompression = kSeriesJoints,  // L5/S1, N
  kMargin,                       // of stability, m; positive inside the support polygon
  kMediumJoints,                 // numbers of joints by the class that people see; medium: or high
  kHighJoints,
  kUnknownJoints,
  kRate,  // of the stream, Hz
  kLoss,  // share of this person's samples that were lost in the second up to this one
  kComX,  // on the floor, world, m
  kComY,
  kCopX,
  kCopY,
  kSeriesKeyCount,
};

/// By SeriesIndex.
const std::array<SeriesKey, kSeriesKeyCount>& SeriesKeys();

/// nullopt for an unknown name.
std::optional<std::size_t> FindSeriesKey(std::string_view name);

struct SeriesLimits {
  std::int64_t nanos = 600'000'000'000;       // older samples are forgotten
  std::size_t bytes = std::size_t{96} << 20;  // and the oldest of more than that
};

/// In whole steps of its key.
struct SeriesColumn {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();
  std::int32_t min = kNone, max = kNone, last = kNone;  // kNone: unknown in all of its samples
  bool is_known() const { return last != kNone; }
};

struct SeriesQuestion {
  int character = 0;
  std::vector<std::size_t> keys;                 // SeriesIndex
  std::int64_t from_nanos = 0, until_nanos = 0;  // by SceneState::made_nanos, without the last
  std::size_t columns = 1;                       // of equal width
};

struct SeriesAnswer {
  std::vector<std::uint32_t> samples;             // by column
  std::vector<std::vector<SeriesColumn>> by_key;  // by place in `keys`, then by column
};

class Series {
 public:
  explicit Series(SeriesLimits limits = {}) : limits_(limits) {}

  /// Keeps the people who have a new sample in `state`, or whose loads are no longer known since
  /// the stream has stopped. @pre made_nanos is not below that of the state before.
  void Add(const SceneState& state);

  /// nullopt for a person without any kept sample.
  /// @pre from_nanos < until_nanos, at most a day apart; 1 <= columns <= 1'000'000; keys are valid.
  std::optional<SeriesAnswer> Ask(const SeriesQuestion& question) const;

  std::vector<int> characters() const;  // with a kept sample, ascending
  std::size_t bytes() const;

 private:
  static constexpr std::size_t kBlockRows = 64;
  static constexpr std::size_t kNarrowKeys = kComX;  // those before take 16 bits
  static constexpr std::size_t kWideKeys = kSeriesKeyCount - kNarrowKeys;

  // Successive samples of one person.
  struct Block {
    std::int64_t first_nanos = 0;
    std::size_t count = 0;
    std::array<std::uint32_t, kBlockRows> after_micros{};  // of first_nanos
    std::array<std::array<std::int16_t, kBlockRows>, kNarrowKeys> narrow{};
    std::array<std::array<std::int32_t, kBlockRows>, kWideKeys> wide{};
    std::array<SeriesColumn, kSeriesKeyCount> all{};  // of all rows

    std::int64_t nanos(std::size_t row) const;
    std::int32_t At(std::size_t key, std::size_t row) const;
    void Put(std::int64_t nanos, const std::array<std::int32_t, kSeriesKeyCount>& values);
  };

  // Counts what is missing between the samples of one person.
  class LossMeter {
   public:
    /// The share that is lost of the second up to the sample, 0 to 1.
    double Add(std::uint32_t counter, std::int64_t nanos);

   private:
    struct Step {
      std::int64_t nanos;
      std::uint32_t lost;
    };
    std::optional<std::uint32_t> last_;
    // The usual step is the smallest of late: a suit may send every fourth of the frames it counts.
    std::uint32_t smallest_ = 0, smallest_before_ = 0, seen_ = 0;  // 0: none
    std::deque<Step> steps_;
    std::uint64_t lost_ = 0;  // sum of steps_
  };

  struct Track {
    std::deque<std::shared_ptr<Block>> blocks;  // all but the last one are full and constant
    LossMeter loss;
    std::uint32_t counter = 0;
    std::int64_t stamp_nanos = 0;
    Liveness liveness = Liveness::kNoData;
  };

  bool Has(int character) const;
  /// Blocks with samples of the time of `question`; the last one may be a copy. So a reader holds
  /// the lock for microseconds, and never delays the stream. Empty for an unknown person.
  std::vector<std::shared_ptr<const Block>> BlocksOf(const SeriesQuestion& question) const;
  void AddPerson(const SceneState& state, const PersonState& person);
  void Forget(std::int64_t now_nanos);

  const SeriesLimits limits_;
  mutable std::mutex mutex_;
  std::map<int, Track> tracks_;  // by character; guarded by mutex_
  std::size_t blocks_ = 0;       // of all tracks; guarded by mutex_
};

}  // namespace kinescope::history
