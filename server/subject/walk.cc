// Walking on a circle about the world's origin, counter-clockwise. Feet roll over heel, ball and
// toe tip: in stance the foot's place follows from whichever point is on the floor; in swing it
// glides from the last footprint's motion into the next one's, and is lifted.
#include <array>

#include "server/subject/curve.h"
#include "server/subject/motions.h"

namespace kinescope::subject {
namespace {

using Eigen::Vector3d;
using urdf::Side;

constexpr double kRadius = 1.5;    // m, of the path of the pelvis
constexpr double kSpeed = 1.2;     // m/s along it
constexpr int kStridesPerLap = 7;  // whole, so that every lap treads in the same footprints
constexpr double kLapSecs = 2 * M_PI * kRadius / kSpeed;
constexpr double kStrideSecs = kLapSecs / kStridesPerLap;
constexpr double kHalfTrack = 0.050;  // of the ankles, m
constexpr double kToeOut = 6 * kDegree;
constexpr double kToeOff = 0.62;      // phases of a stride, which begins at heel strike
constexpr double kPassing = 0.222;    // when the pelvis is above the ankle
constexpr double kSwingLift = 0.086;  // m
// Into the turn, as a rider leans: tan = v^2 / (g r). The feet are that much farther out.
constexpr double kTanOfBank = kSpeed * kSpeed / (9.81 * kRadius);
constexpr double kPelvisHeight = 0.945;  // m, mean

// How the pelvis runs ahead of the steady walk, and inwards of the path, in harmonics of a stride,
// m. Fitted so that the walk is one that a body could do: the centre of pressure that the motion
// requires runs along the standing foot, from 0.4 to 0.8 of its length, and changes over while
// both are down. The test is in tests/server/loads/load_estimator_test.cc.
struct Harmonic {
  double cos, sin;
};
constexpr std::array<Harmonic, 7> kSurge = {{{0, 0},
                                             {0.00692, -0.00064},
                                             {-0.00535, 0.02097},
                                             {0.00072, -0.00003},
                                             {0.00075, 0.00081},
                                             {-0.00007, 0.00003},
                                             {0.00076, 0.00088}}};
constexpr std::array<Harmonic, 7> kSway = {{{0.00114, 0.00000},
                                            {0.00308, -0.02755},
                                            {0.00289, 0.00205},
                                            {0.00004, -0.00098},
                                            {0.00002, -0.00027},
                                            {0.00008, -0.00029},
                                            {0.00013, -0.00001}}};

Jet SumOf(const std::array<Harmonic, 7>& harmonics, const Jet& phase) {
  Jet sum = 0.0;
  for (std::size_t k = 0; k < harmonics.size(); ++k) {
    const Jet angle = static_cast<double>(k) * phase;
    sum += harmonics[k].cos * cos(angle) + harmonics[k].sin * sin(angle);
  }
  return sum;
}

struct FootPose {
  JetVector ankle;
  JetQuaternion foot;
  JetQuaternion toe;
};

// One footprint: where the flat foot's ankle is, and where it points.
struct Footprint {
  JetVector ankle;
  Jet yaw;
};

class Walk final : public MotionGenerator {
 public:
  explicit Walk(const urdf::Skeleton& skeleton)
      : skeleton_(skeleton), scale_(skeleton.height / urdf::kReferenceHeight) {}

  double period_secs() const override { return 2 * kLapSecs; }  // a quaternion's way round
  Posture PoseAt(const Jet& time) const override;

 private:
  JetVector OnCircle(const Jet& angle, const Jet& left, const Jet& height) const;
  void PlaceTrunk(const Jet& time, Posture& posture) const;
  void PlaceArm(Side side, const Jet& phase, Posture& posture) const;
  void PlaceLeg(Side side, const Jet& time, Posture& posture) const;
  Footprint FootprintOf(Side side, double stride) const;
  JetVector AnkleOnHeel(Side side, const Footprint& print, const Jet& pitch) const;
  JetVector AnkleOnToes(Side side, const Footprint& print, const Jet& pitch,
                        const Jet& toe_pitch) const;
  FootPose FootAt(Side side, const Jet& strides) const;

  const urdf::Skeleton& skeleton_;
  double scale_;

