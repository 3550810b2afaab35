#include <array>

#include "urdf/skin/make/body_parts.h"

namespace kinescope::skin {
namespace {

Loft Palm() {
  return Loft({{-0.010, 0.0285, 0.0285, 0.0190, 0.0190, 0, 0, 0},
               {0.012, 0.0290, 0.0290, 0.0170, 0.0180, 0, 0, 0.10},
               {0.035, 0.0340, 0.0330, 0.0145, 0.0170, 0, 0, 0.25},
               {0.065, 0.0395, 0.0380, 0.0125, 0.0150, 0, 0, 0.30},
               {0.085, 0.0400, 0.0395, 0.0110, 0.0120, 0, 0, 0.30}},
              0.02, 0.012);
}

constexpr std::array<double, 5> kRadii = {0.0105, 0.0088, 0.0091, 0.0087, 0.0077};  // at the base
constexpr double kTaper = 0.90;  // of each phalanx

}  // namespace

HandSolid::HandSolid(const Build& build, const urdf::Pose& hand, const urdf::FingerPoses& fingers)
    : build_(build), palm_(Palm()) {
  const urdf::HandSkeleton lengths = urdf::DefaultHand(urdf::kLeft, 0.19);
  const Eigen::Quaterniond hand_from_world = hand.orientation.conjugate();
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    const urdf::Pose& finger = fingers[i];
    starts_[i] = hand_from_world * (finger.position - hand.position);
    ends_[i] = hand_from_world *
               (finger.position + finger.orientation * EndOf(lengths, static_cast<int>(i)) -
                hand.position);
  }
}

double HandSolid::operator()(const Point& q) const {
  const double slim = 1 - 0.06 * build_.woman;
  Joined hand(palm_(q.x() / slim, q.y(), -q.z()));
  // Fingers: back of the hand at +y. Each is joined of its own first, so that two do not melt.
  for (int ray = 1; ray <= 4; ++ray) {
    const auto first = static_cast<std::size_t>(urdf::MetacarpalOf(ray));
    double radius = slim * kRadii[urdf::At(ray)];
    Joined finger(1);
    for (std::size_t i = first + 1; i < first + 4; ++i) {
      const Point along = (ends_[i] - starts_[i]).normalized();
      const Point end = i == first + 3 ? Point(ends_[i] - 0.9 * radius * along) : ends_[i];
      finger.Add(RoundCone(q, starts_[i], end, radius, kTaper * radius), 0.004);
      radius *= kTaper;
    }
    // Knuckle.
    finger.Add(Ellipsoid(q, starts_[first + 1] + Point(0, 0.0035, 0), {0.0085, 0.0080, 0.0110}),
               0.008);
    hand.Add(finger.value(), 0.0075);
  }
  // Thumb and its ball.
  Joined thumb(RoundCone(q, starts_[1], ends_[1], 0.0150, 0.0116 * slim));
  thumb.Add(RoundCone(q, starts_[2], ends_[2], 0.0110 * slim, 0.0098 * slim), 0.005);
  thumb.Add(RoundCone(q, starts_[3], Point(ends_[3] - 0.008 * (ends_[3] - starts_[3]).normalized()),
                      0.0098 * slim, 0.0082 * slim),
            0.004);
  hand.Add(thumb.value(), 0.016);
  // Heel of the hand.
  hand.Add(Ellipsoid(q, {-0.022 * slim, -0.012, -0.042}, {0.014, 0.012, 0.034}), 0.012);
  return hand.value();
}

}  // namespace kinescope::skin
