#include "server/history/history.h"

#include <algorithm>
#include <utility>

namespace kinescope::history {
namespace {

constexpr std::size_t kStatesPerChunk = 120;  // half a second of a fast stream
// On a machine that is too busy to compress them: 10 KB for each person and state.
constexpr std::size_t kMostOpen = 5 * kStatesPerChunk;
constexpr std::size_t kUnpackedChunks = 8;  // viewers at other moments unpack theirs again

struct ByTime {
  using Value = std::int64_t;
  static Value Of(const SceneState& state) { return state.made_nanos; }
  static Value Of(const Chunk::Rows& rows, std::size_t row) { return rows.made_nanos(row); }
  static Value First(const Chunk& chunk) { return chunk.first_nanos(); }
};

struct ByNumber {
  using Value = std::uint64_t;
  static Value Of(const SceneState& state) { return state.number; }
  static Value Of(const Chunk::Rows& rows, std::size_t row) { return rows.number(row); }
  static Value First(const Chunk& chunk) { return chunk.first_number(); }
};

// They are large, and former states have none.
std::shared_ptr<const SceneState> WithoutImages(std::shared_ptr<const SceneState> state) {
  if (state->images.empty()) return state;
  auto without = std::make_shared<SceneState>(*state);
  without->images.clear();
  return without;
}

}  // namespace

History::History(HistoryLimits limits, Complete complete)
    : limits_(limits),
      complete_(std::move(complete)),
      series_({limits.nanos, limits.series_bytes}),
      markers_(limits.marker_bytes),
      worker_([this] { Work(); }) {}

History::~History() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

void History::Add(std::shared_ptr<const SceneState> state) {
  series_.Add(*state);
  state = WithoutImages(std::move(state));
  bool is_complete = false;
  {
    const std::lock_guard lock(mutex_);
    if (open_.size() >= kMostOpen) {
      ++left_out_;
      return;
    }
    markers_.Add(*state);
    open_.push_back(std::move(state));
    Forget();
    CountRun();
    is_complete = IsRunComplete();
  }
  if (is_complete) changed_.notify_all();
}

// Looks at each state once, not at all that wait for each new one.
void History::CountRun() {
  while (run_ < open_.size() && run_ < kStatesPerChunk && SameForm(*open_.front(), *open_[run_])) {
    ++run_;
  }
}

bool History::IsRunComplete() const { return run_ == kStatesPerChunk || run_ < open_.size(); }

void History::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || IsRunComplete(); });
    if (is_ending_) return;
    const auto end = open_.begin() + static_cast<std::ptrdiff_t>(run_);
    const States states(open_.begin(), end);
    const auto before = chunks_.empty() ? nullptr : chunks_.back();
    is_working_ = true;
    lock.unlock();
    auto chunk = std::make_shared<const Chunk>(states, before.get());
    lock.lock();
    is_working_ = false;
    open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(states.size()));
    run_ = 0;
    CountRun();
    bytes_ += chunk->bytes();
    chunks_.push_back(std::move(chunk));
    Forget();
    changed_.notify_all();
  }
}

void History::Forget() {
  const std::int64_t oldest = open_.empty() ? chunks_.back()->last_nanos() - limits_.nanos
                                            : open_.back()->made_nanos - limits_.nanos;
  while (!chunks_.empty() && (chunks_.front()->last_nanos() < oldest || bytes_ > limits_.bytes)) {
    bytes_ -= chunks_.front()->bytes();
    chunks_.pop_front();
  }
  if (chunks_.empty() && open_.empty()) return;
  markers_.ForgetBefore(chunks_.empty() ? open_.front()->number : chunks_.front()->first_number());
}

std::optional<Extent> History::extent() const {
  const std::lock_guard lock(mutex_);
  if (chunks_.empty() && open_.empty()) return std::nullopt;
  Extent extent;
  if (!open_.empty()) {
    extent = {open_.front()->made_nanos, open_.back()->made_nanos, open_.front()->number,
              open_.back()->number};
  } else {
    extent.last_nanos = chunks_.back()->last_nanos();
    extent.last_number = chunks_.back()->last_number();
  }
  if (!chunks_.empty()) {
    extent.first_nanos = chunks_.front()->first_nanos();
    extent.first_number = chunks_.front()->first_number();
  }
  return extent;
}

std::uint64_t History::left_out() const {
  const std::lock_guard lock(mutex_);
  return left_out_;
}

std::size_t History::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t History::marker_bytes() const {
  const std::lock_guard lock(mutex_);
  return markers_.bytes();
}

