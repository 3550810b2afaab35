#include "urdf/skin/make/body_solid.h"

#include <cmath>

#include "urdf/skin/make/body_parts.h"

namespace kinescope::skin {
struct BodySolid::Shape {
  Shape(const Build& of, const BindPose& bind)
      : build(of),
        trunk(of),
        arm(of),
        hand(of, bind.links[urdf::kLeftHand], bind.fingers[urdf::kLeft]),
        leg(of),
        shoulder_link(bind.links[urdf::kLeftUpperArm]),
        hand_link(bind.links[urdf::kLeftHand]),
        thigh_link(bind.links[urdf::kLeftUpperLeg]),
        foot_link(bind.links[urdf::kLeftFoot]),
        head_link(bind.links[urdf::kHead]) {}

  double Arm(const Point& p) const {
    Joined all(arm(InLink(shoulder_link, p)));
    const Point in_hand = InLink(hand_link, p);
    if (in_hand.z() < 0.06) all.Add(hand(in_hand), 0.012);
    return all.value();
  }
  double Leg(const Point& p) const {
    Joined all(leg(InLink(thigh_link, p)));
    const Point in_foot = InLink(foot_link, p);
    if (in_foot.z() < 0.12) all.Add(FootSolid(in_foot, build), 0.026);
    return all.value();
  }
  double Head(const Point& p) const {
    Joined all(NeckSolid(p, build));
    all.Add(HeadSolid(InLink(head_link, p), build), 0.018);
    return all.value();
  }

  Build build;
  TrunkSolid trunk;
  ArmSolid arm;
  HandSolid hand;
  LegSolid leg;
  urdf::Pose shoulder_link, hand_link, thigh_link, foot_link, head_link;
};

BodySolid::BodySolid(const Build& build)
    : bind_(BindPoseOf(urdf::DefaultSkeleton())),
      shape_(std::make_unique<const Shape>(build, bind_)) {}
BodySolid::~BodySolid() = default;

// Parts that are too far to matter are left out. Near the midline both halves count.
double BodySolid::operator()(const Point& point) const {
  const Point p(point.x(), std::abs(point.y()), point.z());
  const Point other(p.x(), -p.y(), p.z());
  Joined body(1);
  if (p.z() > -0.20) {
    body = Joined(shape_->trunk(p));
    if (p.z() > 0.20) {
      Joined girdle(shape_->trunk.Girdle(p));
      if (p.y() < 0.06) girdle.Add(shape_->trunk.Girdle(other), 0.03);
      body.Add(girdle.value(), 0.060);
    }
    if (p.z() > 0.38) body.Add(shape_->Head(p), 0.045);
  }
  if (p.z() < 0.24) {
    Joined leg(shape_->Leg(p));
    if (p.y() < 0.06) leg.Add(shape_->Leg(other), 0.012);
    body.Add(leg.value(), 0.055);
  }
  if (p.y() > 0.07) body.Add(shape_->Arm(p), 0.048 + 0.014 * shape_->build.woman);
  return body.value();
}

Point BodySolid::Normal(const Point& p) const {
  constexpr double kReach = 2e-4;
  Point gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Point step = kReach * Point::Unit(axis);
    gradient[axis] = (*this)(p + step) - (*this)(p - step);
  }
  return gradient.normalized();
}

BodySolid::Parts BodySolid::PartsAt(const Point& point) const {
  const Point p(point.x(), std::abs(point.y()), point.z());
  Joined trunk(shape_->trunk(p));
  if (p.z() > 0.25) {
    trunk.Add(shape_->trunk.Girdle(p), 0.035);
    trunk.Add(shape_->Head(p), 0.03);
  }
  return {trunk.value(), shape_->Arm(p), shape_->Leg(p)};
}

}  // namespace kinescope::skin
