#include "server/history/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <thread>

#include "tests/server/http/test_scene.h"

namespace kinescope::history {
namespace {

using http::testing::MakePersonModel;
using http::testing::MakeScene;

constexpr std::int64_t kStep = 1'000'000'000 / 240;  // ns

std::shared_ptr<SceneState> StateAt(std::uint64_t number, int people = 1) {
  static const auto model = MakePersonModel();
  const auto nanos = static_cast<std::int64_t>(number) * kStep;
  auto state = std::make_shared<SceneState>(
      MakeScene(number, static_cast<double>(nanos) * 1e-9, nanos, model, people));
  state->made_nanos = nanos + 1000;
  return state;
}

void Fill(History& history, std::uint64_t first, std::uint64_t last, int people = 1) {
  for (std::uint64_t number = first; number <= last; ++number) {
    history.Add(StateAt(number, people));
  }
  history.Settle();
}

void ExpectSamePose(const urdf::Pose& a, const urdf::Pose& b) {
  EXPECT_LT((a.position - b.position).norm(), 1e-5);
  EXPECT_LT(a.orientation.angularDistance(b.orientation), 1e-4);
}

TEST(History, GivesBackWhatPicturesAndTablesShow) {
  History history;
  Fill(history, 1, 130);
  const auto was = StateAt(57);
  const auto is = history.Numbered(57);
  ASSERT_NE(is, nullptr);
  EXPECT_EQ(is->number, 57u);
  EXPECT_EQ(is->stamp_nanos, was->stamp_nanos);
  EXPECT_EQ(is->arrival_nanos, was->arrival_nanos);
  EXPECT_EQ(is->counter, was->counter);
  EXPECT_EQ(is->liveness, Liveness::kLive);
  EXPECT_EQ(is->source, was->source);
  ASSERT_EQ(is->people.size(), 1u);
  const PersonState &a = was->people[0], &b = is->people[0];
  EXPECT_EQ(b.name, "Demo");
  EXPECT_EQ(b.model, a.model) << "shared, not copied";
  for (std::size_t i = 0; i < a.links.size(); ++i) ExpectSamePose(a.links[i], b.links[i]);
  EXPECT_LT((*a.com - *b.com).norm(), 1e-5);
  EXPECT_LT((*a.cop - *b.cop).norm(), 1e-5);
  ASSERT_EQ(b.loads.size(), a.loads.size());
  for (std::size_t i = 0; i < a.loads.size(); ++i) {
    const JointLoad &x = a.loads[i], &y = b.loads[i];
    EXPECT_EQ(y.joint, x.joint);
    EXPECT_EQ(y.load_class, x.load_class);
    EXPECT_EQ(y.channel, x.channel);
    EXPECT_EQ(y.reason, x.reason);
    EXPECT_EQ(std::isnan(y.shown_ratio), std::isnan(x.shown_ratio));
    EXPECT_NEAR(std::isnan(y.shown_ratio) ? 0 : y.shown_ratio,
                std::isnan(x.shown_ratio) ? 0 : x.shown_ratio, 1e-5);
    EXPECT_LT((y.position - x.position).norm(), 1e-5);
  }
  EXPECT_EQ(b.forces.support.size, 4u);
  EXPECT_NEAR(b.forces.lumbar->compression, 2150, 0.1);
  EXPECT_NEAR(*b.forces.margin_of_stability, 0.083, 1e-5);
  EXPECT_EQ(b.forces.stated_hand_load.mass_kg[urdf::kRight], 5);
  EXPECT_FALSE(b.forces.com_minus_mvn);
}

TEST(History, CompletesWhatItDoesNotKeep) {
  History history({}, [](SceneState& state) { state.ghosts.push_back({state.people.front()}); });
  Fill(history, 1, 130);
  EXPECT_EQ(history.Numbered(57)->ghosts.size(), 1u);
  EXPECT_EQ(history.At(57 * kStep + 1000)->ghosts.size(), 1u);
  history.Visit({56 * kStep, 60 * kStep, 0}, [](const SceneState& state) {
    EXPECT_EQ(state.ghosts.size(), 1u) << state.number;
    return true;
  });
}

// An arm of two links, of which the second one is drawn, and which has lost one link from state 100
// on.
RobotState ArmAt(std::uint64_t number) {
  static const auto model = [] {
    auto made = std::make_shared<urdf::RobotModel>();
    made->links.resize(3);
    made->links[1].visuals.resize(1);
    made->links[2].visuals.resize(1);
    return made;
  }();
  RobotState arm;
  arm.name = "arm";
  arm.model = model;
  arm.moves = true;
  const double turn = 0.01 * static_cast<double>(number);
  arm.world_from_link.assign(
      3, Eigen::Translation3d(1, turn, 0.5) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
  if (number >= 100) arm.world_from_link[2].matrix().topRows<3>().setConstant(std::nan(""));
  return arm;
}

TEST(History, KeepsRobotsWhereTheyWereAndTheMarkersThatWereThere) {
  History history;
  const auto wall = std::make_shared<const SceneMarker>();
  const auto goal = std::make_shared<const SceneMarker>();
  for (std::uint64_t number = 1; number <= 130; ++number) {
    const auto state = StateAt(number);
    state->robots = {ArmAt(number)};
    if (number >= 60) state->camera_base = urdf::Pose{{0.5, 1, 2}, Eigen::Quaterniond(0, 0, 0, 1)};
    if (number < 60) state->extent = {Eigen::Vector3d(-1, 0, 0.5), Eigen::Vector3d(2, 3, 4)};
    state->markers = {wall};
    if (number >= 60) state->markers.push_back(goal);
    state->surroundings = number >= 60 ? 2 : 1;
    history.Add(state);
  }
  history.Settle();
  const auto before = history.Numbered(59), after = history.Numbered(60);
  EXPECT_EQ(before->markers, MarkerList({wall}));
  EXPECT_EQ(before->surroundings, 1u);
  EXPECT_FALSE(before->camera_base);
  EXPECT_TRUE(before->extent.max().isApprox(Eigen::Vector3d(2, 3, 4), 1e-5));
  EXPECT_TRUE(after->extent.isEmpty());
  ExpectSamePose(after->camera_base.value(), {{0.5, 1, 2}, Eigen::Quaterniond(0, 0, 0, 1)});
  EXPECT_EQ(after->markers, MarkerList({wall, goal}));
  EXPECT_EQ(after->surroundings, 2u);
  ASSERT_EQ(after->robots.size(), 1u);
  const RobotState& arm = after->robots[0];
  EXPECT_EQ(arm.model, ArmAt(60).model);
  EXPECT_EQ(arm.name, "arm");
  EXPECT_TRUE(arm.moves);
  EXPECT_TRUE(arm.world_from_link[1].isApprox(ArmAt(60).world_from_link[1], 1e-4));
  EXPECT_TRUE(arm.world_from_link[2].isApprox(ArmAt(60).world_from_link[2], 1e-4));
  EXPECT_TRUE(std::isnan(arm.world_from_link[0].translation().x())) << "not drawn, so not kept";
  const RobotState broken = history.Numbered(110)->robots.at(0);
  EXPECT_TRUE(broken.world_from_link[1].isApprox(ArmAt(110).world_from_link[1], 1e-4));
  EXPECT_TRUE(std::isnan(broken.world_from_link[2].translation().x()));
}

TEST(History, KeepsRobotsThatComeAndGo) {
  History history;
  for (std::uint64_t number = 1; number <= 200; ++number) {
    const auto state = StateAt(number);
    if (number > 50 && number <= 90) state->robots = {ArmAt(number)};
    history.Add(state);
  }
  history.Settle();
  EXPECT_TRUE(history.Numbered(50)->robots.empty());
  EXPECT_EQ(history.Numbered(51)->robots.size(), 1u);
  EXPECT_EQ(history.Numbered(90)->robots.size(), 1u);
  EXPECT_TRUE(history.Numbered(91)->robots.empty());
}

TEST(History, KeepsNoPicturesOfCameras) {
  History history;
  Fill(history, 1, 130);
  const auto state = StateAt(131);
  auto image = std::make_shared<const CameraImage>();
  const std::weak_ptr<const CameraImage> kept = image;
  state->images = {std::move(image)};
  history.Add(state);
  EXPECT_EQ(history.Numbered(131)->number, 131u);
  state->images.clear();
  EXPECT_TRUE(kept.expired()) << "ten minutes of a camera are gigabytes";
}

TEST(History, FindsEveryStateByItsNumberAndByTime) {
  History history;
  EXPECT_EQ(history.At(5), nullptr);
  EXPECT_EQ(history.Numbered(5), nullptr);
  EXPECT_FALSE(history.extent());
  Fill(history, 10, 400);
  for (std::uint64_t number = 10; number <= 400; ++number) {
    const auto nanos = static_cast<std::int64_t>(number) * kStep + 1000;
    ASSERT_EQ(history.Numbered(number)->number, number);
    ASSERT_EQ(history.At(nanos)->number, number);
    ASSERT_EQ(history.At(nanos + kStep - 1)->number, number);
  }
  EXPECT_EQ(history.At(0)->number, 10u) << "the oldest, of a moment that is gone";
  EXPECT_EQ(history.Numbered(3)->number, 10u);
  EXPECT_EQ(history.Numbered(500)->number, 400u) << "the newest, of one that is not there yet";
  const auto extent = history.extent();
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->first_number, 10u);
  EXPECT_EQ(extent->last_number, 400u);
  EXPECT_EQ(extent->last_nanos, 400 * kStep + 1000);
}

std::int64_t MadeNanos(std::uint64_t number) {
  return static_cast<std::int64_t>(number) * kStep + 1000;
}

struct Visited {
  std::vector<std::uint64_t> numbers;
  std::optional<std::int64_t> until;
};

Visited VisitAll(const History& history, const Span& span, std::size_t most = 1000) {
  Visited visited;
  visited.until = history.Visit(span, [&](const SceneState& state) {
    visited.numbers.push_back(state.number);
    return visited.numbers.size() < most;
  });
  return visited;
}

TEST(History, VisitsTheStatesOfASpan) {
  History history;
  EXPECT_FALSE(VisitAll(history, {0, 1'000'000'000, 0}).until);
  Fill(history, 10, 400);  // three chunks, and 31 states that wait
  for (const auto& [first, last] : std::vector<std::pair<std::uint64_t, std::uint64_t>>{
           {100, 300}, {10, 10}, {365, 390}, {380, 400}, {129, 130}}) {
    const Visited all = VisitAll(history, {MadeNanos(first), MadeNanos(last), 0});
    std::vector<std::uint64_t> expected(last - first + 1);
    std::iota(expected.begin(), expected.end(), first);
    EXPECT_EQ(all.numbers, expected);
    EXPECT_EQ(all.until, MadeNanos(last));
  }
  // The state of a moment is the newest at it.
  EXPECT_THAT(VisitAll(history, {MadeNanos(20) + 5, MadeNanos(22) + 5, 0}).numbers,
              ::testing::ElementsAre(20, 21, 22));
  EXPECT_EQ(VisitAll(history, {MadeNanos(20) + 5, MadeNanos(22) + 5, 0}).until, MadeNanos(22) + 5);
}

TEST(History, LeavesOutStatesThatAreTooNearToTheOneBefore) {
  History history;
  Fill(history, 10, 400);
  EXPECT_THAT(VisitAll(history, {MadeNanos(100), MadeNanos(110), 3 * kStep}).numbers,
              ::testing::ElementsAre(100, 103, 106, 109));
  constexpr std::int64_t kHuge = 9'000'000'000'000'000'000;
  EXPECT_THAT(VisitAll(history, {MadeNanos(100), kHuge, kHuge}).numbers,
              ::testing::ElementsAre(100));
}

TEST(History, SaysUpToWhenItHasVisitedASpan) {
  History history;
  Fill(history, 10, 400);
  const Visited newest = VisitAll(history, {MadeNanos(399), MadeNanos(500), 0});
  EXPECT_THAT(newest.numbers, ::testing::ElementsAre(399, 400));
  EXPECT_EQ(newest.until, MadeNanos(400)) << "newer ones are still to come";
  const Visited stopped = VisitAll(history, {MadeNanos(100), MadeNanos(300), 0}, 5);
  EXPECT_EQ(stopped.numbers.size(), 5u);
  EXPECT_EQ(stopped.until, MadeNanos(104));
  const Visited gone = VisitAll(history, {0, 1000, 0});
  EXPECT_THAT(gone.numbers, ::testing::ElementsAre(10)) << "the oldest";
  EXPECT_EQ(gone.until, MadeNanos(10));
  const Visited future = VisitAll(history, {MadeNanos(800), MadeNanos(900), 0});
  EXPECT_THAT(future.numbers, ::testing::ElementsAre(400));
  EXPECT_EQ(future.until, MadeNanos(400));
}

TEST(History, KeepsPeopleWhoComeAndGo) {
  History history;
  Fill(history, 1, 30, 1);
  Fill(history, 31, 50, 3);
  Fill(history, 51, 60, 2);
  Fill(history, 61, 300, 0);
  EXPECT_EQ(history.Numbered(30)->people.size(), 1u);
  EXPECT_EQ(history.Numbered(31)->people.size(), 3u);
  EXPECT_EQ(history.Numbered(50)->people.size(), 3u);
  EXPECT_EQ(history.Numbered(55)->people.size(), 2u);
  EXPECT_EQ(history.Numbered(200)->people.size(), 0u);
}

TEST(History, ForgetsWhatIsTooOldOrTooMuch) {
  HistoryLimits limits;
  limits.nanos = 2'000'000'000;
  History brief(limits);
  Fill(brief, 1, 1200);
  EXPECT_GT(brief.extent()->first_number, 1200u - 480 - 121);
  EXPECT_LE(brief.extent()->first_number, 1200u - 480);
  EXPECT_EQ(brief.Numbered(1)->number, brief.extent()->first_number);

  History whole;
  Fill(whole, 1, 1200);
  limits = HistoryLimits();
  limits.bytes = whole.bytes() / 2;
  History small(limits);
  Fill(small, 1, 1200);
  EXPECT_LE(small.bytes(), limits.bytes);
  EXPECT_GT(small.extent()->first_number, 240u);
  EXPECT_LT(small.extent()->first_number, 961u);
}

TEST(History, TakesLittleRoom) {
  History history;
  Fill(history, 1, 480, 4);
  // Of a smooth motion; tests/bench/README.md has that of a live server.
  EXPECT_LT(history.bytes(), 480 * 4 * sizeof(PersonState) / 20);
}

TEST(History, StaysSmallOnAMachineThatIsTooBusyAndCountsWhatIsMissing) {
  History history;
  const auto state = StateAt(1, 4);
  std::uint64_t added = 0;
  while (history.left_out() == 0 && added < 1'000'000) {  // faster than anything can compress
    history.Add(state);
    ++added;
  }
  EXPECT_GT(history.left_out(), 0u);
  history.Settle();
  history.Add(StateAt(2, 4));
  EXPECT_EQ(history.Numbered(2)->number, 2u) << "it goes on";
}

TEST(History, ServesReadersWhileStatesCome) {
  History history;
  history.Add(StateAt(1));
  std::thread reader([&] {
    for (std::uint64_t number = 1; number < 900;) {
      const auto extent = history.extent();
      number = extent->last_number;
      const auto found = history.Numbered(extent->first_number + number / 2);
      ASSERT_NE(found, nullptr);
      ASSERT_LE(found->number, history.extent()->last_number);
    }
  });
  for (std::uint64_t number = 2; number <= 900; ++number) history.Add(StateAt(number));
  reader.join();
}

}  // namespace
}  // namespace kinescope::history
