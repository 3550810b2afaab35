// Physics that must hold for any body in any motion: joint-loads.md 6.13 and 2.2.
#include "server/loads/inverse_dynamics.h"

#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

constexpr int kTrials = 200;

ExternalForces RandomHands(Random& random, const LinkPoses& links) {
  ExternalForces hands;
  for (const int hand : {kRightHand, kLeftHand}) {
    hands.Push(links, hand, random.Vector(50), links[urdf::At(hand)].position + random.Vector(0.2),
               random.Vector(5));
  }
  return hands;
}

// The ground as a wrench on the right foot: what is pushed where does not matter to the sum.
void PushGround(const LinkPoses& links, const Wrench& ground, ExternalForces& external) {
  external.Push(links, kRightFoot, ground.force, Vector3d::Zero(), ground.moment);
}

TEST(InverseDynamics, HasNoResidualWithTheRequiredGroundReactionForce) {
  Random random(1);
  for (int trial = 0; trial < kTrials; ++trial) {
    const LinkPoses links = random.Pose();
    const BodyDemand demand = DemandOf(links, random.Motion(), Body());
    ExternalForces external = RandomHands(random, links);
    PushGround(links, RequiredGroundWrench(links, demand, external), external);
    const Wrench root = SolveJoints(links, demand, external)[kPelvis];
    EXPECT_LT(root.force.norm(), 1e-9);
    EXPECT_LT(root.moment.norm(), 1e-9);
  }
}

// Virtual work, statically: a small turn of everything beyond one joint, against gravity and the
// hands, takes as much work as the joint's moment does.
TEST(InverseDynamics, AgreesWithVirtualWork) {
  Random random(2);
  for (int trial = 0; trial < kTrials; ++trial) {
    const LinkPoses links = random.Pose();
    const Vector3d pull = random.Vector(50);
    const auto grip = [&](const LinkPoses& posed) -> Vector3d {
      return posed[kRightHand].position + posed[kRightHand].orientation * Vector3d(0, 0.01, -0.08);
    };
    ExternalForces hands;
    hands.Push(links, kRightHand, pull, grip(links));
    const JointWrenches joints = SolveJoints(links, DemandOf(links, {}, Body()), hands);
    const int joint = trial % kJointCount;
    if (joint >= jRightHip) continue;  // no ground here
    const std::size_t child = urdf::At(ChildOf(joint));
    const Vector3d axis = random.Vector(1).normalized();
    constexpr double kStep = 1e-5;  // rad
    const auto energy = [&](double angle) {
      const Quaterniond turn(AngleAxisd(angle, axis));
      LinkPoses turned = links;
      for (int i = 0; i < kSegmentCount; ++i) {
        int above = i;
        while (above > 0 && urdf::At(above) != child) above = kSegments[urdf::At(above)].parent;
        if (urdf::At(above) != child) continue;
        const Vector3d& center = links[child].position;
        turned[urdf::At(i)] = {center + turn * (links[urdf::At(i)].position - center),
                               turn * links[urdf::At(i)].orientation};
      }
      const BodyDemand demand = DemandOf(turned, {}, Body());
      double sum = -pull.dot(grip(turned));
      for (const SegmentDemand& segment : demand) sum += segment.force.dot(segment.com);
      return sum;
    };
    const double work = (energy(kStep) - energy(-kStep)) / (2 * kStep);
    EXPECT_NEAR(joints[child].moment.dot(axis), work, 1e-5) << kJoints[urdf::At(joint)].mvn_name;
  }
}

