#include "server/loads/load_estimator.h"

#include <gmock/gmock.h>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/loads/zero_phase_filter.h"
#include "server/subject/subject.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

using ::testing::HasSubstr;

// Both feet on the floor whatever they do.
LoadSettings AlwaysStanding() {
  LoadSettings settings = Unclamped();
  settings.contact.on_below = settings.contact.off_above = 10;
  settings.contact.on_slower = settings.contact.off_faster = 1e9;
  return settings;
}

bool IsLeg(int joint) { return joint >= jRightHip; }

// A gentle pose, so that most of the time the feet explain it.
struct Moment {
  LinkPoses links;
  BodyMotion motion;
};
Moment RandomMoment(Random& random) {
  Moment moment{random.Pose(0.15), {}};
  for (SegmentMotion& segment : moment.motion) {
    segment = {random.Vector(0.3), random.Vector(0.5), random.Vector(1)};
  }
  return moment;
}

TEST(LoadEstimator, IsIndependentOfPositionAndHeading) {
  Random random(1);
  int legs = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Moment here = RandomMoment(random);
    Moment there = here;
    const Quaterniond yaw(AngleAxisd(random.Number(M_PI), Vector3d::UnitZ()));
    const Vector3d shift(random.Number(30), random.Number(30), 0);
    for (std::size_t i = 0; i < here.links.size(); ++i) {
      there.links[i] = {yaw * here.links[i].position + shift, yaw * here.links[i].orientation};
      const SegmentMotion& m = here.motion[i];
      there.motion[i] = {yaw * m.acceleration, yaw * m.angular_velocity,
                         yaw * m.angular_acceleration};
    }
    LoadSettings settings = AlwaysStanding();
    settings.hands = Held(5, 2);
    const LoadResult a = Estimate(here.links, settings, &here.motion);
    const LoadResult b = Estimate(there.links, settings, &there.motion);
    ASSERT_EQ(a.forces.why_no_ground, b.forces.why_no_ground);
    for (const int joint : urdf::kScoredJoints) {
      if (!At(a, joint).why_unknown.empty()) continue;
      EXPECT_LT((yaw * At(a, joint).moment - At(b, joint).moment).norm(), 1e-7);
      EXPECT_LT((yaw * At(a, joint).force - At(b, joint).force).norm(), 1e-7);
      EXPECT_NEAR(LoadOf(a, joint).ratio, LoadOf(b, joint).ratio, 1e-9);
      legs += IsLeg(joint);
    }
  }
  EXPECT_GT(legs, 300) << "hardly any pose stood";
}

TEST(LoadEstimator, GivesAMirroredPersonMirroredLoads) {
  Random random(2);
  int legs = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Moment here = RandomMoment(random);
    Moment there;
    for (int i = 0; i < kSegmentCount; ++i) {
      const std::size_t to = i == 0 ? 0 : urdf::At(Mirrored(i - 1) + 1);
      const Pose& pose = here.links[urdf::At(i)];
      const Quaterniond& q = pose.orientation;
      there.links[to] = {{pose.position.x(), -pose.position.y(), pose.position.z()},
                         Quaterniond(q.w(), -q.x(), q.y(), -q.z())};
      const SegmentMotion& m = here.motion[urdf::At(i)];
      const Vector3d polar(1, -1, 1), axial(-1, 1, -1);
      there.motion[to] = {m.acceleration.cwiseProduct(polar),
                          m.angular_velocity.cwiseProduct(axial),
                          m.angular_acceleration.cwiseProduct(axial)};
    }
    LoadSettings settings = AlwaysStanding();
    settings.hands = Held(5, 2);
    const LoadResult a = Estimate(here.links, settings, &here.motion);
    settings.hands = Held(2, 5);
    const LoadResult b = Estimate(there.links, settings, &there.motion);
    for (const int joint : urdf::kScoredJoints) {
      if (!At(a, joint).why_unknown.empty()) continue;
      const JointLoad &one = LoadOf(a, joint), &other = LoadOf(b, Mirrored(joint));
      EXPECT_NEAR(one.ratio, other.ratio, 1e-8) << kJoints[urdf::At(joint)].label;
      if (IsLeg(joint) || joint == Mirrored(joint)) continue;
      EXPECT_EQ(one.channel, other.channel);
    }
    legs += a.forces.why_no_ground.empty();
  }
  EXPECT_GT(legs, 50);
}

