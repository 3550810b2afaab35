#include "server/app/serve/surroundings_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <string>
#include <thread>

#include "tests/patience.h"

namespace kinescope::app {
namespace {

using kinescope::testing::kPatience;
using std::chrono::seconds;

std::shared_ptr<const SceneState> With(std::uint64_t revision, const std::string& text) {
  auto marker = std::make_shared<SceneMarker>();
  marker->type = MarkerType::kText;
  marker->text = text;
  auto state = std::make_shared<SceneState>();
  state->surroundings = revision;
  state->markers = {std::move(marker)};
  return state;
}

TEST(SurroundingsLoop, MakesTheNewestOnceAfterEachChange) {
  Latest<http::Surroundings> made;
  std::promise<void> all_have_come;
  const std::shared_future<void> it_may_go_on = all_have_come.get_future().share();
  const auto has_viewers = [&] {  // it asks after each that it has made
    it_may_go_on.wait();
    return true;
  };
  SurroundingsLoop loop(has_viewers, made);
  std::uint64_t version = 0;
  loop.OnState(std::make_shared<SceneState>());
  EXPECT_EQ(made.Get(), nullptr) << "there is nothing beside the people";
  loop.OnState(With(1, "first"));
  auto first = made.WaitNewer(version, kPatience);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->revision, 1u);
  EXPECT_NE(first->glb.find("first"), std::string::npos);
  loop.OnState(With(1, "not looked at: the revision is the same"));
  for (int i = 2; i <= 9; ++i) loop.OnState(With(static_cast<std::uint64_t>(i), "later"));
  all_have_come.set_value();
  const auto last = made.WaitNewer(version, kPatience);
  ASSERT_NE(last, nullptr);
  EXPECT_EQ(last->revision, 9u) << "not every one of those that came at once";
}

TEST(SurroundingsLoop, TakesItsTimeWithoutViewers) {
  Latest<http::Surroundings> made;
  SurroundingsLoop loop([] { return false; }, made);
  std::uint64_t version = 0;
  const auto begin = std::chrono::steady_clock::now();
  loop.OnState(With(1, "wall"));
  ASSERT_NE(made.WaitNewer(version, kPatience), nullptr) << "for programs that ask for the file";
  loop.OnState(With(2, "wall"));
  ASSERT_NE(made.WaitNewer(version, kPatience), nullptr);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, seconds(1));
}

std::shared_ptr<const http::Surroundings> Await(SurroundingsLoop& loop,
                                                const std::shared_ptr<const SceneState>& former) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    if (auto made = loop.Of(former)) return made;
    std::this_thread::yield();
  }
  return nullptr;
}

TEST(SurroundingsLoop, MakesThoseOfFormerStatesWhenTheyAreAskedFor) {
  Latest<http::Surroundings> made;
  SurroundingsLoop loop([] { return true; }, made);
  std::uint64_t version = 0;
  loop.OnState(With(9, "now"));
  ASSERT_NE(made.WaitNewer(version, kPatience), nullptr);
  EXPECT_EQ(loop.Of(With(3, "then")), nullptr) << "it is not waited for";
  const auto former = Await(loop, With(3, "then"));
  ASSERT_NE(former, nullptr);
  EXPECT_EQ(former->revision, 3u);
  EXPECT_NE(former->glb.find("then"), std::string::npos);
  EXPECT_EQ(made.Get()->revision, 9u) << "those of now are the same";
  EXPECT_EQ(loop.Of(With(9, "")), made.Get()) << "what was made is not made again";
  EXPECT_EQ(loop.Of(With(3, "")), former);
}

TEST(SurroundingsLoop, ForgetsTheFormerOnesThatWereMadeFirst) {
  Latest<http::Surroundings> made;
  SurroundingsLoop loop([] { return true; }, made);
  for (std::uint64_t revision = 1; revision <= 40; ++revision) {
    ASSERT_NE(Await(loop, With(revision, "then")), nullptr);
  }
  EXPECT_EQ(loop.Of(With(1, "again")), nullptr);
  EXPECT_NE(loop.Of(With(40, "")), nullptr);
  loop.End();
  EXPECT_EQ(loop.Of(With(2, "again")), nullptr);
}

}  // namespace
}  // namespace kinescope::app
