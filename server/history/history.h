/// The last minutes of all states, so that each viewer can look back while the stream goes on.
/// States are compressed on a thread of its own; adding one costs a pointer. Any thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "server/history/chunk.h"
#include "server/history/marker_log.h"
#include "server/history/series.h"

namespace kinescope::history {

struct HistoryLimits {
  std::int64_t nanos = 600'000'000'000;             // older states are forgotten
  std::size_t bytes = std::size_t{500} << 20;       // and the oldest of more than that
  std::size_t series_bytes = SeriesLimits().bytes;  // of the series, beside the states
  // Of external markers, beside the states: older states than these bytes reach have none.
  std::size_t marker_bytes = std::size_t{256} << 20;
};

/// States that are wanted: the newest one at `from_nanos`, as History::At(), and those after it up
/// to `until_nanos`, each made at least `every_nanos` after the one before.
struct Span {
  std::int64_t from_nanos = 0, until_nanos = 0, every_nanos = 0;
};

/// The states that are kept: a first and a last one, by SceneState::made_nanos and number.
struct Extent {
  std::int64_t first_nanos = 0, last_nanos = 0;
  std::uint64_t first_number = 0, last_number = 0;
};

class History {
 public:
  /// Adds to a state what is not kept and follows from the rest.
  using Complete = std::function<void(SceneState& state)>;

  /// `complete` may be null. Threads that look back call it.
  explicit History(HistoryLimits limits = {}, Complete complete = nullptr);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// If more states wait for compression than should, this one is left out and counted.
  /// @pre number and made_nanos are not below those of the state before.
  void Add(std::shared_ptr<const SceneState> state);

  /// nullopt before the first state.
  std::optional<Extent> extent() const;
  std::size_t bytes() const;         // of the compressed states
  std::size_t marker_bytes() const;  // of the markers of all states
  std::uint64_t left_out() const;    // states that were not kept

  /// The newest state that was made at or before `nanos`; the oldest kept one if all are newer.
  /// Null before the first state.
  std::shared_ptr<const SceneState> At(std::int64_t nanos) const;
  /// The state of this number; the nearest kept one if it is gone, or not there yet.
  std::shared_ptr<const SceneState> Numbered(std::uint64_t number) const;

  /// False: no more states are wanted.
  using Visitor = std::function<bool(const SceneState& state)>;
  /// Calls `visit` for the states of `span`, in order. Returns the moment up to which there are no
  /// others in it: the end of the span, the newest kept state, or the last visited one if `visit`
  /// has returned false. nullopt, and no call, before the first state.
  std::optional<std::int64_t> Visit(const Span& span, const Visitor& visit) const;

  /// Of all states that were added, also of those that were left out.
  const Series& series() const { return series_; }

  /// Waits until no more states can be compressed. For tests and figures.
  void Settle() const;

 private:
  using States = std::vector<std::shared_ptr<const SceneState>>;
  using Chunks = std::deque<std::shared_ptr<const Chunk>>;

  // What is kept of some time, oldest first.
  struct Part {
    std::vector<std::shared_ptr<const Chunk>> chunks;
    States open;
    std::int64_t newest_nanos = 0;  // of all states
  };

  void Work();
  void CountRun();
  bool IsRunComplete() const;
  void Forget();
  template <class Key>
  std::shared_ptr<const SceneState> Find(typename Key::Value wanted) const;
  Part PartBetween(std::int64_t after_nanos, std::int64_t until_nanos) const;
  std::shared_ptr<const Chunk::Rows> Unpacked(const std::shared_ptr<const Chunk>& chunk) const;
  std::shared_ptr<const SceneState> Made(const Chunk& chunk, const Chunk::Rows& rows,
                                         std::size_t row) const;

  const HistoryLimits limits_;
  const Complete complete_;
  Series series_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  // Guarded by mutex_:
  Chunks chunks_;
  std::deque<std::shared_ptr<const SceneState>> open_;  // newer than all chunks
  std::size_t run_ = 0;  // states at the front of `open_` that are of one form
  MarkerLog markers_;
  std::size_t bytes_ = 0;
  std::uint64_t left_out_ = 0;
  bool is_working_ = false, is_ending_ = false;
  // Of those looked at of late, the newest first.
  mutable std::list<std::pair<std::shared_ptr<const Chunk>, std::shared_ptr<const Chunk::Rows>>>
      unpacked_;
  std::thread worker_;
};

}  // namespace kinescope::history