TEST(LoadEstimator, ComputesOverloadOfArmsAndSpineIndependentlyOfBodyMass) {
  BodyDescription heavy;
  heavy.mass_kg = 120;
  const BodyParameters other = MakeBodyParameters(heavy, Person());
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Moment moment = RandomMoment(random);
    LoadSettings settings = AlwaysStanding();
    settings.metric = LoadMetric::kOverload;
    settings.hands = Held(5);
    LoadEstimator one, two;
    const BodySample sample = SampleOf(moment.links, 1, &moment.motion);
    const LoadResult a = one.Update(sample, moment.links, {Person(), Body()}, settings);
    const LoadResult b = two.Update(sample, moment.links, {Person(), other}, settings);
    for (const int joint : urdf::kScoredJoints) {
      if (IsLeg(joint)) continue;
      EXPECT_NEAR(LoadOf(a, joint).ratio, LoadOf(b, joint).ratio, 1e-9);
    }
  }
}

TEST(LoadEstimator, UsesTheTotalMetricWithTheReasonIfTheHandLoadIsUnknown) {
  LoadSettings settings = Unclamped();
  settings.metric = LoadMetric::kOverload;
  const LoadResult result = Estimate(ArmForward(), settings);
  EXPECT_EQ(result.forces.metric, LoadMetric::kTotal);
  EXPECT_EQ(result.forces.why_other_metric,
            "hand load unknown, so only the total moment can be rated");
  ExpectRatio(result, jRightShoulder, 0.234);
}

TEST(LoadEstimator, DividesTheNormOfTheMomentByTheWeakerDirection) {
  LoadSettings settings = Unclamped();
  settings.metric = LoadMetric::kNorm;
  settings.hands = Held(5);
  const LoadResult result = Estimate(ArmForward(), settings);
  EXPECT_NEAR(LoadOf(result, jL5S1).ratio, std::hypot(8.829, 42.070) / 143, 1e-4);
}

// "No data is not green": every way of not knowing, with its reason.
void ExpectUnknown(const LoadResult& result, const char* reason, bool (*concerns)(int joint)) {
  for (const int joint : urdf::kScoredJoints) {
    const JointLoad& load = LoadOf(result, joint);
    EXPECT_EQ(load.load_class == LoadClass::kUnknown, concerns(joint))
        << kJoints[urdf::At(joint)].mvn_name << ": " << load.reason;
    if (!concerns(joint)) continue;
    EXPECT_THAT(std::string(load.reason), HasSubstr(reason));
    EXPECT_TRUE(std::isnan(load.ratio));
    EXPECT_TRUE(load.moment.array().isNaN().all());
  }
}

bool Any(int) { return true; }

TEST(LoadEstimator, ReportsUnknownLegLoadsInTheAir) {
  LinkPoses links = Posed({});
  for (Pose& link : links) link.position.z() += 0.2;
  const LoadResult result = Estimate(links);
  ExpectUnknown(result, "no foot contact", IsLeg);
  EXPECT_FALSE(result.cop);
  EXPECT_TRUE(std::isnan(result.forces.feet[kRight].force.z()));
  BodyMotion falling;
  for (SegmentMotion& segment : falling) segment.acceleration = {0, 0, -9.5};
  ExpectUnknown(Estimate(Posed({}), LoadSettings(), &falling), "flight phase", IsLeg);
}

TEST(LoadEstimator, ReportsUnknownLegLoadsWhenSittingOrLeaning) {
  // On a chair: hips and knees bent by 90 degrees, the CoM half a metre behind the feet.
  std::map<int, Quaterniond> seated = {{kRightUpperLeg, Ry(-90)}, {kLeftUpperLeg, Ry(-90)}};
  const LoadResult sitting = Estimate(Posed(seated, {0, 0, 0.525}), LoadSettings());
  EXPECT_LT(sitting.forces.cop_inside, -0.1);
  EXPECT_TRUE(sitting.forces.external_contact_suspected);
  ExpectUnknown(sitting, "sits, leans or holds on", IsLeg);
  ASSERT_TRUE(sitting.cop) << "it is shown at the border";
  EXPECT_GT(sitting.cop->x(), 0.4);
}

