#include "server/app/serve/surroundings_loop.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "render/surroundings.h"

namespace kinescope::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPeriod(100), kPeriodWithoutViewers(1000);
constexpr int kIdleShare = 10;  // of its time at most one part is spent on making

}  // namespace

SurroundingsLoop::SurroundingsLoop(std::function<bool()> has_viewers,
                                   Latest<http::Surroundings>& made)
    : has_viewers_(std::move(has_viewers)), made_(made), thread_([this] { Run(); }) {}

SurroundingsLoop::~SurroundingsLoop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_all();
  thread_.join();
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

void SurroundingsLoop::Run() {
  std::unique_ptr<render::SurroundingsWriter> writer;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!is_ending_) {
    if (wanted_ == nullptr) {
      wake_.wait(lock);
      continue;
    }
    const std::shared_ptr<const SceneState> state = std::exchange(wanted_, nullptr);
    lock.unlock();
    const Clock::time_point begin = Clock::now();
    try {
      if (writer == nullptr) writer = render::MakeSurroundingsWriter();
      made_.Publish(std::make_shared<const http::Surroundings>(
          http::Surroundings{state->surroundings, writer->Write(state->markers, state->robots)}));
    } catch (const std::exception& error) {
      spdlog::error("the page does not show markers and robots: {}", error.what());
    }
    const Clock::time_point next =
        begin + std::max<Clock::duration>(has_viewers_() ? kPeriod : kPeriodWithoutViewers,
                                          kIdleShare * (Clock::now() - begin));
    lock.lock();
    wake_.wait_until(lock, next, [this] { return is_ending_; });
  }
}

}  // namespace kinescope::app
