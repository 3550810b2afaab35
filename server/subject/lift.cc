// Lifting a box: down, up to the chest, out to the left, back, down again. Every channel below is a
// schedule in seconds of the 8 s period; channels of one movement start and end at slightly
// different times, as those of a person do (knees before trunk, right hand before left).
#include "server/subject/curve.h"
#include "server/subject/motions.h"

namespace kinescope::subject {
namespace {

using Eigen::Vector3d;
using urdf::Side;

constexpr double kPeriodSecs = 8;

constexpr double kGripHalfWidth = 0.16;
constexpr double kGripBelowWrist = 0.080;
constexpr double kToeIn = 12 * kDegree;  // of the hands round the box

struct LiftStance {
  double x, y, toe_out;
  double knee_out;  // share of knees_out_; the right leg, which carries more, gives way less
};
constexpr std::array<LiftStance, 2> kStance = {
    {{-0.03, -0.120, -25 * kDegree, 0.8}, {0.03, 0.120, 22 * kDegree, 1.2}}};

Curve Schedule(std::vector<Curve::Key> keys) { return {kPeriodSecs, std::move(keys)}; }

class Lift final : public MotionGenerator {
 public:
  explicit Lift(const urdf::Skeleton& skeleton)
      : skeleton_(skeleton), scale_(skeleton.height / urdf::kReferenceHeight) {}

  double period_secs() const override { return kPeriodSecs; }
  Posture PoseAt(const Jet& time) const override;

 private:
  void PlaceTrunk(const Jet& time, Posture& posture) const;
  void PlaceLeg(Side side, const Jet& time, Posture& posture) const;
  void PlaceArm(Side side, const Jet& time, Posture& posture) const;
  JetVector BoxAt(const Jet& time) const;

  const urdf::Skeleton& skeleton_;
  double scale_;

  // Metres and degrees at seconds. clang-format would put one key on a line.
  // clang-format off
  const Curve pelvis_x_ = Schedule({{0.1, 0.02}, {1.5, -0.235}, {2.0, -0.225}, {3.2, 0.0},
                                    {3.9, -0.01}, {4.6, -0.01}, {5.1, 0.0}, {6.3, -0.225},
                                    {6.65, -0.235}, {7.75, 0.02}});
  const Curve pelvis_y_ = Schedule({{0.1, 0.0}, {1.5, -0.035}, {2.0, -0.035}, {3.2, 0.0},
                                    {3.9, 0.02}, {4.6, 0.025}, {5.1, 0.0}, {6.3, -0.03},
                                    {6.65, -0.03}, {7.75, 0.0}});
  const Curve pelvis_z_ = Schedule({{0.1, 0.975}, {1.5, 0.500}, {1.95, 0.485}, {3.1, 0.965},
                                    {5.0, 0.965}, {6.3, 0.495}, {6.6, 0.490}, {7.7, 0.975}});
  const Curve pelvis_pitch_ = Schedule({{0.1, 2}, {1.4, 37}, {2.0, 38}, {3.2, 2}, {3.9, 13},
                                        {4.6, 13}, {5.1, 2}, {6.25, 39}, {6.65, 38}, {7.75, 2}});
  const Curve pelvis_yaw_ = Schedule({{0.1, 0}, {1.6, -3}, {2.0, -2}, {3.1, 0}, {3.9, 12},
                                      {4.5, 12}, {5.2, 0}, {6.3, 2}, {6.65, 1}, {7.75, 0}});
  const Curve spine_flexion_ = Schedule({{0.1, 2}, {1.5, 50}, {2.05, 48}, {3.35, 0}, {3.9, 25},
                                         {4.6, 25}, {5.1, 0}, {6.25, 50}, {6.7, 46}, {7.8, 2}});
  const Curve spine_bend_ = Schedule({{0.1, 0}, {1.6, 3}, {2.0, 2}, {3.1, -1}, {3.9, -3}, {4.5, -3},
                                      {5.2, 0}, {6.3, 2}, {7.75, 0}});
  const Curve spine_turn_ = Schedule({{0.1, 0}, {1.6, -4}, {2.0, -2}, {3.1, 0}, {3.95, 20},
                                      {4.5, 20}, {5.2, 0}, {6.3, 3}, {7.75, 0}});
  const Curve girdle_forward_ = Schedule({{0.2, 0}, {1.6, 14}, {2.0, 14}, {3.3, 6}, {3.9, 16},
                                          {4.5, 16}, {5.1, 6}, {6.3, 14}, {6.65, 14}, {7.7, 0}});
  const Curve girdle_up_ = Schedule({{0.2, 0}, {1.6, 0}, {3.3, 4}, {3.9, 12}, {4.5, 12}, {5.1, 4},
                                     {6.3, 0}, {7.7, 0}});