TEST(LoadEstimator, ReportsLeaningOnlyAfterADelay) {
  LoadEstimator estimator;
  const LoadSubject subject{Person(), Body()};
  std::int64_t now = 1;
  const auto step = [&](double lurch, int millis) {
    BodyMotion motion;
    for (SegmentMotion& segment : motion) segment.acceleration = {lurch, 0, 0};
    LoadSettings settings;
    settings.motion.cutoff_hz = 1e6;  // lets everything through
    const LinkPoses links = Posed({});
    BodySample sample = SampleOf(links, now += millis * kNanosPerMilli, &motion);
    for (SegmentState& segment : sample.segments) segment.velocity = {0.001 * lurch, 0, 0};
    return estimator.Update(sample, links, subject, settings).forces.external_contact_suspected;
  };
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(step(0, 10));
  for (int i = 0; i < 15; ++i) EXPECT_FALSE(step(4, 10)) << "0.15 s of it";
  EXPECT_FALSE(step(0, 10));
  for (int i = 0; i < 19; ++i) step(4, 10);
  EXPECT_TRUE(step(4, 30)) << "0.2 s of it";
}

TEST(LoadEstimator, ReportsUnknownLoadsOfUnrecordedLegs) {
  LoadEstimator estimator;
  LoadSubject subject{Person(), Body()};
  subject.has_legs = false;
  const LinkPoses links = Posed({});
  const LoadResult& result = estimator.Update(SampleOf(links), links, subject, LoadSettings());
  ExpectUnknown(result, "does not measure the legs", IsLeg);
  EXPECT_FALSE(result.cop);
  EXPECT_FALSE(result.forces.margin_of_stability);
}

TEST(LoadEstimator, ReportsUnknownLoadsOfANonFinitePoseAndRecovers) {
  LoadEstimator estimator;
  LinkPoses links = Posed({});
  const LoadSubject subject{Person(), Body()};
  estimator.Update(SampleOf(links, 1), links, subject, LoadSettings());
  const LinkPoses good = links;
  links[kLeftHand].position.y() = std::nan("");
  ExpectUnknown(
      estimator.Update(SampleOf(links, 10 * kNanosPerMilli), links, subject, LoadSettings()),
      "not finite", Any);
  const LoadResult& after =
      estimator.Update(SampleOf(good, 20 * kNanosPerMilli), good, subject, LoadSettings());
  EXPECT_EQ(LoadOf(after, jRightKnee).load_class, LoadClass::kLow);
}

TEST(LoadEstimator, IsStaticWithTheReasonIfAccelerationsAreMissing) {
  const LoadResult result = Estimate(Posed({}));
  EXPECT_FALSE(result.forces.is_dynamic);
  EXPECT_EQ(result.forces.why_static, "the source sends only poses");
  EXPECT_FALSE(result.forces.margin_of_stability) << "nobody knows how fast the CoM is";
}

TEST(LoadEstimator, ReportsUnknownLoadsAfterAHandSensorStopped) {
  Measurements measured;
  measured.hands[kRight].emplace().force = {0, 0, -50};
  measured.hands[kRight]->stamp_nanos = 1;
  LoadEstimator estimator;
  const LinkPoses links = ArmForward();
  const LoadSubject subject{Person(), Body()};
  const LoadResult& fresh =
      estimator.Update(SampleOf(links, 1), links, subject, Unclamped(), measured);
  EXPECT_NEAR(At(fresh, jRightWrist).moment.y(), -0.309 - 50 * 0.0798, 1e-3);
  const auto concerns = [](int joint) {
    return joint != jT1C7 && joint != jLeftShoulder && joint != jLeftElbow && joint != jLeftWrist;
  };
  ExpectUnknown(estimator.Update(SampleOf(links, 600 * kNanosPerMilli), links, subject, Unclamped(),
                                 measured),
                "no data from the hand force sensor", concerns);
}