// The newest state whose key is at most `wanted`, else the oldest one.
template <class Key>
std::shared_ptr<const SceneState> History::Find(typename Key::Value wanted) const {
  std::shared_ptr<const Chunk> chunk;
  {
    const std::lock_guard lock(mutex_);
    if (!open_.empty() && (chunks_.empty() || Key::Of(*open_.front()) <= wanted)) {
      const auto after =
          std::upper_bound(open_.begin(), open_.end(), wanted,
                           [](auto value, const auto& each) { return value < Key::Of(*each); });
      return after == open_.begin() ? *after : *std::prev(after);
    }
    if (chunks_.empty()) return nullptr;
    const auto after =
        std::upper_bound(chunks_.begin(), chunks_.end(), wanted,
                         [](auto value, const auto& each) { return value < Key::First(*each); });
    chunk = after == chunks_.begin() ? *after : *std::prev(after);
  }
  const auto rows = Unpacked(chunk);
  std::size_t row = 0;
  while (row + 1 < rows->count() && Key::Of(*rows, row + 1) <= wanted) ++row;
  return Made(*chunk, *rows, row);
}

std::shared_ptr<const SceneState> History::Made(const Chunk& chunk, const Chunk::Rows& rows,
                                                std::size_t row) const {
  std::shared_ptr<SceneState> state = chunk.At(rows, row);
  {
    const std::lock_guard lock(mutex_);
    state->markers = markers_.Of(state->number);
  }
  if (complete_) complete_(*state);
  return state;
}

std::shared_ptr<const Chunk::Rows> History::Unpacked(
    const std::shared_ptr<const Chunk>& chunk) const {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(unpacked_.begin(), unpacked_.end(),
                                    [&](const auto& each) { return each.first == chunk; });
    if (found != unpacked_.end()) {
      unpacked_.splice(unpacked_.begin(), unpacked_, found);
      return found->second;
    }
  }
  auto rows = std::make_shared<const Chunk::Rows>(chunk->Unpack());
  const std::lock_guard lock(mutex_);
  unpacked_.emplace_front(chunk, rows);
  if (unpacked_.size() > kUnpackedChunks) unpacked_.pop_back();
  return rows;
}

std::shared_ptr<const SceneState> History::At(std::int64_t nanos) const {
  return Find<ByTime>(nanos);
}

std::shared_ptr<const SceneState> History::Numbered(std::uint64_t number) const {
  return Find<ByNumber>(number);
}

// The states made after `after_nanos`, up to `until_nanos`; chunks may have others, too.
History::Part History::PartBetween(std::int64_t after_nanos, std::int64_t until_nanos) const {
  Part part;
  const std::lock_guard lock(mutex_);
  auto chunk = std::lower_bound(
      chunks_.begin(), chunks_.end(), after_nanos,
      [](const auto& each, std::int64_t nanos) { return each->last_nanos() <= nanos; });
  for (; chunk != chunks_.end() && (*chunk)->first_nanos() <= until_nanos; ++chunk) {
    part.chunks.push_back(*chunk);
  }
  for (const auto& state : open_) {
    if (state->made_nanos > until_nanos) break;
    if (state->made_nanos > after_nanos) part.open.push_back(state);
  }
  part.newest_nanos = open_.empty() ? chunks_.back()->last_nanos() : open_.back()->made_nanos;
  return part;
}

std::optional<std::int64_t> History::Visit(const Span& span, const Visitor& visit) const {
  const auto first = At(span.from_nanos);
  if (first == nullptr) return std::nullopt;
  std::int64_t last = first->made_nanos;
  if (!visit(*first)) return last;
  const auto is_next = [&](std::int64_t nanos) {
    return nanos > last && nanos - last >= span.every_nanos && nanos <= span.until_nanos;
  };
  const Part part = PartBetween(last, span.until_nanos);
  for (const auto& chunk : part.chunks) {
    const auto rows = Unpacked(chunk);
    for (std::size_t row = 0; row < rows->count(); ++row) {
      if (!is_next(rows->made_nanos(row))) continue;
      last = rows->made_nanos(row);
      if (!visit(*Made(*chunk, *rows, row))) return last;
    }
  }
  for (const auto& state : part.open) {
    if (!is_next(state->made_nanos)) continue;
    last = state->made_nanos;
    if (!visit(*state)) return last;
  }
  return std::max(last, std::min(span.until_nanos, part.newest_nanos));
}

void History::Settle() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !is_working_ && !IsRunComplete(); });
}

}  // namespace kinescope::history
