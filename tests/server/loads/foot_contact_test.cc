#include "server/loads/foot_contact.h"

#include <random>

#include "core/system/clocks.h"
#include "server/loads/support_polygon.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

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
    now_ += millis * kNanosPerMilli;
    contacts_.Update(SampleOf(links_, now_), links_, Person(), 0, {});
  }

  const FootContacts& contacts() const { return contacts_; }
  bool touches() const { return contacts_.touches(kRight); }
  double weight() const { return contacts_.feet()[kRight].weight; }
  double heel_weight() const { return contacts_.heel_weight(kRight); }
  double forefoot_weight() const { return contacts_.forefoot_weight(kRight); }

 private:
  LinkPoses links_ = Posed({});
  std::int64_t now_ = 1;
  FootContacts contacts_;
};

TEST(FootContacts, WeighsHeelAndForefootEachOnItsOwn) {
  Feet feet;
  EXPECT_EQ(feet.heel_weight(), 1);
  EXPECT_EQ(feet.forefoot_weight(), 1);
  for (int i = 0; i < 20; ++i) feet.Move(0.08, 0, 20, 40);  // on tiptoe
  EXPECT_EQ(feet.heel_weight(), 0);
  EXPECT_EQ(feet.forefoot_weight(), 1);
}

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
  EXPECT_TRUE(feet.touches()) << "one high sample is not enough";
  feet.Move(0.09, 0, 100);
  EXPECT_FALSE(feet.touches());

  Feet sliding;
  sliding.Move(0, 0.04, 100);  // 0.4 m/s
  EXPECT_TRUE(sliding.touches());
  sliding.Move(0, 0.10, 100);  // 0.6 m/s
  sliding.Move(0, 0.16, 100);
  EXPECT_FALSE(sliding.touches());
  sliding.Move(0, 0.20, 100);
  sliding.Move(0, 0.24, 100);
  sliding.Move(0, 0.28, 100);
  EXPECT_FALSE(sliding.touches()) << "0.4 m/s is too fast to come down";
  sliding.Move(0, 0.30, 100);
  sliding.Move(0, 0.32, 100);
  EXPECT_TRUE(sliding.touches());
}

TEST(FootContacts, RaiseTheirWeightWithinATenthOfASecondAndDropItAtOnce) {
  Feet feet;
  feet.Move(0.3, 0, 600);  // after a gap, without ramps
  ASSERT_EQ(feet.weight(), 0);
  feet.Move(0, 0, 600);
  ASSERT_EQ(feet.weight(), 1);
  feet.Move(0.3, 0, 50);
  EXPECT_EQ(feet.weight(), 1);
  feet.Move(0.3, 0, 50);
  EXPECT_FALSE(feet.touches());
  EXPECT_EQ(feet.weight(), 0) << "a foot in the air carries nothing";
  int millis = 0;
  while (!feet.touches() && millis < 300) {
    feet.Move(0, 0, 20);
    millis += 20;
  }
  EXPECT_LE(millis, 160) << "the fitted speed follows within 0.1 s";
  EXPECT_GT(feet.weight(), 0);
  EXPECT_LT(feet.weight(), 1);
  feet.Move(0, 0, 100);
  EXPECT_EQ(feet.weight(), 1);
}

struct Standing {
  double share = 0;  // of samples with both feet on the floor
  int changes = 0;   // of contacts
};

// Ten seconds of a standing person, with noise of every position and, if asked for, stamps that
// come in bursts of eight and a step of all positions every second.
Standing StandFor10Secs(double rate_hz, double noise_m, bool is_bursty = false,
                        double correction_m = 0) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, noise_m);
  FootContacts contacts;
  Standing standing;
  const int count = static_cast<int>(10 * rate_hz);
  bool was_right = true;
  Vector3d correction = Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    LinkPoses links = Posed({});
    if (i % static_cast<int>(rate_hz) == 0) correction.x() += correction_m;
    for (Pose& link : links) {
      link.position += correction + Vector3d(noise(random), noise(random), noise(random));
    }
    const int sent = is_bursty ? i / 8 * 8 + 7 : i;
    const double stamp = sent / rate_hz + (is_bursty ? (i % 8) * 50e-6 : 0);
    contacts.Update(SampleOf(links, std::llround(stamp * 1e9) + 1), links, Person(), 0, {});
    standing.share += contacts.touches(kRight) && contacts.touches(kLeft) ? 1.0 / count : 0;
    standing.changes += contacts.touches(kRight) != was_right;
    was_right = contacts.touches(kRight);
  }
  return standing;
}

TEST(FootContacts, HoldStandingFeetThroughNoiseBurstsAndCorrectionsAtEveryRate) {
  for (const double rate_hz : {60.0, 120.0, 240.0}) {
    EXPECT_GE(StandFor10Secs(rate_hz, 0.001).share, 0.995) << rate_hz;
    EXPECT_GE(StandFor10Secs(rate_hz, 0.001, true).share, 0.995) << rate_hz << " Hz, bursts";
    EXPECT_GE(StandFor10Secs(rate_hz, 0.001, false, 0.02).share, 0.995)
        << rate_hz << " Hz, corrections of 2 cm";
    EXPECT_EQ(StandFor10Secs(rate_hz, 0.002).changes, 0) << rate_hz;
  }
}

TEST(FootContacts, UseStreamedVelocitiesWhereThereAreAny) {
  // Positions that stand still do not hide a foot that is known to move.
  LinkPoses links = Posed({});
  FootContacts contacts;
  for (int i = 0; i < 10; ++i) {
    BodySample sample = SampleOf(links, 1 + i * 10 * kNanosPerMilli);
    sample.has_linear = sample.has_angular = true;
    for (const auto segment : {std::size_t(kRightFoot), std::size_t(kRightToe)}) {
      sample.segments[segment].velocity = Vector3d(i < 5 ? 0.01 : 1.0, 0, 0);
    }
    contacts.Update(sample, links, Person(), 0, {});
    EXPECT_TRUE(contacts.touches(kLeft));
    if (i < 5) EXPECT_TRUE(contacts.touches(kRight));
  }
  EXPECT_FALSE(contacts.touches(kRight));
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
    sample.stamp_nanos += millis * kNanosPerMilli;
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
  EXPECT_EQ(contacts.feet()[kRight].weight, 0);
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