  // Degrees over one stride; positive: heel up. Both are 0, and the foot flat, from 0.09 to 0.30.
  // clang-format off
  const Curve foot_pitch_{1, {{0.00, -20}, {0.09, 0}, {0.30, 0}, {0.40, 3}, {0.48, 11}, {0.54, 25},
                              {0.60, 48}, {0.65, 59}, {0.885, -13}, {0.95, -21}}};
  const Curve toe_pitch_{1, {{0.00, -22}, {0.09, 0}, {0.48, 0}, {0.55, 8}, {0.61, 25},
                             {0.66, 33}, {0.875, -18}, {0.95, -25}}};
  // clang-format on
};

// Angle of the pelvis about the middle of the circle; it is 0 on the -y side, heading +x.
Jet HeadingAt(const Jet& time) { return 2 * M_PI / kLapSecs * time; }

// Stride phase of one leg, counted on and on; the right heel strikes at 0.
Jet StridesOf(Side side, const Jet& time) {
  return time / kStrideSecs + (side == urdf::kRight ? 0.0 : 0.5);
}

JetVector Walk::OnCircle(const Jet& angle, const Jet& left, const Jet& height) const {
  const Jet radius = kRadius - left;
  return Jet(scale_) * JetVector(radius * sin(angle), -radius * cos(angle), height);
}

Posture Walk::PoseAt(const Jet& time) const {
  Posture posture(skeleton_);
  PlaceTrunk(time, posture);
  for (const Side side : {urdf::kRight, urdf::kLeft}) {
    PlaceLeg(side, time, posture);
    PlaceArm(side, 2 * M_PI * StridesOf(side, time), posture);
  }
  // Walkers look where they will be in a step or two.
  posture.LookAt(OnCircle(HeadingAt(time) + 1.0, 0.0, 1.35), 0.8);
  return posture;
}

void Walk::PlaceTrunk(const Jet& time, Posture& posture) const {
  const Jet phase = 2 * M_PI * StridesOf(urdf::kRight, time);
  const Jet heading = HeadingAt(time);
  // Lowest and fastest in double support, swaying over the standing leg, leaning into the turn.
  const Jet surge = 1.0 / kRadius * SumOf(kSurge, phase);
  const Jet sway = SumOf(kSway, phase);
  const Jet height = kPelvisHeight - 0.018 * cos(2.0 * (phase - 0.05));
  const Jet yaw = 5 * kDegree * cos(phase);          // the leg in front takes its hip along
  const Jet roll = -3 * kDegree * sin(phase);        // the hip of the swinging leg drops
  const double lean = -0.7 * std::atan(kTanOfBank);  // to the left; the spine adds to it
  posture.PlacePelvis(OnCircle(heading + surge, sway, height),
                      TurnZ(heading + yaw) * TurnX(lean + roll) * TurnY(4 * kDegree));
  // The spine undoes the pelvis' roll and more than undoes its yaw: shoulders turn against hips.
  constexpr std::array<int, 4> kSpine = {urdf::kL5, urdf::kL3, urdf::kT12, urdf::kT8};
  constexpr std::array<double, 4> kTurnShare = {0.10, 0.20, 0.30, 0.40};
  const Jet counter = -10 * kDegree * cos(phase - 0.15);
  const Jet nod = 1.5 * kDegree * cos(2.0 * phase);
  for (std::size_t i = 0; i < kSpine.size(); ++i) {
    posture.Turn(kSpine[i], TurnZ(kTurnShare[i] * counter) * TurnX(0.10 * lean - 0.30 * roll) *
                                TurnY(0.25 * nod + 0.3 * kDegree));
  }
}

// `phase` is that of the leg of the same side: the arm is back when that leg is in front.
void Walk::PlaceArm(Side side, const Jet& phase, Posture& posture) const {
  const double left = side == urdf::kLeft ? 1 : -1;
  const int girdle = side == urdf::kRight ? urdf::kRightShoulder : urdf::kLeftShoulder;
  const Jet swing = -cos(phase - 0.1);
  const Jet flexion = kDegree * (3.0 + 20.0 * swing);
  const Jet elbow = kDegree * (24.0 + 13.0 * -cos(phase - 0.45));
  posture.Turn(girdle, TurnZ(-left * kDegree * (2.0 + 4.0 * swing)));
  posture.Turn(girdle + 1,
               TurnY(-flexion) * TurnX(left * 7 * kDegree) * TurnZ(-left * 10 * kDegree));
  posture.Turn(girdle + 2, TurnY(-elbow) * TurnZ(-left * 12 * kDegree));
  posture.Turn(girdle + 3, TurnY(-4 * kDegree) * TurnX(-left * 5 * kDegree));
}

void Walk::PlaceLeg(Side side, const Jet& time, Posture& posture) const {
  const int foot = side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot;
  const double outwards = side == urdf::kRight ? -1 : 1;
  const FootPose pose = FootAt(side, StridesOf(side, time));
  posture.ReachWithLeg(side, pose.ankle, HeadingAt(time) + outwards * 0.5 * kToeOut);
  posture.Orient(foot, pose.foot);
  posture.Orient(foot + 1, pose.toe);
}

Footprint Walk::FootprintOf(Side side, double stride) const {
  const double outwards = side == urdf::kRight ? -1 : 1;
  const double passing = kPassing + stride - (side == urdf::kRight ? 0.0 : 0.5);
  const double heading = HeadingAt(passing * kStrideSecs).value;
  JetVector ankle = OnCircle(heading, outwards * kHalfTrack - kPelvisHeight * kTanOfBank, 0.0);
  ankle.z() = -skeleton_.heel_in_foot[side].z();
  return {ankle, heading + outwards * kToeOut};
}

JetVector Walk::AnkleOnHeel(Side side, const Footprint& print, const Jet& pitch) const {
  const JetVector heel = Constant(skeleton_.heel_in_foot[side]);
  return print.ankle + TurnZ(print.yaw) * JetVector(heel - TurnY(pitch) * heel);
}

JetVector Walk::AnkleOnToes(Side side, const Footprint& print, const Jet& pitch,
                            const Jet& toe_pitch) const {
  const int toe = side == urdf::kRight ? urdf::kRightToe : urdf::kLeftToe;
  const JetVector ball = Constant(skeleton_.origin_in_parent[static_cast<std::size_t>(toe)]);
  const JetVector tip = Constant(skeleton_.toe_tip_in_toe[side]);
  return print.ankle +
         TurnZ(print.yaw) * JetVector(ball + tip - TurnY(toe_pitch) * tip - TurnY(pitch) * ball);
}

FootPose Walk::FootAt(Side side, const Jet& strides) const {
  const double stride = std::floor(strides.value);
  const Jet phase = strides - stride;
  const Jet pitch = kDegree * foot_pitch_.At(phase);
  const Jet toe_pitch = kDegree * toe_pitch_.At(phase);
  const Footprint print = FootprintOf(side, stride);
  const auto pose = [&](const JetVector& ankle, const Jet& yaw) -> FootPose {
    return {ankle, TurnZ(yaw) * TurnY(pitch), TurnZ(yaw) * TurnY(toe_pitch)};
  };
  // While the foot is flat both formulas give the same place, so the change over is seamless.
  constexpr double kFlat = 0.20;
  if (phase.value < kFlat) return pose(AnkleOnHeel(side, print, pitch), print.yaw);
  const JetVector leaving = AnkleOnToes(side, print, pitch, toe_pitch);
  if (phase.value <= kToeOff) return pose(leaving, print.yaw);

  const Footprint next = FootprintOf(side, stride + 1);
  const JetVector landing = AnkleOnHeel(side, next, pitch);
  const Jet swing = (phase - kToeOff) / (1 - kToeOff);
  const Jet moved = GlideStep(swing, 0.32);
  const Jet arc = 4.0 * swing * (1.0 - swing);  // cubed: starts and ends without acceleration
  JetVector ankle = leaving + moved * JetVector(landing - leaving);
  ankle.z() += scale_ * kSwingLift * arc * arc * arc;
  return pose(ankle, print.yaw + moved * (next.yaw - print.yaw));
}

}  // namespace

std::unique_ptr<MotionGenerator> MakeWalk(const urdf::Skeleton& skeleton) {
  return std::make_unique<Walk>(skeleton);
}

}  // namespace kinescope::subject
