#include "server/loads/motion_filter.h"

#include <complex>

#include "server/subject/subject.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

// Amplitude and phase (rad) that a wave of `hz` comes out with, once settled.
std::complex<double> ResponseAt(double hz, double cutoff_hz, double rate_hz) {
  LowPass filter;
  filter.Restart(Vector3d::Zero());
  const double step = 1 / rate_hz;
  const int settled = static_cast<int>(4 * rate_hz);
  // Whole periods, so that the sums below are orthogonal.
  const int counted = static_cast<int>(std::lround(20 * rate_hz / hz));
  std::complex<double> sum;
  for (int i = 1; i <= settled + counted; ++i) {
    const double phase = 2 * M_PI * hz * i * step;
    filter.Update({std::cos(phase), 0, 0}, LowPassStep(step, cutoff_hz));
    if (i > settled) sum += filter.value().x() * std::polar(1.0, -phase);
  }
  return sum * (2.0 / counted);
}

TEST(LowPass, IsAButterworthFilterOfSecondOrderAtAnyRate) {
  for (const double rate : {30.0, 60.0, 100.0, 240.0}) {
    // The bilinear form warps frequencies: the analogue one that `hz` stands for.
    const auto warped = [&](double hz) { return std::tan(M_PI * hz / rate); };
    for (const double cutoff : {3.0, 5.0, 10.0}) {
      for (const double hz : {0.5, 1.0, 5.0, 10.0}) {
        const double ratio = warped(hz) / warped(cutoff);
        const std::complex<double> s(0, ratio);
        const std::complex<double> expected = 1.0 / (s * s + std::sqrt(2.0) * s + 1.0);
        EXPECT_LT(std::abs(ResponseAt(hz, cutoff, rate) - expected), 2e-3)
            << hz << " Hz through " << cutoff << " Hz at " << rate;
      }
    }
    EXPECT_NEAR(std::abs(ResponseAt(5, 5, rate)), std::sqrt(0.5), 2e-3);
  }
}

TEST(LowPass, ComputesTheDerivativeOfItsOutput) {
  LowPass filter;
  filter.Restart(Vector3d::Zero());
  Random random(1);
  Vector3d sum = Vector3d::Zero(), last_half_step = Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) {
    const double step = 0.01 + 0.005 * random.Number(1);  // suits stutter
    filter.Update(random.Vector(1), LowPassStep(step, 5));
    const Vector3d half_step = 0.5 * step * filter.rate();
    sum += last_half_step + half_step;
    last_half_step = half_step;
  }
  EXPECT_LT((sum - filter.value()).norm(), 1e-9) << "its rate does not add up to its value";
}

TEST(LowPass, SettlesOnAConstantWithUnevenSteps) {
  LowPass filter;
  filter.Restart(Vector3d::Zero());
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    filter.Update({1, -2, 3}, LowPassStep(0.02 + 0.019 * random.Number(1), 5));
  }
  EXPECT_LT((filter.value() - Vector3d(1, -2, 3)).norm(), 1e-9);
  EXPECT_LT(filter.rate().norm(), 1e-6);
}

TEST(LowPass, SurvivesARateBelowTwiceItsCutOff) {
  LowPass filter;
  filter.Restart(Vector3d::Zero());
  for (int i = 0; i < 100; ++i) filter.Update({1, 1, 1}, LowPassStep(0.2, 10));
  EXPECT_LT((filter.value() - Vector3d::Ones()).norm(), 1e-6);
}

BodySample MovingSample(double secs) {
  BodySample sample = subject::MakeMotion("lift")->At(secs);
  sample.stamp_nanos = 1 + std::llround(secs * 1e9);
  return sample;
}

std::string_view WhyStatic(const BodySample& sample) {
  MotionFilter filter;
  return filter.Update(sample, {}).why_static;
}

TEST(MotionFilter, IsStaticWithTheReasonIfInputsAreMissing) {
  const BodySample whole = MovingSample(1.5);
  EXPECT_EQ(WhyStatic(whole), "");
  BodySample sample = whole;
  sample.has_linear = false;
  EXPECT_EQ(WhyStatic(sample), "the source sends no linear accelerations");
  sample.has_angular = false;
  EXPECT_EQ(WhyStatic(sample), "the source sends only poses");
  sample = whole;
  sample.has_angular = false;
  EXPECT_EQ(WhyStatic(sample), "the source sends no angular velocities");
  sample = whole;
  sample.segments[kHead].acceleration.y() = std::nan("");
  EXPECT_EQ(WhyStatic(sample), "accelerations are not finite or too large");
  sample.segments[kHead].acceleration.y() = 1e300;
  EXPECT_EQ(WhyStatic(sample), "accelerations are not finite or too large");
}

