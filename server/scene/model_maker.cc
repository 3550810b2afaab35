#include "server/scene/model_maker.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/system/check.h"

namespace kinescope::app {

ModelMaker::ModelMaker(const ModelFactory& models) : models_(models), thread_([this] { Run(); }) {}

ModelMaker::~ModelMaker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool ModelMaker::IsFree(std::size_t index) const {
  const auto customer = customers_.find(index);
  if (customer == customers_.end()) return true;
  return !customer->second.waits && Clock::now() >= customer->second.free_from;
}

void ModelMaker::Ask(const PersonDescription& person, std::uint64_t revision) {
  KINESCOPE_CHECK(IsFree(person.index));
  customers_[person.index] = {true, Clock::now() + kPause};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    orders_[person.index] = {person, revision, ++asked_, true, nullptr};
  }
  changed_.notify_one();
}

std::shared_ptr<const PersonModel> ModelMaker::Take(std::size_t index) {
  if (ready_ == 0) return nullptr;  // for every sample: without a lock
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto order = orders_.find(index);
  if (order == orders_.end() || order->second.model == nullptr) return nullptr;
  auto model = std::move(order->second.model);
  orders_.erase(order);
  --ready_;
  customers_[index].waits = false;
  return model;
}

void ModelMaker::Forget(std::size_t index) {
  customers_.erase(index);
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto order = orders_.find(index);
  if (order == orders_.end()) return;
  if (order->second.model != nullptr) --ready_;
  orders_.erase(order);  // a model that is being made is dropped when it is ready
}

void ModelMaker::Run() {
  constexpr int kRest = 3;  // times as long as it worked: a quarter of one core at most
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    const auto is_new = [](const auto& order) { return order.second.is_new; };
    changed_.wait(lock,
                  [&] { return stopping_ || std::any_of(orders_.begin(), orders_.end(), is_new); });
    if (stopping_) return;
    const auto next =
        std::min_element(orders_.begin(), orders_.end(), [](const auto& a, const auto& b) {
          return std::make_tuple(!a.second.is_new, a.second.number) <
                 std::make_tuple(!b.second.is_new, b.second.number);
        });
    next->second.is_new = false;
    const std::size_t index = next->first;
    const PersonDescription person = std::move(next->second.person);
    const std::uint64_t revision = next->second.revision;
    const std::uint64_t number = next->second.number;
    lock.unlock();
    const auto began = Clock::now();
    auto model = models_.Make(person, revision);
    const auto ended = Clock::now();
    lock.lock();
    const auto order = orders_.find(index);
    if (order != orders_.end() && order->second.number == number) {
      order->second.model = std::move(model);
      ++ready_;
    }
    changed_.wait_until(lock, ended + kRest * (ended - began), [this] { return stopping_; });
  }
}

}  // namespace kinescope::app