// A motion with known derivatives: every segment a free rigid body that turns steadily about an
// axis of its own while its origin is thrown. Momentum by differences must be what DemandOf says.
TEST(InverseDynamics, MatchesTheChangeOfMomentum) {
  Random random(3);
  for (int trial = 0; trial < kTrials; ++trial) {
    const LinkPoses links = random.Pose();
    const BodyMotion motion = random.Motion();
    std::array<Vector3d, kSegmentCount> velocities;
    for (Vector3d& velocity : velocities) velocity = random.Vector(2);
    // Momentum, linear and angular about the world's origin, `t` after the moment of `links`.
    const auto momentum = [&](double t) {
      Wrench sum;
      for (std::size_t i = 0; i < links.size(); ++i) {
        const SegmentMotion& m = motion[i];
        // Turned by the rotation vector w t + a t^2 / 2; at t near 0 its rate is w + a t, up to a
        // term in (w x a) t^2.
        const Vector3d turn = m.angular_velocity * t + 0.5 * m.angular_acceleration * t * t;
        const Vector3d rate = m.angular_velocity + m.angular_acceleration * t;
        const Quaterniond now =
            Quaterniond(AngleAxisd(
                turn.norm(), turn.norm() > 0 ? Vector3d(turn.normalized()) : Vector3d::UnitX())) *
            links[i].orientation;
        const Vector3d arm = now * Body()[i].com_in_link;
        const Vector3d velocity = velocities[i] + m.acceleration * t + rate.cross(arm);
        const Vector3d com =
            links[i].position + velocities[i] * t + 0.5 * m.acceleration * t * t + arm;
        const Vector3d spin = now * (Body()[i].inertia_about_com * (now.conjugate() * rate));
        sum.force += Body()[i].mass * velocity;
        sum.moment += com.cross(Body()[i].mass * velocity) + spin;
      }
      return sum;
    };
    constexpr double kStep = 1e-5;
    const Wrench before = momentum(-kStep), after = momentum(kStep);
    const BodyDemand demand = DemandOf(links, motion, Body());
    Wrench sum;
    for (std::size_t i = 0; i < demand.size(); ++i) {
      const Vector3d weight(0, 0, Body()[i].mass * kGravity);
      sum.force += demand[i].force - weight;
      sum.moment += demand[i].com.cross(demand[i].force - weight) + demand[i].spin;
    }
    EXPECT_LT(((after.force - before.force) / (2 * kStep) - sum.force).norm(), 1e-5);
    EXPECT_LT(((after.moment - before.moment) / (2 * kStep) - sum.moment).norm(), 1e-5);
  }
}

TEST(InverseDynamics, NeedsNoForcesInFreeFall) {
  BodyMotion falling;
  for (SegmentMotion& segment : falling) segment.acceleration = {0, 0, -kGravity};
  Random random(4);
  const LinkPoses links = random.Pose();
  for (const Wrench& joint :
       SolveJoints(links, DemandOf(links, falling, Body()), ExternalForces())) {
    EXPECT_LT(joint.force.norm(), 1e-12);
    EXPECT_LT(joint.moment.norm(), 1e-12);
  }
}

TEST(InverseDynamics, DoublesWithTheMasses) {
  BodyDescription heavy;
  heavy.mass_kg = 150;
  const BodyParameters doubled = MakeBodyParameters(heavy, Person());
  Random random(5);
  const LinkPoses links = random.Pose();
  const BodyMotion motion = random.Motion();
  const JointWrenches one = SolveJoints(links, DemandOf(links, motion, Body()), {});
  const JointWrenches two = SolveJoints(links, DemandOf(links, motion, doubled), {});
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_LT((2 * one[i].force - two[i].force).norm(), 1e-9);
    EXPECT_LT((2 * one[i].moment - two[i].moment).norm(), 1e-9);
  }
}

TEST(InverseDynamics, LimitsImpossibleAccelerations) {
  const LinkPoses links = Posed({});
  BodyMotion motion;
  motion[kRightToe].acceleration = {300, 0, 0};
  motion[kHead].acceleration = {20, 0, 0};
  const BodyDemand demand = DemandOf(links, motion, Body(), 30);
  const double toe = Body()[kRightToe].mass, head = Body()[kHead].mass;
  EXPECT_LT((demand[kRightToe].force - toe * Vector3d(30, 0, kGravity)).norm(), 1e-9);
  EXPECT_LT((demand[kHead].force - head * Vector3d(20, 0, kGravity)).norm(), 1e-9);
}

}  // namespace
}  // namespace kinescope::loads::testing