TEST(LoadEstimator, AppliesMeasuredFootForcesAtTheFeet) {
  Measurements measured;
  for (const Side side : {kRight, kLeft}) {
    MeasuredGroundForce& foot = measured.feet[side].emplace();
    foot.stamp_nanos = 1;
    foot.force = {0, 0, side == kRight ? 500 : 235.75};
    foot.point = {0.05, side == kRight ? -0.085 : 0.085, 0};
  }
  const LoadResult result = Estimate(Posed({}), LoadSettings(), nullptr, measured);
  EXPECT_TRUE(result.forces.ground_is_measured);
  EXPECT_EQ(result.forces.feet[kRight].force.z(), 500);
  EXPECT_NEAR(At(result, jRightAnkle).moment.y(),
              0.05 * 500 - kGravity * (0.92475 * 0.05944 + 0.10275 * 0.185), 1e-3);
  EXPECT_NEAR(result.cop->y(), -0.085 * (500 - 235.75) / 735.75, 1e-9);
  // A plate that says half of the weight: something else holds the person, or the mass is wrong.
  measured.feet[kRight]->force.z() = 100;
  ExpectUnknown(Estimate(Posed({}), LoadSettings(), nullptr, measured),
                "measured ground force is inconsistent", IsLeg);
  // An old measurement is none.
  measured.feet[kRight]->stamp_nanos = -600 * kNanosPerMilli;
  EXPECT_FALSE(Estimate(Posed({}), LoadSettings(), nullptr, measured).forces.ground_is_measured);
}

TEST(LoadEstimator, ComputesOverloadFromAForcePlateForTheLegsOnly) {
  Measurements measured;
  measured.ground.emplace().force = {0, 0, 735.75 + 50};
  measured.ground->point = {0.03, 0, 0};
  measured.ground->stamp_nanos = 1;
  LoadSettings settings = Unclamped();
  settings.metric = LoadMetric::kOverload;
  LoadResult result = Estimate(Posed({}), settings, nullptr, measured);
  const auto not_leg = [](int joint) { return !IsLeg(joint); };
  for (const JointLoad& load : result.loads) {
    EXPECT_EQ(load.load_class == LoadClass::kUnknown, not_leg(load.joint)) << load.joint;
  }
  const double added = 0.5 * ((735.75 + 50) * 0.03 - 735.75 * 0.00197);
  ExpectRatio(result, jRightAnkle, added / 126);
  measured.ground->force.z() = 735.75 + 4;  // noise
  measured.ground->point.x() = 0.004;
  result = Estimate(Posed({}), settings, nullptr, measured);
  EXPECT_NEAR(LoadOf(result, jRightAnkle).ratio, 0, 1e-12);
}

TEST(LoadEstimator, UsesExternalLoadsUnchangedWhileTheyAreValid) {
  Measurements measured;
  ExternalJointLoad& knee = measured.joints[jRightKnee];
  knee.ratio = 0.7;
  knee.stamp_nanos = 1;
  ExternalJointLoad& elbow = measured.joints[jLeftElbow];
  elbow.load_class = LoadClass::kMedium;
  elbow.stamp_nanos = 1;
  ExternalJointLoad& hip = measured.joints[jRightHip];
  hip.moment = {0, 19, 0};
  hip.stamp_nanos = 1;
  measured.joints[jLeftHip].ratio = -3;  // nonsense is nothing
  measured.joints[jLeftHip].stamp_nanos = 1;
  LoadSettings settings = Unclamped();
  settings.metric = LoadMetric::kExternal;
  LoadEstimator estimator;
  const LinkPoses links = Posed({});
  const LoadSubject subject{Person(), Body()};
  const LoadResult& fresh =
      estimator.Update(SampleOf(links, 1), links, subject, settings, measured);
  EXPECT_EQ(LoadOf(fresh, jRightKnee).load_class, LoadClass::kHigh);
  EXPECT_EQ(LoadOf(fresh, jRightKnee).ratio, 0.7);
  EXPECT_EQ(LoadOf(fresh, jRightKnee).shown_ratio, 0.7);
  EXPECT_EQ(LoadOf(fresh, jLeftElbow).load_class, LoadClass::kMedium);
  EXPECT_EQ(LoadOf(fresh, jLeftElbow).band, LoadClass::kMedium);
  EXPECT_TRUE(std::isnan(LoadOf(fresh, jLeftElbow).shown_ratio));
  EXPECT_TRUE(std::isnan(LoadOf(fresh, jLeftElbow).ratio));
  ExpectRatio(fresh, jRightHip, 0.1);
  EXPECT_EQ(LoadOf(fresh, jL5S1).load_class, LoadClass::kUnknown);
  EXPECT_EQ(LoadOf(fresh, jL5S1).reason, "no external load received for this joint");
  EXPECT_EQ(LoadOf(fresh, jLeftHip).load_class, LoadClass::kUnknown);
  const LoadResult& stale =
      estimator.Update(SampleOf(links, 600 * kNanosPerMilli), links, subject, settings, measured);
  EXPECT_EQ(LoadOf(stale, jRightKnee).load_class, LoadClass::kUnknown);
  EXPECT_EQ(LoadOf(stale, jRightKnee).reason, "no more external loads received for this joint");
}

