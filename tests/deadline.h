/// Runs code that may hang, so that its test ends all the same.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>
#include <thread>
#include <utility>

namespace kinescope::testing {

/// Runs `work` on another thread and waits for it; its exceptions are thrown here. A thread that
/// hangs cannot be ended alone, so the program ends as failed when `limit` is exceeded.
inline void WithDeadline(std::function<void()> work,
                         std::chrono::seconds limit = std::chrono::seconds(30)) {
  std::packaged_task<void()> task(std::move(work));
  std::future<void> done = task.get_future();
  std::thread thread(std::move(task));
  if (done.wait_for(limit) != std::future_status::ready) {
    const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::fprintf(stderr, "[  FAILED  ] %s.%s hangs: not done after %lld s\n",
                 test->test_suite_name(), test->name(), static_cast<long long>(limit.count()));
    std::_Exit(EXIT_FAILURE);
  }
  thread.join();
  done.get();
}

}  // namespace kinescope::testing
