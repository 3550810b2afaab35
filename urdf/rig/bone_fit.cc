#include "urdf/rig/bone_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "urdf/hand.h"
#include "urdf/skeleton.h"
#include "urdf/skin/bind_pose.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/skin_template.h"
#include "urdf/turn_between.h"

namespace kinescope::rig {
namespace {

using Eigen::Affine3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;

constexpr double kLeastStretch = 0.25, kMostStretch = 4;

// Joints of a body in its own axes (x forward, y left, z up), and how far the parts without a joint
// at their end reach from theirs. The built-in skin and the rig are measured alike.
struct Measured {
  std::array<std::optional<Vector3d>, urdf::kSegmentCount> joints;
  std::array<std::optional<Vector3d>, 2> middle_finger;  // its first joint
  // By urdf::Side, m; 0: unknown.
  std::array<double, 2> hand_length{}, toe_reach{}, sole_depth{};
  std::array<Vector3d, 2> foot_middle{};  // of the vertices, from the ankle

  const Vector3d& operator[](int segment) const { return *joints[At(segment)]; }
  bool Has(int segment) const { return joints[At(segment)].has_value(); }
  Vector3d MidHips() const {
    return 0.5 * ((*this)[urdf::kRightUpperLeg] + (*this)[urdf::kLeftUpperLeg]);
  }
};

struct Side {
  urdf::Side side;
  int shoulder, upper_arm, fore_arm, hand, upper_leg, lower_leg, foot, toe;
};
constexpr std::array kSides = {
    Side{urdf::kRight, urdf::kRightShoulder, urdf::kRightUpperArm, urdf::kRightForeArm,
         urdf::kRightHand, urdf::kRightUpperLeg, urdf::kRightLowerLeg, urdf::kRightFoot,
         urdf::kRightToe},
    Side{urdf::kLeft, urdf::kLeftShoulder, urdf::kLeftUpperArm, urdf::kLeftForeArm, urdf::kLeftHand,
         urdf::kLeftUpperLeg, urdf::kLeftLowerLeg, urdf::kLeftFoot, urdf::kLeftToe}};

// The end of the limb's direction at the wrist.
Vector3d HandDirection(const Measured& body, const Side& s, bool by_finger) {
  const auto& finger = body.middle_finger[At(s.side)];
  const Vector3d along =
      by_finger ? Vector3d(*finger - body[s.hand]) : Vector3d(body[s.hand] - body[s.fore_arm]);
  return along.normalized();
}

// `vertices`: position and the segment that carries most of it.
template <class Vertices>
void MeasureEnds(const Vertices& vertices, Measured& body) {
  std::array<int, 2> of_feet{};
  for (const auto& [position, segment] : vertices) {
    for (const Side& s : kSides) {
      const std::size_t side = At(s.side);
      if (segment == s.hand) {
        const bool by_finger = body.middle_finger[side].has_value();
        const double along = (position - body[s.hand]).dot(HandDirection(body, s, by_finger));
        body.hand_length[side] = std::max(body.hand_length[side], along);
      }
      if (segment != s.foot && segment != s.toe) continue;
      const Vector3d from_ankle = position - body[s.foot];
      body.sole_depth[side] = std::max(body.sole_depth[side], -from_ankle.z());
      body.toe_reach[side] = std::max(body.toe_reach[side], from_ankle.x());
      body.foot_middle[side] += from_ankle;
      ++of_feet[side];
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (of_feet[side] > 0) body.foot_middle[side] /= of_feet[side];
  }
}

using Vertices = std::vector<std::pair<Vector3d, int>>;

Measured MeasureBuiltIn(const std::array<bool, 2>& by_finger) {
  const skin::BindPose bind = skin::BindPoseOf(urdf::DefaultSkeleton());
  Measured body;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    body.joints[At(segment)] = bind.links[At(segment)].position;
  }
  constexpr int kMiddleRay = 2;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (!by_finger[At(side)]) continue;
    const int knuckle = urdf::MetacarpalOf(kMiddleRay) + 1;
    body.middle_finger[At(side)] = bind.fingers[At(side)][At(knuckle)].position;
  }
  const skin::SkinTemplate& built_in = skin::BuiltInSkin();
  const auto positions = built_in.Blend({});
  Vertices vertices;
  vertices.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const int segment = skin::Frames()[built_in.weights[i].frames[0]].segment;
    vertices.emplace_back(positions[i].cast<double>(), segment);
  }
  MeasureEnds(vertices, body);
  return body;
}

