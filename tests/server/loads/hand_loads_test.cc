#include "server/loads/hand_loads.h"

#include <gmock/gmock.h>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

using ::testing::HasSubstr;

struct Pushed {
  ExternalForces external;
  std::array<HandForce, 2> shown;
};

Pushed PushAt(const HandLoads& hands, const LinkPoses& links, const BodyMotion& motion = {},
              const std::array<std::optional<MeasuredHandForce>, 2>& measured = {},
              std::int64_t stamp = 0) {
  Pushed pushed;
  hands.Push(links, motion, Person(), measured, stamp, pushed.external, pushed.shown);
  return pushed;
}

Pushed PushOnce(const HandLoad& load, const LinkPoses& links, const BodyMotion& motion = {}) {
  HandLoads hands;
  hands.Update(load, 0);
  return PushAt(hands, links, motion);
}

TEST(HandLoads, ActAtTheirCentreOfMassWithWeightAndInertia) {
  const LinkPoses links = ArmForward();
  BodyMotion motion;
  motion[kRightHand] = {{1, 2, 3}, {0, 2, 0}, {0, 0, 4}};
  const Pushed pushed = PushOnce(Held(5), links, motion);
  const Vector3d arm = links[kRightHand].orientation * Vector3d(0, 0, -0.080);
  EXPECT_LT((arm - Vector3d(0.080, 0, 0)).norm(), 1e-12);
  // a + alpha x r + omega x (omega x r), by hand.
  const Vector3d acceleration = Vector3d(1, 2, 3) + Vector3d(0, 0.32, 0) + Vector3d(-0.32, 0, 0);
  const Vector3d force = -5 * (acceleration + Vector3d(0, 0, kGravity));
  EXPECT_LT((pushed.external.on(kRightHand).force - force).norm(), 1e-9);
  EXPECT_LT((pushed.external.on(kRightHand).moment - arm.cross(force)).norm(), 1e-9);
  EXPECT_EQ(pushed.shown[kRight].mass_kg, 5);
  EXPECT_EQ(pushed.shown[kLeft].mass_kg, 0);
  EXPECT_TRUE(pushed.external.on(kLeftHand).force.isZero(0));
}

TEST(HandLoads, OfBothHandsAreSharedByTheirPosition) {
  HandLoad load;
  load.is_known = true;
  load.both_kg = 10;
  const LinkPoses links = Posed({});
  Pushed pushed = PushOnce(load, links);
  EXPECT_NEAR(pushed.shown[kRight].mass_kg, 5, 1e-12);
  EXPECT_NEAR(pushed.shown[kLeft].mass_kg, 5, 1e-12);
  // A fifth of the way from the left hand to the right one.
  const Vector3d left = pushed.shown[kLeft].point, right = pushed.shown[kRight].point;
  load.both_com_in_world = left + 0.2 * (right - left) + Vector3d(0.3, 0, -0.1);
  pushed = PushOnce(load, links);
  EXPECT_NEAR(pushed.shown[kRight].mass_kg, 2, 1e-12);
  EXPECT_NEAR(pushed.shown[kLeft].mass_kg, 8, 1e-12);
  load.both_com_in_world = right + 2 * (right - left);
  EXPECT_NEAR(PushOnce(load, links).shown[kRight].mass_kg, 10, 1e-12);
}

TEST(HandLoads, ChangeWithinThreeTenthsOfASecond) {
  HandLoads hands;
  const auto mass_at = [&](const HandLoad& load, std::int64_t millis) {
    hands.Update(load, millis * kNanosPerMilli);
    return PushAt(hands, Posed({})).shown[kRight].mass_kg;
  };
  EXPECT_EQ(mass_at(Held(0), 0), 0);
  EXPECT_NEAR(mass_at(Held(6), 100), 2, 1e-9);
  EXPECT_NEAR(mass_at(Held(6), 200), 4, 1e-9);
  EXPECT_NEAR(mass_at(Held(6), 300), 6, 1e-9);
  EXPECT_NEAR(mass_at(Held(6), 400), 6, 1e-9);
  EXPECT_NEAR(mass_at(Held(0), 450), 5, 1e-9);
  EXPECT_NEAR(mass_at(Held(3), 600), 4, 1e-9) << "a new grip starts from what is held";
  EXPECT_NEAR(mass_at(Held(3), 750), 3, 1e-9);
  EXPECT_NEAR(mass_at(Held(9), 2000), 9, 1e-9) << "at once after a gap";
}

