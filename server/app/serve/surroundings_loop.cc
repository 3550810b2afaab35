#include "server/app/serve/surroundings_loop.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "render/surroundings.h"

namespace kinescope::app {
namespace {

constexpr std::chrono::milliseconds kPeriod(100), kPeriodWithoutViewers(1000);
constexpr int kIdleShare = 10;         // of its time at most one part is spent on making the newest
constexpr std::size_t kMostAsked = 8;  // of more, the ones that were asked for first are left out
constexpr std::size_t kMostKept = 16, kMostKeptBytes = std::size_t{32} << 20;

}  // namespace

SurroundingsLoop::SurroundingsLoop(std::function<bool()> has_viewers,
                                   Latest<http::Surroundings>& made)
    : has_viewers_(std::move(has_viewers)), made_(made), thread_([this] { Run(); }) {}

void SurroundingsLoop::End() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SurroundingsLoop::OnState(const std::shared_ptr<const SceneState>& state) {
  if (state->surroundings == seen_) return;
  seen_ = state->surroundings;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wanted_ = state;
  }
  wake_.notify_one();
}

std::shared_ptr<const http::Surroundings> SurroundingsLoop::Of(
    const std::shared_ptr<const SceneState>& former) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto is_it = [&](const auto& each) { return each->surroundings == former->surroundings; };
    if (auto kept = Kept(former->surroundings)) return kept;
    if (std::any_of(asked_.begin(), asked_.end(), is_it)) return nullptr;
    asked_.push_back(former);
    if (asked_.size() > kMostAsked) asked_.pop_front();
  }
  wake_.notify_one();
  return nullptr;
}

std::shared_ptr<const http::Surroundings> SurroundingsLoop::Kept(std::uint64_t revision) const {
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const auto& each) { return each->revision == revision; });
  return found == kept_.end() ? nullptr : *found;
}

void SurroundingsLoop::Keep(std::shared_ptr<const http::Surroundings> surroundings) {
  kept_.push_back(std::move(surroundings));
  std::size_t bytes = 0;
  for (const auto& each : kept_) bytes += each->glb.size();
  while (kept_.size() > 1 && (kept_.size() > kMostKept || bytes > kMostKeptBytes)) {
    bytes -= kept_.front()->glb.size();
    kept_.pop_front();
  }
}

// Waits for what is to be made next: a former state, or the newest one when it is due. Null: the
// loop ends.
std::shared_ptr<const SceneState> SurroundingsLoop::Next(std::unique_lock<std::mutex>& lock) {
  while (!is_ending_) {
    if (wanted_ != nullptr && Clock::now() >= newest_due_) return std::exchange(wanted_, nullptr);
    if (!asked_.empty()) {
      auto state = std::move(asked_.front());
      asked_.pop_front();
      return state;
    }
    if (wanted_ == nullptr) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, newest_due_);
    }
  }
  return nullptr;
}

void SurroundingsLoop::Run() {
  std::unique_ptr<render::SurroundingsWriter> writer;
  std::uint64_t newest = 0;  // that is made
  std::unique_lock<std::mutex> lock(mutex_);
  while (const auto state = Next(lock)) {
    lock.unlock();
    const Clock::time_point begin = Clock::now();
    std::shared_ptr<const http::Surroundings> made;
    try {
      if (writer == nullptr) writer = render::MakeSurroundingsWriter();
      made = std::make_shared<const http::Surroundings>(
          http::Surroundings{state->surroundings, writer->Write(state->markers, state->robots)});
    } catch (const std::exception& error) {
      spdlog::error("the page does not show markers and robots: {}", error.what());
      made =
          std::make_shared<const http::Surroundings>(http::Surroundings{state->surroundings, {}});
    }
    const bool is_newest = state->surroundings > newest;
    if (is_newest && !made->glb.empty()) {
      newest = made->revision;
      made_.Publish(made);
    }
    const Clock::duration spent = Clock::now() - begin;
    const Clock::duration period = has_viewers_() ? kPeriod : kPeriodWithoutViewers;
    lock.lock();
    Keep(std::move(made));
    if (is_newest) newest_due_ = begin + std::max(period, kIdleShare * spent);
  }
}

}  // namespace kinescope::app