Vector3d NearestAxis(const Vector3d& direction) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  Vector3d axis = Vector3d::Zero();
  axis[largest] = direction[largest] < 0 ? -1 : 1;
  return axis;
}

std::string Named(const Rig& rig, const Bones& bones, int segment) {
  return "'" + rig.nodes[At(bones.node_of[At(segment)])].name.substr(0, 60) + "'";
}

Vector3d JointOf(const Rig& rig, const Bones& bones, int segment) {
  return rig.nodes[At(bones.node_of[At(segment)])].world_from_node.translation();
}

// world to body axes: the file's up axis where the body stands along one, and left from right.
Matrix3d BodyAxes(const Rig& rig, const Bones& bones) {
  const auto joint = [&](int segment) { return JointOf(rig, bones, segment); };
  const Vector3d hips = 0.5 * (joint(urdf::kRightUpperLeg) + joint(urdf::kLeftUpperLeg));
  Vector3d up = joint(urdf::kHead) - hips;
  const Vector3d across = joint(urdf::kLeftUpperLeg) - joint(urdf::kRightUpperLeg) +
                          joint(urdf::kLeftUpperArm) - joint(urdf::kRightUpperArm);
  constexpr double kUpright = 0.87;  // cosine of 30 degrees
  const Vector3d axis = NearestAxis(up);
  if (up.dot(axis) > kUpright * up.norm()) up = axis;
  up.normalize();
  const Vector3d left = across - across.dot(up) * up;
  if (!(up.norm() > 0.5) || !(left.norm() > 1e-3 * across.norm())) {
    throw std::runtime_error(fmt::format(
        "its bones {} and {} are not beside each other: no left and right",
        Named(rig, bones, urdf::kLeftUpperLeg), Named(rig, bones, urdf::kRightUpperLeg)));
  }
  Matrix3d axes;
  axes.row(1) = left.normalized();
  axes.row(2) = up;
  axes.row(0) = axes.row(1).cross(axes.row(2));
  return axes;
}

// The bones whose lengths are measured.
constexpr std::array<std::pair<int, int>, 8> kLimbBones = {
    {{urdf::kRightUpperArm, urdf::kRightForeArm},
     {urdf::kRightForeArm, urdf::kRightHand},
     {urdf::kLeftUpperArm, urdf::kLeftForeArm},
     {urdf::kLeftForeArm, urdf::kLeftHand},
     {urdf::kRightUpperLeg, urdf::kRightLowerLeg},
     {urdf::kRightLowerLeg, urdf::kRightFoot},
     {urdf::kLeftUpperLeg, urdf::kLeftLowerLeg},
     {urdf::kLeftLowerLeg, urdf::kLeftFoot}}};

// Those that a rig may lack.
constexpr std::array<std::pair<int, int>, 4> kOptionalBones = {{{urdf::kT8, urdf::kNeck},
                                                                {urdf::kNeck, urdf::kHead},
                                                                {urdf::kRightFoot, urdf::kRightToe},
                                                                {urdf::kLeftFoot, urdf::kLeftToe}}};

template <class Joint>
double LegsAndTrunk(const Joint& joint) {
  double length = 0;
  for (std::size_t bone = 4; bone < kLimbBones.size(); ++bone) {
    length += 0.5 * (joint(kLimbBones[bone].second) - joint(kLimbBones[bone].first)).norm();
  }
  const Vector3d hips = 0.5 * (joint(urdf::kRightUpperLeg) + joint(urdf::kLeftUpperLeg));
  return length + (joint(urdf::kHead) - hips).norm();
}

void CheckLengths(const Rig& rig, const Bones& bones, double all) {
  constexpr double kLeast = 0.01;  // of legs and trunk
  const auto check = [&](int from, int to) {
    const bool has_both = bones.node_of[At(from)] >= 0 && bones.node_of[At(to)] >= 0;
    if (!has_both || (JointOf(rig, bones, to) - JointOf(rig, bones, from)).norm() >= kLeast * all) {
      return;
    }
    throw std::runtime_error(
        fmt::format("its bones {} and {} are at the same place, so that there is no bone between "
                    "them: move one of them to its joint",
                    Named(rig, bones, from), Named(rig, bones, to)));
  };
  for (const auto& [from, to] : kLimbBones) check(from, to);
  for (const auto& [from, to] : kOptionalBones) check(from, to);
}

