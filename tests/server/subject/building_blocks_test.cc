// Jets and curves: what the motions are made of.
#include <gtest/gtest.h>

#include <random>

#include "server/subject/curve.h"
#include "server/subject/jet.h"

namespace kinescope::subject {
namespace {

// Each operation once, so that a wrong derivative of any of them shows.
Jet Everything(const Jet& t) {
  const Jet a = sin(1.3 * t) + 2.0;
  const Jet b = cos(0.7 * t * t) / a - 0.2;
  const Jet c = atan2(b + 1.5, a * b - t);
  return sqrt(a) * acos(0.5 * b / a) - c / (1.0 + t * t) + -b;
}

TEST(Jet, HasDerivativesThatAgreeWithFiniteDifferences) {
  constexpr double kStep = 1e-4;
  for (double t = -2; t < 2; t += 0.037) {
    const Jet now = Everything({t, 1, 0});
    const Jet before = Everything({t - kStep, 1, 0});
    const Jet after = Everything({t + kStep, 1, 0});
    EXPECT_NEAR(now.rate, (after.value - before.value) / (2 * kStep), 1e-6) << "at " << t;
    EXPECT_NEAR(now.accel, (after.rate - before.rate) / (2 * kStep), 1e-5) << "at " << t;
  }
}

TEST(Jet, AppliesTheChainRuleForAcceleratedTime) {
  const Jet inner(0.4, 1.7, -2.3);  // u(t) with u' = 1.7 and u'' = -2.3
  const Jet outer = sin(inner);
  EXPECT_DOUBLE_EQ(outer.rate, std::cos(0.4) * 1.7);
  EXPECT_DOUBLE_EQ(outer.accel, std::cos(0.4) * -2.3 - std::sin(0.4) * 1.7 * 1.7);
}

TEST(Jet, RotatesVectorsByQuaternionsLikeByMatrices) {
  const JetQuaternion q = TurnZ(Jet(0.3, 1, 2)) * TurnY(Jet(-0.8, 3, 0)) * TurnX(Jet(1.1, 0, -1));
  const JetVector v(Jet(0.2, 1, 0), Jet(-0.4, 0, 1), Jet(0.9, -2, 3));
  const JetVector turned = q * v;
  const JetVector expected = q.toRotationMatrix() * v;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(turned[i].value, expected[i].value, 1e-14);
    EXPECT_NEAR(turned[i].rate, expected[i].rate, 1e-13);
    EXPECT_NEAR(turned[i].accel, expected[i].accel, 1e-12);
  }
}

const std::vector<Curve::Key> kKeys = {{0.5, 1.0}, {1.0, 3.0}, {1.8, 4.0}, {2.5, 4.0}, {3.5, -1.0}};
constexpr double kPeriod = 4;

TEST(Curve, PassesThroughItsKeysInEveryPeriod) {
  const Curve curve(kPeriod, kKeys);
  for (const Curve::Key& key : kKeys) {
    for (const double shift : {0.0, kPeriod, -3 * kPeriod}) {
      EXPECT_NEAR(curve.At(key.at + shift).value, key.value, 1e-12) << "key at " << key.at;
    }
  }
}

TEST(Curve, IsContinuousUpToTheSecondDerivativeAtKeysAndPeriodEnds) {
  const Curve curve(kPeriod, kKeys);
  for (const double at : {0.0, 0.5, 1.0, 1.8, 2.5, 3.5, 4.0}) {
    const Jet before = curve.At({at - 1e-9, 1, 0});
    const Jet after = curve.At({at + 1e-9, 1, 0});
    EXPECT_NEAR(before.value, after.value, 1e-6) << "at " << at;
    EXPECT_NEAR(before.rate, after.rate, 1e-6) << "at " << at;
    EXPECT_NEAR(before.accel, after.accel, 1e-5) << "at " << at;
  }
}

TEST(Curve, StaysBetweenNeighbouringKeysAndIsConstantBetweenEqualOnes) {
  const Curve curve(kPeriod, kKeys);
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const Curve::Key& from = kKeys[i];
    const Curve::Key to =
        i + 1 < kKeys.size() ? kKeys[i + 1] : Curve::Key{kKeys[0].at + kPeriod, kKeys[0].value};
    for (double s = 0; s <= 1; s += 0.01) {
      const Jet x = curve.At({from.at + s * (to.at - from.at), 1, 0});
      EXPECT_GE(x.value, std::min(from.value, to.value) - 1e-12);
      EXPECT_LE(x.value, std::max(from.value, to.value) + 1e-12);
      if (from.value == to.value) {
        EXPECT_NEAR(x.rate, 0, 1e-12);
      }
    }
  }
}

TEST(GlideStep, RisesFromZeroToOneWithContinuousAcceleration) {
  for (const double ramp : {0.2, 0.35, 0.5}) {
    EXPECT_EQ(GlideStep(-1.0, ramp).value, 0);
    EXPECT_EQ(GlideStep(2.0, ramp).value, 1);
    EXPECT_NEAR(GlideStep({0.5, 1, 0}, ramp).rate, 1 / (1 - ramp), 1e-12);
    for (const double at : {0.0, ramp, 1 - ramp, 1.0}) {
      const Jet before = GlideStep({at - 1e-9, 1, 0}, ramp);
      const Jet after = GlideStep({at + 1e-9, 1, 0}, ramp);
      EXPECT_NEAR(before.value, after.value, 1e-7) << "ramp " << ramp << " at " << at;
      EXPECT_NEAR(before.rate, after.rate, 1e-6) << "ramp " << ramp << " at " << at;
      EXPECT_NEAR(before.accel, after.accel, 1e-5) << "ramp " << ramp << " at " << at;
    }
  }
}

}  // namespace
}  // namespace kinescope::subject