TEST(HandLoads, KeepTheirPlaceWhenReleased) {
  HandLoads hands;
  HandLoad load = Held(6);
  load.com_in_hand[kRight] = Vector3d(0.1, 0, 0);
  hands.Update(load, 0);
  const Vector3d before = PushAt(hands, Posed({})).shown[kRight].point;
  HandLoad nothing;
  nothing.is_known = true;
  hands.Update(nothing, 100 * kNanosPerMilli);
  const HandForce after = PushAt(hands, Posed({})).shown[kRight];
  EXPECT_NEAR(after.mass_kg, 4, 1e-9);
  EXPECT_LT((after.point - before).norm(), 1e-12);
}

TEST(HandLoads, IncludeMeasuredForcesWhileTheyAreValid) {
  const HandLoads hands;
  std::array<std::optional<MeasuredHandForce>, 2> measured;
  measured[kLeft] = MeasuredHandForce{{10, 0, -20}, {0, 0, 1}, Vector3d(0.5, 0.2, 1), 0};
  const LinkPoses links = Posed({});
  const Pushed fresh = PushAt(hands, links, {}, measured, 499 * kNanosPerMilli);
  EXPECT_TRUE(fresh.shown[kLeft].is_measured);
  EXPECT_EQ(fresh.external.on(kLeftHand).force, Vector3d(10, 0, -20));
  const Vector3d arm = Vector3d(0.5, 0.2, 1) - links[kLeftHand].position;
  EXPECT_LT(
      (fresh.external.on(kLeftHand).moment - Vector3d(0, 0, 1) - arm.cross(Vector3d(10, 0, -20)))
          .norm(),
      1e-12);
  EXPECT_FALSE(PushAt(hands, links, {}, measured, 501 * kNanosPerMilli).shown[kLeft].is_measured);
}

TEST(HandLoad, IsReadFromText) {
  const HandLoad load = ParseHandLoad("right:5;left:2.5@0,0.01,-0.2");
  EXPECT_TRUE(load.is_known);
  EXPECT_EQ(load.mass_kg[kRight], 5);
  EXPECT_EQ(load.mass_kg[kLeft], 2.5);
  EXPECT_FALSE(load.com_in_hand[kRight]);
  EXPECT_EQ(load.com_in_hand[kLeft].value(), Vector3d(0, 0.01, -0.2));
  EXPECT_EQ(ParseHandLoad("both:12").both_kg, 12);
  EXPECT_TRUE(ParseHandLoad("none").is_known);
}

TEST(HandLoad, IsRejectedWithTheReason) {
  const std::pair<const char*, const char*> cases[] = {
      {"right:500", "500 kg in the right hand"},
      {"left:-1", "-1 kg in the left hand"},
      {"right:60;left:60", "120 kg in all hands together"},
      {"both:nan", "'nan' is not a number"},
      {"right:5@0,0,-3", "within 2 m"},
      {"both:5@0,0,0", "takes no position"},
      {"foot:5", "unknown hand 'foot'"},
      {"right:5;", "'' is not NAME:KG"},
      {"", "'' is not NAME:KG"},
      {"right", "'right' is not NAME:KG"}};
  for (const auto& [text, expected] : cases) {
    try {
      ParseHandLoad(text);
      ADD_FAILURE() << "took '" << text << "'";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(expected));
      EXPECT_THAT(error.what(), HasSubstr("expected right:KG, left:KG or both:KG"));
    }
  }
  HandLoad load;
  load.both_kg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(FindDefect(load), HasSubstr("nan kg in both hands"));
}

}  // namespace
}  // namespace kinescope::loads::testing
