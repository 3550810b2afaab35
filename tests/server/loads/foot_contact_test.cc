#include "server/loads/foot_contact.h"

#include "server/loads/support_polygon.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

constexpr std::int64_t kMillis = 1'000'000;

// A foot that is moved by hand: the right one of somebody standing.
class Feet {
 public:
  Feet() { Step(0); }

  // The right foot `height` above the floor and `forward` of where it stood, `millis` later.
  void Move(double height, double forward, std::int64_t millis, double pitch_deg = 0) {
    links_ = Posed({{kRightFoot, Ry(pitch_deg)}, {kRightToe, Ry(pitch_deg)}});
    for (const std::size_t i : {std::size_t(kRightFoot), std::size_t(kRightToe)}) {
      links_[i].position += Vector3d(forward, 0, height);
    }
    Step(millis);
  }
  void Step(std::int64_t millis) {
    now_ += millis * kMillis;
    contacts_.Update(SampleOf(links_, now_), links_, Person(), 0, {});
  }

  const FootContacts& contacts() const { return contacts_; }
  bool touches() const { return contacts_.touches(kRight); }
  double weight() const { return contacts_.feet()[kRight].weight; }

 private:
  LinkPoses links_ = Posed({});
  std::int64_t now_ = 1;
  FootContacts contacts_;
};

TEST(FootContacts, IncludeBothFeetInTheFirstSample) {
  const Feet feet;
  EXPECT_TRUE(feet.touches());
  EXPECT_EQ(feet.weight(), 1);
  EXPECT_LT((feet.contacts().feet()[kRight].center - Vector2d(0.0875, -0.085)).norm(), 1e-9);
  // Heel to toe tip, 0.0275 of the stature to either side.
  const SupportPolygon& foot = feet.contacts().polygon(kRight);
  ASSERT_EQ(foot.size, 4U);
  EXPECT_NEAR(DistanceInside(foot, {0.1, -0.085}), 0.0275 * 1.75, 1e-9);
  EXPECT_NEAR(DistanceInside(foot, {-0.055, -0.085}), -0.01, 1e-9);
  EXPECT_NEAR(DistanceInside(feet.contacts().support(), {0.0875, 0}), 0.1325, 1e-9);
}

TEST(FootContacts, EndByHeightOrBySpeedWithHysteresis) {
  Feet feet;
  feet.Move(0.07, 0, 1000);  // after a gap: heights decide at once, and 7 cm is too high
  EXPECT_FALSE(feet.touches());
  feet.Move(0.045, 0, 100);
  EXPECT_FALSE(feet.touches()) << "one slow sample is not enough";
  feet.Move(0.045, 0, 100);
  EXPECT_TRUE(feet.touches());
  feet.Move(0.07, 0, 100);
  EXPECT_TRUE(feet.touches()) << "between the limits it stays";
  feet.Move(0.09, 0, 100);
  EXPECT_FALSE(feet.touches());

  Feet sliding;
  sliding.Move(0, 0.04, 100);  // 0.4 m/s
  EXPECT_TRUE(sliding.touches());
  sliding.Move(0, 0.10, 100);  // 0.6 m/s
  EXPECT_FALSE(sliding.touches());
  sliding.Move(0, 0.14, 100);
  sliding.Move(0, 0.18, 100);
  EXPECT_FALSE(sliding.touches()) << "0.4 m/s is too fast to come down";
  sliding.Move(0, 0.20, 100);
  sliding.Move(0, 0.22, 100);
  EXPECT_TRUE(sliding.touches());
}

TEST(FootContacts, ChangeTheirWeightWithinATenthOfASecond) {
  Feet feet;
  feet.Move(0.3, 0, 25);
  EXPECT_FALSE(feet.touches());
  EXPECT_NEAR(feet.weight(), 0.5 * (1 + std::cos(M_PI * 0.25)), 1e-9);
  feet.Move(0.3, 0, 25);
  EXPECT_NEAR(feet.weight(), 0.5, 1e-9);
  feet.Move(0.3, 0, 60);
  EXPECT_EQ(feet.weight(), 0);
}