TEST(LoadEstimator, UsesTheLargerRatioOfLumbarMomentAndCompression) {
  // Limits of the joints' own that no moment exceeds: the disc has its limits in newtons.
  LoadSettings settings = Unclamped();
  settings.hands = Held(30, 30);
  settings.meter = LoadMeter::WithLimits({3, 4});
  const LoadResult result = Estimate(TrunkBent(), settings);
  ASSERT_GT(result.forces.lumbar->compression, 3400);
  const JointLoad& disc = LoadOf(result, jL5S1);
  EXPECT_EQ(disc.ratio, LumbarRatio(*result.forces.lumbar, settings.meter.up));
  EXPECT_GT(disc.ratio, 3);
  EXPECT_EQ(disc.shown_ratio, disc.ratio);
  EXPECT_EQ(disc.band, disc.load_class);
  EXPECT_GE(disc.load_class, LoadClass::kMedium);
  EXPECT_EQ(disc.channel, "compression");
  EXPECT_TRUE(disc.is_of_compression);
  settings.compression_counts = false;
  EXPECT_EQ(LoadOf(Estimate(TrunkBent(), settings), jL5S1).load_class, LoadClass::kLow);
}

TEST(LoadEstimator, TellsBothRatiosOfL5S1WhicheverIsTheLargerOne) {
  LoadSettings settings = Unclamped();
  settings.hands = Held(30, 30);
  for (const std::array<double, 2>& limits : {std::array<double, 2>{3, 4}, {0.01, 0.02}}) {
    settings.meter = LoadMeter::WithLimits(limits);
    const LoadResult result = Estimate(TrunkBent(), settings);
    const JointLoad& disc = LoadOf(result, jL5S1);
    const double of_compression = result.forces.lumbar->ratio;
    EXPECT_EQ(of_compression, LumbarRatio(*result.forces.lumbar, limits));
    EXPECT_EQ(disc.ratio, std::max(of_compression, disc.moment_ratio));
    EXPECT_EQ(disc.next_ratio, std::min(of_compression, disc.moment_ratio));
    EXPECT_EQ(disc.channel, limits[0] > 1 ? "compression" : "extension");
    EXPECT_EQ(disc.next_channel, limits[0] > 1 ? "extension" : "compression");
  }
  settings.compression_counts = false;
  const LoadResult result = Estimate(TrunkBent(), settings);
  EXPECT_NE(LoadOf(result, jL5S1).next_channel, "compression") << "it does not compete";
  EXPECT_GT(result.forces.lumbar->ratio, 0);
}

TEST(LoadEstimator, ReportsADifferenceFromTheCentreOfMassOfMvn) {
  const LinkPoses links = Posed({});
  BodySample sample = SampleOf(links);
  sample.com.emplace().position = Vector3d(0.002, 0, 1.0079 + 0.02);
  LoadEstimator estimator;
  const LoadResult& result = estimator.Update(sample, links, {Person(), Body()}, LoadSettings());
  ASSERT_TRUE(result.forces.com_minus_mvn);
  EXPECT_NEAR(result.forces.com_minus_mvn->z(), -0.02, 1e-4);
  EXPECT_TRUE(result.forces.com_disagrees);
  LoadSubject laden{Person(), Body()};
  laden.has_added_masses = true;
  EXPECT_FALSE(estimator.Update(sample, links, laden, LoadSettings()).forces.com_minus_mvn);
}

TEST(LoadEstimator, ComputesTheMarginOfStabilityFromTheMovingCentreOfMass) {
  const LinkPoses links = Posed({});
  BodyMotion still;
  BodySample sample = SampleOf(links, 1, &still);
  for (SegmentState& segment : sample.segments) segment.velocity = {0.2, 0, 0};
  LoadEstimator estimator;
  const BodyForces& forces =
      estimator.Update(sample, links, {Person(), Body()}, LoadSettings()).forces;
  ASSERT_TRUE(forces.margin_of_stability);
  const double xcom = 0.0020 + 0.2 * std::sqrt(1.0079 / kGravity);
  EXPECT_NEAR(forces.extrapolated_com->x(), xcom, kPointTolerance);
  EXPECT_NEAR(*forces.margin_of_stability, xcom + 0.045, 2e-4) << "to the heels";
}

