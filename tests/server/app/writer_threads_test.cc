#include "server/app/writer_threads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>

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

TEST(WriterThreads, SeveralShareTheWork) {
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

TEST(WriterThreads, TellWhatFailedAndLetGoOfTheRest) {
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

TEST(WriterThreads, WhatNobodyFinishedIsNotWaitedFor) {
  std::promise<void> started, go_on;
  std::future<void> is_started = started.get_future(), may_go_on = go_on.get_future();
  std::atomic<int> written{0};
  {
    WriterThreads<int> threads(1, [&](int&) {
      if (written++ == 0) {
        started.set_value();
        may_go_on.wait();
      }
    });
    for (int i = 0; i < 100; ++i) threads.Put(i);
    is_started.wait();
    go_on.set_value();
  }
  EXPECT_LE(written, 100);
}

}  // namespace
}  // namespace kinescope::app