// Metres of the reference body, body axes.
Affine3d ToBody(const Rig& rig, const Bones& bones, const Measured& ours) {
  const double all = LegsAndTrunk([&](int segment) { return JointOf(rig, bones, segment); });
  if (!(all > 1e-9) || !std::isfinite(all)) {
    throw std::runtime_error("all of its bones are at the same place");
  }
  CheckLengths(rig, bones, all);
  const double scale = LegsAndTrunk([&](int segment) { return ours[segment]; }) / all;
  return Affine3d(Eigen::Matrix3d(scale * BodyAxes(rig, bones)));
}

Measured MeasureRig(const Rig& rig, const Bones& bones, const Affine3d& to_body) {
  Measured body;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (bones.node_of[At(segment)] < 0) continue;
    body.joints[At(segment)] = to_body * JointOf(rig, bones, segment);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const int finger = bones.middle_finger[side];
    if (finger < 0) continue;
    const Vector3d at = to_body * rig.nodes[At(finger)].world_from_node.translation();
    const Vector3d hand = body[kSides[side].hand];
    if ((at - hand).norm() > 0.01) body.middle_finger[side] = at;
  }
  Vertices vertices;
  vertices.reserve(rig.vertices.size());
  for (const RigVertex& vertex : rig.vertices) {
    vertices.emplace_back(to_body * vertex.position, bones.segment_of[At(vertex.nodes[0])]);
  }
  MeasureEnds(vertices, body);
  for (const Side& s : kSides) {
    const double ahead =
        body.Has(s.toe) ? (body[s.toe] - body[s.foot]).x() : body.foot_middle[At(s.side)].x();
    if (ahead >= -0.02) continue;
    throw std::runtime_error(
        fmt::format("the foot of its bone {} points backwards: left and right are exchanged",
                    Named(rig, bones, s.foot)));
  }
  return body;
}

// Along the bone by `ratio`, then turned.
Matrix3d Stretched(const Quaterniond& turn, const Vector3d& along, double ratio) {
  const Vector3d d = along.normalized();
  return turn.toRotationMatrix() * (Matrix3d::Identity() + (ratio - 1) * d * d.transpose());
}

double Ratio(double ours, double theirs) {
  return ours > 1e-4 && theirs > 1e-4 ? std::clamp(ours / theirs, kLeastStretch, kMostStretch) : 1;
}

Affine3d About(const Vector3d& from, const Matrix3d& linear, const Vector3d& to) {
  Affine3d fit = Affine3d::Identity();
  fit.linear() = linear;
  fit.translation() = to - linear * from;
  return fit;
}

using Fit = std::array<Affine3d, urdf::kSegmentCount>;

// One bone after the other, so that none is twisted against the one before.
class Limb {
 public:
  Limb(const Measured& theirs, const Measured& ours, Fit& fit)
      : theirs_(theirs), ours_(ours), fit_(fit) {}

  void Bone(int segment, int next) {
    const Vector3d bone = theirs_[next] - theirs_[segment], goal = ours_[next] - ours_[segment];
    Turn(bone, goal);
    fit_[At(segment)] =
        About(theirs_[segment], Stretched(turn_, bone, goal.norm() / bone.norm()), ours_[segment]);
  }
  void Hand(const Side& s) {
    const bool by_finger = theirs_.middle_finger[At(s.side)].has_value();
    const Vector3d along = HandDirection(theirs_, s, by_finger);
    Turn(along, HandDirection(ours_, s, by_finger));
    const double ratio = Ratio(ours_.hand_length[At(s.side)], theirs_.hand_length[At(s.side)]);
    fit_[At(s.hand)] = About(theirs_[s.hand], Stretched(turn_, along, ratio), ours_[s.hand]);
  }

 private:
  void Turn(const Vector3d& from, const Vector3d& to) {
    turn_ = urdf::TurnBetween(turn_ * from, to) * turn_;
  }

  const Measured &theirs_, &ours_;
  Fit& fit_;
  Quaterniond turn_ = Quaterniond::Identity();
};

