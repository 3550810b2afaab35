#include "core/hand_load_shape.h"

#include <algorithm>
#include <cmath>

#include "urdf/turn_between.h"

namespace kinescope {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMinKg = 0.01;           // less is nothing to see
constexpr double kIron = 7800;            // kg/m^3
constexpr double kPackedBox = 350;        // kg/m^3, what people carry in boxes
constexpr double kBarRadius = 0.014;      // m
constexpr double kFistWidth = 0.11;       // m, between the discs
constexpr double kInTheFist = 0.03;       // m from the grip: a rod would not be seen
constexpr double kDiscProportion = 0.55;  // thickness of a disc, of its radius

// Of a disc of `mass_kg`.
double DiscRadius(double mass_kg) { return std::cbrt(mass_kg / (kIron * M_PI * kDiscProportion)); }

Quaterniond AlongZ(const Vector3d& direction) {
  return urdf::TurnBetween(Vector3d::UnitZ(), direction);
}

class Maker {
 public:
  /// Whose solids those are that are added from here on.
  void SetHand(std::optional<urdf::Side> hand) { hand_ = hand; }

  void Add(HandLoadSolid::Kind kind, const Vector3d& position, const Quaterniond& turn,
           const Vector3d& size) {
    held_.solids[held_.count++] = {kind, {position, turn}, size, hand_};
  }
  void AddCylinder(const Vector3d& position, const Quaterniond& turn, double radius,
                   double length) {
    Add(HandLoadSolid::Kind::kCylinder, position, turn, {radius, radius, length});
  }

  // Along the thumb: that is how a fist holds a bar.
  void AddDumbbell(const Vector3d& center, const Quaterniond& world_from_hand, double mass_kg) {
    const Vector3d axis = world_from_hand * Vector3d::UnitX();
    const Quaterniond turn = AlongZ(axis);
    const double radius = DiscRadius(mass_kg / 2), thickness = kDiscProportion * radius;
    const double apart = 0.5 * (kFistWidth + thickness);
    AddCylinder(center, turn, kBarRadius, kFistWidth);
    AddCylinder(center + apart * axis, turn, radius, thickness);
    AddCylinder(center - apart * axis, turn, radius, thickness);
  }

  void AddIronOnRod(const Vector3d& grip, const Vector3d& center, double mass_kg) {
    const Vector3d rod = center - grip;
    const double radius = DiscRadius(mass_kg);
    AddCylinder(0.5 * (grip + center), AlongZ(rod), kBarRadius, rod.norm());
    AddCylinder(center, AlongZ(rod), radius, kDiscProportion * radius);
  }

  // As wide as the hands are apart, level, and as high as the mass asks for.
  void AddBox(const Vector3d& right, const Vector3d& left, double mass_kg) {
    constexpr double kMinWidth = 0.15, kWall = 0.04;  // m; a hand's thickness on either side
    const Vector3d across(left.x() - right.x(), left.y() - right.y(), 0);
    const double width = std::max(kMinWidth, across.norm() - kWall);
    const double edge = std::sqrt(mass_kg / (kPackedBox * width));
    const double heading = std::atan2(across.y(), across.x()) - M_PI_2;
    Add(HandLoadSolid::Kind::kBox, 0.5 * (right + left),
        Quaterniond(Eigen::AngleAxisd(heading, Vector3d::UnitZ())), {edge, width, edge});
  }

  HandLoadShape Take() const { return held_; }

 private:
  HandLoadShape held_;
  std::optional<urdf::Side> hand_;
};

}  // namespace

HandLoadShape ShapeOfHandLoad(const PersonState& person) {
  Maker maker;
  double shared_kg = 0;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const HandForce& hand = person.forces.hands[side];
    shared_kg += hand.shared_kg;
    const double alone_kg = hand.mass_kg - hand.shared_kg;
    if (!(alone_kg > kMinKg) || person.model->human.tools.test(side)) continue;
    const urdf::Pose& link = person.links[urdf::At(urdf::HandSegmentOf(side))];
    maker.SetHand(side);
    if ((hand.point - hand.grip).norm() < kInTheFist) {
      maker.AddDumbbell(hand.point, link.orientation, alone_kg);
    } else {
      maker.AddIronOnRod(hand.grip, hand.point, alone_kg);
    }
  }
  if (shared_kg > kMinKg) {
    maker.SetHand(std::nullopt);
    maker.AddBox(person.forces.hands[urdf::kRight].grip, person.forces.hands[urdf::kLeft].grip,
                 shared_kg);
  }
  return maker.Take();
}

}  // namespace kinescope