TEST(MotionFilter, DifferentiatesVelocitiesIfAccelerationsAreZero) {
  MotionFilter streamed, differentiated;
  const auto motion = subject::MakeMotion("lift");
  double worst = 0, largest = 0;
  for (int i = 0; i < 120 * 4; ++i) {
    BodySample sample = motion->At(i / 120.0);
    sample.stamp_nanos = 1 + std::llround(1e9 / 120 * i);
    const BodyMotion known = streamed.Update(sample, {}).motion;
    for (SegmentState& segment : sample.segments) {
      segment.acceleration.setZero();
      segment.angular_acceleration.setZero();
    }
    const MotionFilter::Output& found = differentiated.Update(sample, {});
    ASSERT_TRUE(found.is_dynamic) << found.why_static;
    if (i < 60) continue;  // the streamed ones begin at their value, the others at rest
    for (std::size_t segment = 0; segment < known.size(); ++segment) {
      worst = std::max(
          {worst, (known[segment].acceleration - found.motion[segment].acceleration).norm(),
           (known[segment].angular_acceleration - found.motion[segment].angular_acceleration)
               .norm()});
      largest = std::max({largest, known[segment].acceleration.norm(),
                          known[segment].angular_acceleration.norm()});
    }
  }
  EXPECT_GT(largest, 2) << "nothing moved";
  EXPECT_LT(worst, 0.01 * largest) << "m/s^2 or rad/s^2";
}

TEST(MotionFilter, RestartsAfterAGapOrABackwardTimeStep) {
  for (const std::int64_t jump : {300'000'000LL, -50'000'000LL}) {
    MotionFilter filter;
    BodySample sample = MovingSample(1.5);
    filter.Update(sample, {});
    sample.stamp_nanos += jump;
    sample.segments[kHead].acceleration = {1, 2, 3};
    EXPECT_EQ(filter.Update(sample, {}).motion[kHead].acceleration, Vector3d(1, 2, 3)) << jump;
  }
}

TEST(MotionFilter, KeepsItsValuesDuringAShortLossOnly) {
  MotionFilter filter;
  BodySample sample = MovingSample(1.5);
  const Vector3d before = filter.Update(sample, {}).motion[kHead].acceleration;
  sample.has_linear = false;
  sample.stamp_nanos += 16'000'000;
  EXPECT_EQ(filter.Update(sample, {}).motion[kHead].acceleration, before);
  EXPECT_TRUE(filter.Update(sample, {}).is_dynamic);
  sample.stamp_nanos += 400'000'000;
  EXPECT_FALSE(filter.Update(sample, {}).is_dynamic);
}

// What becomes of a second of `spoil`ed motion.
template <class Spoil>
std::string_view WhyStaticAfterASecond(const char* motion_name, Spoil&& spoil) {
  MotionFilter filter;
  const auto motion = subject::MakeMotion(motion_name);
  std::string_view why;
  for (int i = 0; i < 60; ++i) {
    BodySample sample = motion->At(1 + i / 60.0);
    sample.stamp_nanos = 1 + std::llround(1e9 / 60 * i);
    for (SegmentState& segment : sample.segments) spoil(segment);
    why = filter.Update(sample, {}).why_static;
  }
  return why;
}

TEST(MotionFilter, DetectsAccelerationsWithGravityAndVelocitiesInDegrees) {
  for (const char* motion : {"lift", "walk"}) {
    EXPECT_EQ(WhyStaticAfterASecond(motion, [](SegmentState&) {}), "") << motion;
    EXPECT_EQ(WhyStaticAfterASecond(motion, [](SegmentState& s) { s.acceleration.z() += 9.81; }),
              "accelerations are inconsistent with the velocities")
        << motion;
    EXPECT_EQ(
        WhyStaticAfterASecond(motion, [](SegmentState& s) { s.angular_velocity *= 180 / M_PI; }),
        "angular velocities are inconsistent with the poses")
        << motion;
  }
}

TEST(MotionFilter, LimitsImpossibleAngularAccelerations) {
  MotionFilter filter;
  BodySample sample = MovingSample(1.5);
  sample.segments[kRightHand].angular_acceleration = {0, 5000, 0};
  EXPECT_LT(
      (filter.Update(sample, {}).motion[kRightHand].angular_acceleration - Vector3d(0, 1000, 0))
          .norm(),
      1e-9);
}

}  // namespace
}  // namespace kinescope::loads::testing
