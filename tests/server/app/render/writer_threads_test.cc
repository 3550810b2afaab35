#include "server/app/render/writer_threads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

#include "tests/patience.h"

namespace kinescope::app {
namespace {

TEST(WriterThreads, WriteEverythingOnceAndInOrder) {
  std::vector<int> written;
  WriterThreads<int> threads(1, [&](int& item) { written.push_back(item); });
  std::vector<int> given;
  for (int i = 0; i < 1000; ++i) {
    given.push_back(i);
    threads.Put(i);
  }
  threads.Finish();
  EXPECT_EQ(written, given);
}

TEST(WriterThreads, WorkInParallel) {
  // Each item waits for the other, so one thread alone would never end.
  std::promise<void> first, second;
  std::future<void> first_is_here = first.get_future(), second_is_here = second.get_future();
  WriterThreads<int> threads(2, [&](int& item) {
    (item == 0 ? first : second).set_value();
    (item == 0 ? second_is_here : first_is_here).wait();
  });
  threads.Put(0);
  threads.Put(1);
  threads.Finish();
}

TEST(WriterThreads, ReportAFailureAndDiscardTheRest) {
  const auto memory = std::make_shared<int>(7);
  std::atomic<int> written{0};
  WriterThreads<std::shared_ptr<int>> threads(1, [&](std::shared_ptr<int>&) {
    ++written;
    throw std::runtime_error("disk full");
  });
  // Put fails at some time after the first item did, as soon as that is known.
  EXPECT_THROW(
      {
        while (true) threads.Put(memory);
      },
      std::runtime_error);
  EXPECT_THROW(threads.Finish(), std::runtime_error);
  EXPECT_EQ(written, 1);
  EXPECT_EQ(memory.use_count(), 1) << "what is not written must give its memory back";
}

// Each item that is written puts the next one, so the queue never ends by itself: only a destructor
// that throws away what is left comes to an end.
TEST(WriterThreads, DiscardUnfinishedWorkAtTheirEnd) {
  const auto deadline = std::chrono::steady_clock::now() + kinescope::testing::kPatience;
  std::atomic<bool> has_waited{false};
  std::promise<void> started;
  {
    WriterThreads<int>* to = nullptr;
    WriterThreads<int> threads(1, [&](int& item) {
      if (item == 1) started.set_value();
      has_waited = std::chrono::steady_clock::now() > deadline;  // which only a failure can reach
      if (!has_waited) to->Put(item + 1);
    });
    to = &threads;
    threads.Put(0);
    started.get_future().wait();
  }
  EXPECT_FALSE(has_waited) << "the destructor waited for as long as there was something to write";
}

}  // namespace
}  // namespace kinescope::app