TEST(FootContacts, OfHeelOrToesUseThatEndOfTheFootOnly) {
  Feet heel;
  heel.Move(0.045, 0, 1000, -20);  // toes up, heel about where it was
  ASSERT_TRUE(heel.touches());
  ASSERT_EQ(heel.contacts().polygon(kRight).size, 4U);
  const LinkPoses links = Posed({{kRightFoot, Ry(-20)}, {kRightToe, Ry(-20)}});
  const Vector3d at =
      links[kRightFoot].position + links[kRightFoot].orientation * Person().heel_in_foot[kRight];
  EXPECT_LT((heel.contacts().feet()[kRight].center - at.head<2>()).norm(), 1e-9);
  EXPECT_LT(DistanceInside(heel.contacts().polygon(kRight), at.head<2>() + Vector2d(0.1, 0)), 0);

  Feet toes;
  toes.Move(0.06, 0, 1000, 25);
  ASSERT_TRUE(toes.touches());
  const LinkPoses tiptoe = Posed({{kRightFoot, Ry(25)}, {kRightToe, Ry(25)}});
  const Pose& toe = tiptoe[kRightToe];
  const Vector3d tip = toe.position + toe.orientation * Person().toe_tip_in_toe[kRight];
  EXPECT_LT((toes.contacts().feet()[kRight].center - 0.5 * (toe.position + tip).head<2>()).norm(),
            1e-9)
      << "midway between ball and tip";
  EXPECT_LT(DistanceInside(toes.contacts().polygon(kRight), {0.0, -0.085}), 0);
}

TEST(FootContacts, ChangeSmoothlyWhenTheHeelLeavesTheFloor) {
  Feet feet;
  Vector2d last = feet.contacts().feet()[kRight].center;
  double most = 0;
  for (int i = 1; i <= 100; ++i) {  // rolls over the ball, 1 s
    const double pitch = 0.4 * i;
    const double lift = 0.166 * std::sin(pitch * M_PI / 180);
    feet.Move(lift, 0, 10, pitch);
    const Vector2d now = feet.contacts().feet()[kRight].center;
    most = std::max(most, (now - last).norm());
    last = now;
  }
  EXPECT_LT(most, 0.02) << "m within 10 ms";
}

TEST(FootContacts, FollowTheSenderWithRampsEvenAgainstThePose) {
  const LinkPoses links = Posed({});
  FootContacts contacts;
  BodySample sample = SampleOf(links);
  const auto tell = [&](bool right, bool left, std::int64_t millis) {
    sample.foot_contacts = {FootContactFlags{right, right}, FootContactFlags{left, left}};
    sample.stamp_nanos += millis * kMillis;
    contacts.Update(sample, links, Person(), 0, {});
  };
  tell(true, false, 0);
  EXPECT_TRUE(contacts.touches(kRight));
  EXPECT_FALSE(contacts.touches(kLeft)) << "it stands on the floor, but MVN knows better";
  EXPECT_EQ(contacts.feet()[kLeft].weight, 0);
  tell(true, true, 50);
  EXPECT_TRUE(contacts.touches(kLeft));
  EXPECT_NEAR(contacts.feet()[kLeft].weight, 0.5, 1e-9) << "half way up the ramp of 0.1 s";
  tell(false, true, 50);
  EXPECT_EQ(contacts.feet()[kLeft].weight, 1);
  EXPECT_FALSE(contacts.touches(kRight));
}

TEST(FootContacts, AreAbsentInTheAir) {
  LinkPoses links = Posed({});
  for (Pose& link : links) link.position.z() += 0.2;
  FootContacts contacts;
  contacts.Update(SampleOf(links), links, Person(), 0, {});
  EXPECT_FALSE(contacts.any());
  EXPECT_EQ(contacts.support().size, 0U);
}

}  // namespace
}  // namespace kinescope::loads::testing
