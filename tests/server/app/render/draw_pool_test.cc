#include "server/app/render/draw_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "server/picture/cores.h"
#include "tests/deadline.h"
#include "tests/server/picture/fake_renderer.h"

namespace kinescope::app {
namespace {

using kinescope::testing::FakeRenderer;
using kinescope::testing::WithDeadline;
using render::RenderError;

DrawPool::MakeRenderer FakeRenderers(FakeRenderer::OnDraw on_draw = nullptr) {
  return [on_draw = std::move(on_draw)] { return std::make_unique<FakeRenderer>(on_draw); };
}

RenderRequest CountedRequest(std::uint32_t counter) {
  RenderRequest request;
  request.state.counter = counter;
  request.spec.width = request.spec.height = 16;
  return request;
}

int FirstLevel(const FuturePicture& picture) { return picture.get()->rgba.front(); }

TEST(DrawPool, RendersInOrderWithOneThread) {
  DrawPool pool(1, 5, FakeRenderers());
  EXPECT_EQ(pool.info().renderer, "a fake");
  std::vector<FuturePicture> pictures;
  for (std::uint32_t i = 0; i < 5; ++i) pictures.push_back(pool.Draw(CountedRequest(i)));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(FirstLevel(pictures[static_cast<std::size_t>(i)]), i + 1);
}

TEST(DrawPool, ReturnsThePictureOfEachShotFromAnyThread) {
  DrawPool pool(3, 4,
                FakeRenderers([](render::Image& image, const SceneState& state, const auto&...) {
                  image.rgba.front() = static_cast<std::uint8_t>(state.counter);
                }));
  std::deque<std::pair<int, FuturePicture>> held;
  for (int i = 0; i < 200; ++i) {
    if (held.size() == 4) held.pop_front();
    held.emplace_back(i, pool.Draw(CountedRequest(static_cast<std::uint32_t>(i))));
    EXPECT_EQ(FirstLevel(held.front().second), held.front().first);
  }
}

TEST(DrawPool, WaitsForFreeMemoryAndReusesIt) {
  WithDeadline([] {
    DrawPool pool(1, 2, FakeRenderers());
    FuturePicture first = pool.Draw(CountedRequest(1));
    const FuturePicture second = pool.Draw(CountedRequest(2));
    second.wait();
    const std::uint8_t* const memory = first.get()->rgba.data();
    auto third = std::async(std::launch::async, [&] { return pool.Draw(CountedRequest(3)); });
    // Not a wait for something to come: it must not.
    EXPECT_EQ(third.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout)
        << "two pictures are held, and there is room for two";
    first = {};
    EXPECT_EQ(third.get().get()->rgba.data(), memory);
    EXPECT_EQ(FirstLevel(second), 2) << "it is still held";
  });
}

TEST(DrawPool, ReportsAnErrorForItsPictureOnlyAndFreesItsMemory) {
  WithDeadline([] {
    DrawPool pool(1, 2, FakeRenderers([](const auto&, const SceneState& state, const auto&...) {
                    if (state.counter == 0) throw RenderError("the driver fails");
                  }));
    for (int i = 0; i < 5; ++i) {
      const FuturePicture bad = pool.Draw(CountedRequest(0)), good = pool.Draw(CountedRequest(1));
      EXPECT_THROW(bad.get(), RenderError);
      EXPECT_NO_THROW(good.get());
    }
  });
}

TEST(DrawPool, ThrowsTheErrorOfTheFirstRenderer) {
  const auto make = []() -> std::unique_ptr<render::Renderer> { throw RenderError("no context"); };
  EXPECT_THROW(DrawPool(3, 4, make), RenderError);
}

TEST(DrawPool, ReportsTheStartErrorOfALaterRendererForItsPicture) {
  WithDeadline([] {
    std::promise<void> failed;
    std::shared_future<void> has_failed = failed.get_future().share();
    std::atomic<int> made{0};
    DrawPool pool(2, 2, [&]() -> std::unique_ptr<render::Renderer> {
      const int before = made++;
      if (before == 1) failed.set_value();
      if (before > 0) throw RenderError("no second context");
      return std::make_unique<FakeRenderer>([&](const auto&...) { has_failed.wait(); });
    });
    const FuturePicture pictures[] = {pool.Draw(CountedRequest(1)), pool.Draw(CountedRequest(2))};
    int errors = 0;
    for (const FuturePicture& picture : pictures) {
      try {
        picture.get();
      } catch (const RenderError& error) {
        EXPECT_STREQ(error.what(), "no second context");
        ++errors;
      }
    }
    EXPECT_GE(errors, 1) << "the first renderer waits until the second has failed";
  });
}

TEST(DrawPool, WaitsAtItsEndOnlyForThePictureInProgress) {
  WithDeadline([] {
    std::promise<void> started, go_on;
    std::shared_future<void> may_go_on = go_on.get_future().share();
    std::optional<DrawPool> pool;
    pool.emplace(1, 3, FakeRenderers([&](const auto&...) {
                   started.set_value();
                   may_go_on.wait();
                 }));
    const FuturePicture drawn = pool->Draw(CountedRequest(1)), left = pool->Draw(CountedRequest(2)),
                        last = pool->Draw(CountedRequest(3));
    started.get_future().wait();
    auto end = std::async(std::launch::async, [&] { pool.reset(); });
    EXPECT_THROW(left.get(), std::future_error);
    EXPECT_THROW(last.get(), std::future_error);
    EXPECT_EQ(drawn.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
    go_on.set_value();
    end.get();
    EXPECT_EQ(FirstLevel(drawn), 1) << "a picture outlives its pool";
  });
}

TEST(DrawPool, HasAPictureLimitFromThreadsAndMemory) {
  EXPECT_EQ(MostPictures(1, 160, 90), 3u);
  EXPECT_EQ(MostPictures(1, 3840, 2160), 2u);
  EXPECT_EQ(MostPictures(1, 8192, 4096), 2u) << "128 MiB each";
  EXPECT_EQ(MostPictures(8, 8192, 8192), 9u);
}

TEST(DrawPool, HasAsManyThreadsAsCoresAndTexturesAllow) {
  const auto jobs = [](int cores, int width, int height, int supersample) {
    render::PictureSpec spec;
    spec.width = width;
    spec.height = height;
    spec.supersample = supersample;
    return DefaultJobs(cores, spec);
  };
  EXPECT_EQ(jobs(1, 1280, 720, 2), 1);
  EXPECT_EQ(jobs(2, 1280, 720, 2), 1);
  EXPECT_EQ(jobs(8, 1280, 720, 2), 4);
  EXPECT_EQ(jobs(64, 1280, 720, 2), 8);
  EXPECT_EQ(jobs(64, 1920, 1080, 2), 3);
  EXPECT_EQ(jobs(64, 3840, 2160, 2), 1) << "of 4096 x 4096 px at once";
  EXPECT_EQ(jobs(64, 8192, 8192, 4), 1);
  EXPECT_GE(CoresHere(), 1);

  EXPECT_EQ(FillingThreads(1, 1), 1);
  EXPECT_EQ(FillingThreads(2, 1), 2);
  EXPECT_EQ(FillingThreads(8, 4), 2);
  EXPECT_EQ(FillingThreads(8, 16), 1);
  EXPECT_EQ(FillingThreads(64, 1), 8);
}

}  // namespace
}  // namespace kinescope::app
