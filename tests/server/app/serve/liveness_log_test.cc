#include "server/app/serve/liveness_log.h"

#include <gtest/gtest.h>

#include "tests/captured_log.h"

namespace kinescope::app {
namespace {

SceneState StateWith(Liveness liveness, const std::string& name = "") {
  SceneState state;
  state.liveness = liveness;
  state.source = "udp://:9763";
  state.counter = 812;
  state.people.emplace_back();
  state.people.back().name = name;
  return state;
}

TEST(LivenessLog, ReportsChangesOnly) {
  const testing::CapturedLog log;
  LivenessLog liveness;
  liveness.OnState(StateWith(Liveness::kNoData));
  for (int i = 0; i < 3; ++i) liveness.OnState(StateWith(Liveness::kLive));
  liveness.OnState(StateWith(Liveness::kStale));
  liveness.OnState(StateWith(Liveness::kStale));
  liveness.OnState(StateWith(Liveness::kLive, "Anna"));
  EXPECT_EQ(log.text(),
            "info: waiting for data from udp://:9763\n"
            "info: live: a person from udp://:9763\n"
            "warning: stale: no data from udp://:9763 since sample 812\n"
            "info: live: 'Anna' from udp://:9763\n");
}

TEST(LivenessLog, UsesNoNameInASceneWithoutPeople) {
  const testing::CapturedLog log;
  SceneState state = StateWith(Liveness::kLive);
  state.people.clear();
  LivenessLog().OnState(state);
  EXPECT_EQ(log.text(), "info: live: a person from udp://:9763\n");
}

}  // namespace
}  // namespace kinescope::app