// Flat on the floor: turned about the vertical only, as long and as deep as the built-in foot.
void FitFoot(const Side& s, const Measured& theirs, const Measured& ours, Fit& fit) {
  const std::size_t side = At(s.side);
  const auto heading = [&](const Vector3d& ahead) {
    return ahead.head<2>().norm() > 1e-3 ? std::atan2(ahead.y(), ahead.x()) : 0.0;
  };
  const bool has_toe = theirs.Has(s.toe);
  const Vector3d ball =
      has_toe ? Vector3d(theirs[s.toe] - theirs[s.foot]) : theirs.foot_middle[side];
  const Vector3d our_ball = has_toe ? Vector3d(ours[s.toe] - ours[s.foot]) : ours.foot_middle[side];
  const Matrix3d turn =
      Eigen::AngleAxisd(heading(our_ball) - heading(ball), Vector3d::UnitZ()).toRotationMatrix();
  const double deep = Ratio(ours.sole_depth[side], theirs.sole_depth[side]);
  const double forward = has_toe ? Ratio(our_ball.x(), (turn * ball).x())
                                 : Ratio(ours.toe_reach[side], theirs.toe_reach[side]);
  const auto scaled = [&](double ahead) {
    return Matrix3d(Vector3d(ahead, 1, deep).asDiagonal() * turn);
  };
  fit[At(s.foot)] = About(theirs[s.foot], scaled(forward), ours[s.foot]);
  if (!has_toe) return;
  const double toes = Ratio(ours.toe_reach[side] - our_ball.x(), theirs.toe_reach[side] - ball.x());
  // The sole stays even, whatever the height of the joint.
  Vector3d to = ours[s.toe];
  to.z() = (fit[At(s.foot)] * theirs[s.toe]).z();
  fit[At(s.toe)] = About(theirs[s.toe], scaled(toes), to);
}

void FitTrunk(const Measured& theirs, const Measured& ours, Fit& fit) {
  const int top = theirs.Has(urdf::kNeck) ? urdf::kNeck : urdf::kHead;
  const Vector3d hips = theirs.MidHips(), our_hips = ours.MidHips();
  const Vector3d spine = theirs[top] - hips, our_spine = ours[top] - our_hips;
  const Matrix3d linear =
      Stretched(urdf::TurnBetween(spine, our_spine), spine, our_spine.norm() / spine.norm());
  fit.fill(About(hips, linear, our_hips));
  const auto width = [](const Measured& of) {
    return (of[urdf::kLeftUpperLeg] - of[urdf::kRightUpperLeg]).norm();
  };
  Matrix3d pelvis = linear;
  pelvis.col(1) *= std::clamp(width(ours) / width(theirs), 0.7, 1.4);
  fit[urdf::kPelvis] = About(hips, pelvis, our_hips);
  if (theirs.Has(urdf::kNeck)) {
    const Vector3d neck = theirs[urdf::kHead] - theirs[urdf::kNeck],
                   our_neck = ours[urdf::kHead] - ours[urdf::kNeck];
    const double length = neck.norm();
    fit[urdf::kNeck] = About(theirs[urdf::kNeck],
                             length < 1e-3 ? Matrix3d(Matrix3d::Identity())
                                           : Stretched(urdf::TurnBetween(neck, our_neck), neck,
                                                       our_neck.norm() / length),
                             ours[urdf::kNeck]);
  }
  fit[urdf::kHead] = About(theirs[urdf::kHead], Matrix3d::Identity(), ours[urdf::kHead]);
  for (const Side& s : kSides) {  // the girdle moves so that the shoulder is at its joint
    const Affine3d& trunk = fit[urdf::kT8];
    fit[At(s.shoulder)] =
        Eigen::Translation3d(ours[s.upper_arm] - trunk * theirs[s.upper_arm]) * trunk;
  }
}

}  // namespace

Fit FitBones(const Rig& rig, const Bones& bones) {
  const Affine3d to_body = ToBody(rig, bones, MeasureBuiltIn({}));
  const Measured theirs = MeasureRig(rig, bones, to_body);
  const Measured ours =
      MeasureBuiltIn({theirs.middle_finger[0].has_value(), theirs.middle_finger[1].has_value()});
  Fit fit;
  FitTrunk(theirs, ours, fit);
  for (const Side& s : kSides) {
    Limb arm(theirs, ours, fit);
    arm.Bone(s.upper_arm, s.fore_arm);
    arm.Bone(s.fore_arm, s.hand);
    arm.Hand(s);
    Limb leg(theirs, ours, fit);
    leg.Bone(s.upper_leg, s.lower_leg);
    leg.Bone(s.lower_leg, s.foot);
    FitFoot(s, theirs, ours, fit);
  }
  for (Affine3d& each : fit) each = each * to_body;
  return fit;
}

}  // namespace kinescope::rig