TEST(LoadSettings, AreRejectedWithTheReason) {
  EXPECT_EQ(FindDefect(LoadSettings()), "");
  LoadSettings settings;
  settings.hands = Held(500);
  EXPECT_THAT(FindDefect(settings), HasSubstr("500 kg in the right hand"));
  settings = {};
  settings.strength.factor = 0;
  EXPECT_THAT(FindDefect(settings), HasSubstr("capacity factor 0"));
  settings = {};
  settings.motion.cutoff_hz = std::nan("");
  EXPECT_THAT(FindDefect(settings), HasSubstr("nan: expected 1 to 30 Hz"));
  settings = {};
  settings.meter.up = {0.7, 0.6};
  EXPECT_THAT(FindDefect(settings), HasSubstr("class limits"));
}

// Flight, wrong floors and unbalanced motion would all show here; so would a filter that lags.
TEST(LoadEstimator, KeepsTheCentreOfPressureOfTheWalkUnderTheStandingFoot) {
  const auto motion = subject::MakeMotion("walk");
  for (const int rate : {60, 120, 240}) {
    LoadEstimator estimator;
    int single = 0;
    for (int i = 0; i < 9 * rate; ++i) {  // more than a lap
      const BodySample sample = motion->At(static_cast<double>(i) / rate);
      const LoadResult& result =
          estimator.Update(sample, LinkPosesOf(sample), {Person(), Body()}, LoadSettings());
      const BodyForces& forces = result.forces;
      ASSERT_EQ(forces.why_no_ground, "") << "at " << i << " of " << rate << " Hz";
      ASSERT_TRUE(forces.is_dynamic) << forces.why_static;
      if (i < rate / 2) continue;  // the filter began at rest
      if (forces.feet[kRight].touches_floor == forces.feet[kLeft].touches_floor) continue;
      ++single;
      ASSERT_GT(forces.cop_inside, 0.005) << "at " << i << " of " << rate << " Hz";
    }
    EXPECT_GT(single, 4 * rate) << "walks mostly on one foot";
  }
}

struct Turning {
  double angle = 0, rate = 0, change = 0;  // rad, rad/s, rad/s^2
};
using Motion = std::function<Turning(double secs)>;

Motion SwingOf(double hz) {
  return [omega = 2 * M_PI * hz](double secs) {
    const double amplitude = 0.7, phase = omega * secs;
    return Turning{amplitude * std::sin(phase), amplitude * omega * std::cos(phase),
                   -amplitude * omega * omega * std::sin(phase)};
  };
}

// As fast as a kick: up and down by 70 degrees within 0.35 s, up to 9 rad/s and 190 rad/s^2.
Turning Kick(double secs) {
  const double amplitude = 1.22, width = 0.08, at = (secs - 2) / width;
  const double bump = amplitude * std::exp(-at * at / 2);
  return {bump, -bump * at / width, bump * (at * at - 1) / (width * width)};
}

// The right arm turns about the shoulder: the motion is known exactly.
BodySample TurnAt(double secs, const Motion& motion) {
  const Turning turning = motion(secs);
  const Quaterniond turn = Ry(turning.angle * 180 / M_PI);
  const LinkPoses links =
      Posed({{kRightUpperArm, turn}, {kRightForeArm, turn}, {kRightHand, turn}});
  BodySample sample = SampleOf(links, 1 + std::llround(1e9 * secs));
  sample.has_linear = sample.has_angular = true;
  const Vector3d rate(0, turning.rate, 0), change(0, turning.change, 0);
  for (const int i : {int(kRightUpperArm), int(kRightForeArm), int(kRightHand)}) {
    SegmentState& segment = sample.segments[urdf::At(i)];
    const Vector3d arm = links[urdf::At(i)].position - links[kRightUpperArm].position;
    segment.velocity = rate.cross(arm);
    segment.acceleration = change.cross(arm) + rate.cross(rate.cross(arm));
    segment.angular_velocity = rate;
    segment.angular_acceleration = change;
  }
  return sample;
}

// Largest errors of the shoulder's moment, relative to its largest dynamic part.
struct LagErrors {
  double zero_phase = 0, causal = 0, causal_when_delayed = 0;
};

