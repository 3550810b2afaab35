/// Makes the models of people on a thread of its own. A stream may change colours and segment
/// lengths with every datagram; a model takes about 10 ms, so the thread that reads the stream must
/// not make it. It is bounded by a pause for each person and by a share of one core for all of
/// them. All public functions: one thread.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "server/scene/model_factory.h"

namespace kinescope::app {

class ModelMaker {
 public:
  /// Least time between two models of one person.
  static constexpr std::chrono::milliseconds kPause{300};

  /// `models` is borrowed.
  explicit ModelMaker(const ModelFactory& models);
  ~ModelMaker();  // waits for the model that is being made
  ModelMaker(const ModelMaker&) = delete;
  ModelMaker& operator=(const ModelMaker&) = delete;

  /// Whether Ask() may be called for this person now: the model before was taken, and is old
  /// enough. People are counted as in PersonDescription::index.
  bool IsFree(std::size_t index) const;
  /// @pre IsFree(person.index)
  void Ask(const PersonDescription& person, std::uint64_t revision);
  /// The model that was asked for; null while it is not ready.
  std::shared_ptr<const PersonModel> Take(std::size_t index);
  /// Drops what was asked for this person, who has left.
  void Forget(std::size_t index);

 private:
  using Clock = std::chrono::steady_clock;
  struct Order {
    PersonDescription person;
    std::uint64_t revision = 0;
    std::uint64_t number = 0;                  // in the order of asking
    bool is_new = false;                       // still to be made
    std::shared_ptr<const PersonModel> model;  // made, to be taken
  };
  struct Customer {
    bool waits = false;  // for the model that it asked for
    Clock::time_point free_from{};
  };

  void Run();

  const ModelFactory& models_;
  std::map<std::size_t, Customer> customers_;  // asking thread only
  std::atomic<int> ready_{0};                  // models to be taken
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, Order> orders_;  // guarded by mutex_
  std::uint64_t asked_ = 0;              // guarded by mutex_
  bool stopping_ = false;                // guarded by mutex_
  std::thread thread_;                   // last: starts when all other members exist
};

}  // namespace kinescope::app