  // Middle between both grips: bearing, and distance from where the person stands.
  const Curve box_reach_ = Schedule({{0.1, 0.45}, {2.0, 0.45}, {2.7, 0.44}, {3.15, 0.42},
                                     {3.95, 0.845}, {4.6, 0.845}, {5.15, 0.42}, {5.7, 0.43},
                                     {6.3, 0.45}});
  const Curve box_turn_ = Schedule({{0.1, 0}, {3.1, 0}, {3.95, 30}, {4.55, 30}, {5.25, 0}});
  const Curve box_z_ = Schedule({{0.1, 0.15}, {1.95, 0.15}, {3.1, 1.08}, {3.4, 1.12}, {3.95, 1.40},
                                 {4.55, 1.40}, {5.05, 1.10}, {6.4, 0.15}});
  const Curve hands_on_box_ = Schedule({{1.05, 0}, {1.75, 1}, {6.5, 1}, {7.0, 0}});
  // The hand's pitch: 0 fingers down, -90 fingers forward.
  const Curve hand_pitch_ = Schedule({{0.1, -20}, {0.6, -40}, {1.6, -42}, {2.0, -45}, {2.8, -68}, {3.2, -95},
                                      {3.95, -106}, {4.55, -106}, {5.05, -95}, {5.5, -65},
                                      {6.3, -48}, {6.6, -44}, {7.25, -40}, {7.75, -20}});
  // Arms reach between the knees, which give way to the sides; on the way, hands are before them.
  const Curve elbow_swivel_ = Schedule({{0.2, 12}, {1.0, -6}, {1.9, -9}, {2.3, -10}, {2.45, -10},
                                        {3.2, 20}, {4.0, 12}, {4.55, 12}, {5.1, 20}, {5.8, -10},
                                        {6.1, -10}, {6.5, -8}, {6.9, -6}, {7.6, 12}});
  const Curve knees_out_ = Schedule({{0.1, 0}, {0.8, 11}, {1.9, 11}, {2.25, 15}, {2.4, 15},
                                     {3.1, 0}, {5.2, 0}, {5.85, 15}, {6.1, 15}, {6.5, 11},
                                     {7.1, 11}, {7.7, 0}});
  const Curve hands_ahead_ = Schedule({{0.15, 0}, {0.65, 1}, {7.2, 1}, {7.75, 0}});
  const Curve looks_at_box_ = Schedule({{0.0, 0}, {0.8, 1}, {6.9, 1}, {7.8, 0}});
  // clang-format on
};

Posture Lift::PoseAt(const Jet& time) const {
  Posture posture(skeleton_);
  PlaceTrunk(time, posture);
  for (const Side side : {urdf::kRight, urdf::kLeft}) {
    PlaceLeg(side, time, posture);
    PlaceArm(side, time, posture);
  }
  const JetVector ahead = Constant(scale_ * Vector3d(3.0, 0.0, 1.2));
  const Jet to_box = looks_at_box_.At(time);
  posture.LookAt(ahead + to_box * JetVector(BoxAt(time) - ahead), 0.8);
  return posture;
}

void Lift::PlaceTrunk(const Jet& time, Posture& posture) const {
  const JetVector pelvis(pelvis_x_.At(time), pelvis_y_.At(time), pelvis_z_.At(time));
  posture.PlacePelvis(Jet(scale_) * pelvis, TurnZ(kDegree * pelvis_yaw_.At(time)) *
                                                TurnY(kDegree * pelvis_pitch_.At(time)));
  // Shares of the lumbar spine (first three) and the thorax: flexion is lumbar, turning thoracic.
  constexpr std::array<int, 4> kSpine = {urdf::kL5, urdf::kL3, urdf::kT12, urdf::kT8};
  constexpr std::array<double, 4> kFlexionShare = {0.30, 0.26, 0.26, 0.18};
  constexpr std::array<double, 4> kTurnShare = {0.10, 0.20, 0.30, 0.40};
  for (std::size_t i = 0; i < kSpine.size(); ++i) {
    posture.Turn(kSpine[i], TurnZ(kTurnShare[i] * kDegree * spine_turn_.At(time)) *
                                TurnY(kFlexionShare[i] * kDegree * spine_flexion_.At(time)) *
                                TurnX(0.25 * kDegree * spine_bend_.At(time)));
  }
}

void Lift::PlaceLeg(Side side, const Jet& time, Posture& posture) const {
  const LiftStance& stance = kStance[side];
  const int foot = side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot;
  const JetVector ankle =
      Constant({scale_ * stance.x, scale_ * stance.y, -skeleton_.heel_in_foot[side].z()});
  posture.ReachWithLeg(side, ankle, stance.toe_out,
                       stance.knee_out * kDegree * knees_out_.At(time));
  posture.Orient(foot, TurnZ(stance.toe_out));
  posture.Orient(foot + 1, TurnZ(stance.toe_out));
}

JetVector Lift::BoxAt(const Jet& time) const {
  const JetQuaternion bearing = TurnZ(kDegree * box_turn_.At(time));
  return Jet(scale_) * (bearing * JetVector(box_reach_.At(time), 0.0, box_z_.At(time)));
}

void Lift::PlaceArm(Side side, const Jet& time, Posture& posture) const {
  const double left = side == urdf::kLeft ? 1 : -1;
  const int girdle = side == urdf::kRight ? urdf::kRightShoulder : urdf::kLeftShoulder;
  posture.Turn(girdle, TurnZ(-left * kDegree * girdle_forward_.At(time)) *
                           TurnX(left * kDegree * girdle_up_.At(time)));

  // The right hand is a little earlier on the way to the box; both let go together.
  const Jet own_time = time + (side == urdf::kRight ? 0.05 : 0.0);
  const JetQuaternion bearing = TurnZ(kDegree * box_turn_.At(time));
  const Jet on_box = hands_on_box_.At(own_time);
  const JetQuaternion world_from_hand =
      bearing * TurnZ(-left * kToeIn * on_box) * TurnY(kDegree * hand_pitch_.At(own_time));
  const JetVector grip = BoxAt(time) + bearing * Constant({0, scale_ * left * kGripHalfWidth, 0});
  const JetVector at_box = grip + world_from_hand * Constant({0, 0, scale_ * kGripBelowWrist});
  const JetVector shoulder =
      posture.PointOn(girdle, skeleton_.origin_in_parent[static_cast<std::size_t>(girdle) + 1]);
  const Jet ahead = hands_ahead_.At(time);
  const JetVector hanging = shoulder + Constant(scale_ * Vector3d(0.05, left * 0.05, -0.533)) +
                            ahead * Constant(scale_ * Vector3d(0.27, left * -0.05, 0.14));
  posture.ReachWithArm(side, hanging + on_box * JetVector(at_box - hanging), world_from_hand,
                       kDegree * elbow_swivel_.At(time));
}

}  // namespace

std::unique_ptr<MotionGenerator> MakeLift(const urdf::Skeleton& skeleton) {
  return std::make_unique<Lift>(skeleton);
}

}  // namespace kinescope::subject