LagErrors ErrorsOf(const Motion& motion, double rate_hz) {
  const LoadSubject subject{Person(), Body()};
  const LoadSettings settings = Unclamped();
  LoadSettings at_rest = settings;
  at_rest.motion.dynamic = false;
  ZeroPhaseFilter filter(settings.motion.recording_cutoff_hz);
  const int count = static_cast<int>(4 * rate_hz);
  std::vector<BodySample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(TurnAt(i / rate_hz, motion));
    filter.Add(samples.back());
  }
  filter.End();
  LoadEstimator with_truth, with_zero_phase, with_causal, static_only;
  const auto moment = [](const LoadResult& result) {
    return result.forces.joints[jRightShoulder].moment.y();
  };
  std::vector<double> truth, causal;
  LagErrors errors;
  double dynamic_part = 0, delay_secs = 0;
  for (int i = 0; i < count; ++i) {
    const BodySample& sample = samples[static_cast<std::size_t>(i)];
    const LinkPoses links = LinkPosesOf(sample);
    BodyMotion exact;
    for (std::size_t s = 0; s < exact.size(); ++s) {
      exact[s] = {sample.segments[s].acceleration, sample.segments[s].angular_velocity,
                  sample.segments[s].angular_acceleration};
    }
    const double now = moment(with_truth.Update(sample, links, subject, settings, {}, &exact));
    const double smooth = moment(with_zero_phase.Update(
        sample, links, subject, settings, {}, &filter.ready()[static_cast<std::size_t>(i)]));
    const LoadResult& live = with_causal.Update(sample, links, subject, settings);
    delay_secs = live.forces.delay_secs;
    truth.push_back(now);
    causal.push_back(moment(live));
    const double rest = moment(static_only.Update(sample, links, subject, at_rest));
    if (i < rate_hz || i > count - rate_hz) continue;
    dynamic_part = std::max(dynamic_part, std::abs(now - rest));
    errors.zero_phase = std::max(errors.zero_phase, std::abs(smooth - now));
  }
  const auto late = static_cast<int>(std::lround(delay_secs * rate_hz));
  for (int i = static_cast<int>(rate_hz); i < count; ++i) {
    const double is = causal[static_cast<std::size_t>(i)];
    errors.causal = std::max(errors.causal, std::abs(is - truth[static_cast<std::size_t>(i)]));
    errors.causal_when_delayed = std::max(errors.causal_when_delayed,
                                          std::abs(is - truth[static_cast<std::size_t>(i - late)]));
  }
  return {errors.zero_phase / dynamic_part, errors.causal / dynamic_part,
          errors.causal_when_delayed / dynamic_part};
}

TEST(LoadEstimator, HasNoLagInRecordingsAndAKnownOneInStreams) {
  for (const double rate_hz : {60.0, 240.0}) {
    for (const double hz : {1.0, 2.0}) {
      const LagErrors errors = ErrorsOf(SwingOf(hz), rate_hz);
      EXPECT_LT(errors.zero_phase, 0.02) << hz << " Hz at " << rate_hz;
      EXPECT_LT(errors.causal_when_delayed, hz == 1 ? 0.06 : 0.16) << hz << " Hz at " << rate_hz;
      EXPECT_GT(errors.causal, errors.causal_when_delayed);
    }
    const LagErrors kick = ErrorsOf(Kick, rate_hz);
    EXPECT_LT(kick.zero_phase, 0.02) << "at " << rate_hz;
    EXPECT_LT(kick.causal_when_delayed, 0.16) << "at " << rate_hz;
  }
}

// The same samples give the same loads, whoever else looked at them.
TEST(LoadEstimator, DependsOnTheSamplesOnly) {
  const auto motion = subject::MakeMotion("lift");
  LoadEstimator one, two;
  for (int i = 0; i < 240; ++i) {
    const BodySample sample = motion->At(i / 60.0);
    const LinkPoses links = LinkPosesOf(sample);
    const LoadResult a = one.Update(sample, links, {Person(), Body()}, LoadSettings());
    const LoadResult& b = two.Update(sample, links, {Person(), Body()}, LoadSettings());
    for (std::size_t j = 0; j < a.loads.size(); ++j) {
      ASSERT_EQ(a.loads[j].ratio, b.loads[j].ratio);
      ASSERT_EQ(a.loads[j].load_class, b.loads[j].load_class);
    }
  }
}

}  // namespace
}  // namespace kinescope::loads::testing
