#include "urdf/skin/make/weights.h"

#include <cmath>
#include <map>
#include <utility>

#include "urdf/skin/frames.h"
#include "urdf/skin/make/neighbours.h"

namespace kinescope::skin {
namespace {

using urdf::At;

// Coordinates of a vertex, 0..1 each: how far it is past a joint, or along a bone.
enum Field : std::size_t {
  kPastL5,
  kPastL3,
  kPastT12,
  kPastT8,
  kPastNeck,
  kPastHead,
  kGirdle,  // share of the shoulder girdle
  kPastShoulder,
  kAlongUpperArm,
  kPastElbow,
  kAlongForeArm,
  kPastWrist,
  kPastHip,
  kAlongThigh,
  kPastKnee,
  kPastAnkle,
  kPastBall,
  kRay,  // five: the number of joints passed in each ray of the hand
  kFieldCount = kRay + 5
};
using Fields = std::array<double, kFieldCount>;

// How far `p` is along its ray: each joint counts 1. 0 outside of its ray.
void SetRays(const BindPose& bind, const Point& p, Fields& fields) {
  const urdf::FingerPoses& fingers = bind.fingers[urdf::kLeft];
  const urdf::HandSkeleton lengths = urdf::DefaultHand(urdf::kLeft, 0.19);
  std::array<double, 5> distance{}, passed{};
  for (int ray = 0; ray < 5; ++ray) {
    distance[At(ray)] = 1;
    const int first = urdf::MetacarpalOf(ray) + (ray == 0 ? 0 : 1);
    for (int i = 0; i < 3; ++i) {
      const urdf::Pose& pose = fingers[At(first + i)];
      const Point bone = pose.orientation * urdf::EndOf(lengths, first + i);
      const double along = (p - pose.position).dot(bone.normalized());
      // The base of the thumb turns its ball.
      const double half = ray == 0 && i == 0 ? 0.018 : 0.0060 - 0.0008 * i;
      passed[At(ray)] += Ramp(-half, half, along);
      const double to_bone = RoundCone(p, pose.position, pose.position + bone, 0, 0);
      distance[At(ray)] = std::min(distance[At(ray)], to_bone);
    }
  }
  for (int ray = 0; ray < 5; ++ray) {
    double nearest_other = 1;
    for (int other = 0; other < 5; ++other) {
      if (other != ray) nearest_other = std::min(nearest_other, distance[At(other)]);
    }
    const double member = Ramp(-0.003, 0.003, nearest_other - distance[At(ray)]);
    const double reach = ray == 0 ? Ramp(0.034, 0.018, distance[0]) : 1;
    fields[kRay + At(ray)] = member * reach * passed[At(ray)];
  }
}

// Rad; at most 1e-4 off (Abramowitz and Stegun 4.4.45).
double AngleOf(double cosine) {
  const double x = std::min(std::abs(cosine), 1.0);
  const double angle =
      std::sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
  return cosine < 0 ? M_PI - angle : angle;
}

// `p` as if on the left. The ramps are those that looked right in nine postures.
Fields FieldsAt(const BodySolid& body, const Point& point) {
  const BindPose& bind = body.bind();
  const Point p(point.x(), std::abs(point.y()), point.z());
  const BodySolid::Parts parts = body.PartsAt(p);
  Fields f{};
  const auto up = [&](int segment, double from, double to) {
    return Ramp(from, to, p.z() - bind.links[At(segment)].position.z());
  };
  // Wide enough to overlap: a bent spine is one curve, without a ripple for each of its joints.
  f[kPastL5] = up(urdf::kL5, -0.085, 0.085);
  f[kPastL3] = up(urdf::kL3, -0.085, 0.085);
  f[kPastT12] = up(urdf::kT12, -0.085, 0.085);
  f[kPastT8] = up(urdf::kT8, -0.085, 0.085);
  // The planes of neck and skull fall to the front.
  const double tilt = 0.45 * p.x();
  f[kPastNeck] = up(urdf::kNeck, -0.032 - tilt, 0.050 - tilt) * Ramp(0.125, 0.060, p.y());
  f[kPastHead] = up(urdf::kHead, -0.038 - tilt, 0.002 - tilt);
  const double below_shoulder = bind.links[urdf::kLeftUpperArm].position.z() - p.z();
  // From the midline and the neck on so slowly that a raised girdle is no collar around the neck.
  f[kGirdle] =
      Ramp(0.005, 0.150, p.y()) * Ramp(0.150, 0.022, below_shoulder) * Ramp(0.580, 0.430, p.z());

  const bool may_be_arm = p.y() > 0.025 && p.z() > -0.25;  // thighs are as far out as armpits
  const double is_arm = may_be_arm ? Ramp(-0.035, 0.030, parts.trunk - parts.arm) : 0;
  // The trapezius, too, goes along with a raised arm: it ends in a curve and not in a corner.
  const double beside_neck = Ramp(0.025, 0.125, p.y());
  const double is_on_top =
      may_be_arm ? beside_neck * Ramp(-0.103, -0.056, parts.trunk - parts.arm) : 0;
  if (is_on_top > 0) {
    const Point a = InLink(bind.links[urdf::kLeftUpperArm], p);
    const Point e = InLink(bind.links[urdf::kLeftForeArm], p);
    const Point w = InLink(bind.links[urdf::kLeftHand], p);
    const auto linear = [](double from, double to, double x) {
      return std::clamp((x - from) / (to - from), 0.0, 1.0);
    };
    // Linear, and reaching onto the trunk: otherwise the deltoid folds into a sleeve. Above the
    // joint by angle, as a fan: raising the arm closes it, and none of its ribs overtakes another.
    const double below = linear(-0.053, 0.100 + 0.040 * Ramp(-0.010, 0.045, a.y()), -a.z());
    const double fan =
        Mix(1 - std::min(AngleOf(-a.z() / a.norm()) / 3.3, 1.0), 1, Ramp(0.026, 0.158, -a.z()));
    const double above = Ramp(-0.056, -0.014, a.y());
    f[kPastShoulder] = Mix(is_arm * below, is_on_top * fan, above);
    f[kAlongUpperArm] = is_arm * linear(0.160, 0.280, -a.z());
    f[kPastElbow] = is_arm * Ramp(-0.046, 0.046, -e.z());
    f[kAlongForeArm] = is_arm * linear(0.040, 0.220, -e.z());
    f[kPastWrist] = is_arm * Ramp(-0.024, 0.020, -w.z());
    if (w.z() < -0.005) SetRays(bind, p, f);
  }
  if (is_arm <= 0.5) {
    const Point h = p - bind.links[urdf::kLeftUpperLeg].position;
    const Point t = InLink(bind.links[urdf::kLeftUpperLeg], p);
    const Point k = InLink(bind.links[urdf::kLeftLowerLeg], p);
    const Point a = InLink(bind.links[urdf::kLeftFoot], p);
    const Point b = InLink(bind.links[urdf::kLeftToe], p);
    const double groin = h.dot(Point(0, 0.50, -0.866)), behind = Ramp(0.02, -0.08, p.x()),
                 at_side = Ramp(0.09, 0.16, p.y()) * Ramp(0.09, 0.03, p.x()),
                 wide = std::max(behind, at_side);
    const double beside_midline = Ramp(-0.060, 0.080, p.y() + 1.2 * std::max(0.0, -0.085 - p.z()));
    f[kPastHip] = Ramp(-0.060 - 0.030 * wide, 0.080 + 0.045 * wide, groin) * beside_midline;
    f[kAlongThigh] = std::clamp((-t.z() - 0.070) / 0.300, 0.0, 1.0);
    if (p.z() < -0.12) {
      f[kPastKnee] = Ramp(-0.062, 0.062, -k.z());
      f[kPastAnkle] = Ramp(-0.036, 0.036, a.dot(Point(0.35, 0, -0.937)));
      if (a.z() < 0.05) f[kPastBall] = Ramp(-0.022, 0.022, b.x());
    }
  }
  return f;
}

class Evener {
 public:
  Evener(const std::vector<Point>& vertices, const std::vector<Triangle>& triangles)
      : around_(vertices.size()) {
    const Neighbours neighbours = NeighboursOf(vertices.size(), triangles);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (const std::uint16_t j : neighbours[i]) {
        around_[i].emplace_back(j, 1 / std::max((vertices[i] - vertices[j]).norm(), 1e-4));
      }
    }
  }

  void operator()(std::vector<Fields>& fields, std::size_t field, int rounds) const {
    constexpr double kKept = 0.4;
    std::vector<double> next(fields.size());
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < fields.size(); ++i) {
        double sum = 0, weight = 0;
        for (const auto& [j, share] : around_[i]) {
          sum += share * fields[j][field];
          weight += share;
        }
        next[i] = kKept * fields[i][field] + (1 - kKept) * sum / weight;
      }
      for (std::size_t i = 0; i < fields.size(); ++i) fields[i][field] = next[i];
    }
  }

 private:
  std::vector<std::vector<std::pair<std::uint32_t, double>>> around_;
};

// Frames one after another; a vertex lies between two of them. What the chain begins at (the trunk,
// the hand) is before the first.
class Chain {
 public:
  void Add(double at, int frame) { stops_.emplace_back(at, frame); }

  /// Distributes `mass`. @return the trunk's share of it
  double Add(double at, double mass, std::map<int, double>& weights) const {
    double from = 0;
    int before = -1;
    for (const auto& [stop, frame] : stops_) {
      if (at <= stop) {
        const double t = stop > from ? (at - from) / (stop - from) : 1;
        weights[frame] += mass * t;
        if (before < 0) return mass * (1 - t);
        weights[before] += mass * (1 - t);
        return 0;
      }
      from = stop;
      before = frame;
    }
    weights[before] += mass;
    return 0;
  }

 private:
  std::vector<std::pair<double, int>> stops_;
};

// Moves weight of the hand to the fingers; where rays share a vertex, each takes its part.
void AddFingers(const Fields& f, int hand, const std::array<Chain, 5>& rays,
                std::map<int, double>& weights) {
  const auto whole = weights.find(SegmentFrame(hand));
  double total = 0;
  for (std::size_t ray = 0; ray < rays.size(); ++ray) total += f[kRay + ray];
  if (whole == weights.end() || total < 1e-6) return;
  const double mass = whole->second;
  whole->second = 0;
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    const double passed = f[kRay + ray];
    weights[SegmentFrame(hand)] += rays[ray].Add(passed, mass * passed / total, weights);
  }
}

// The heaviest four, in shares of 255; rounding goes to the first.
VertexWeights Strongest(const std::map<int, double>& weights) {
  std::vector<std::pair<double, int>> order;
  for (const auto& [frame, weight] : weights) {
    if (weight > 0) order.emplace_back(-weight, frame);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), kInfluences));
  double sum = 0;
  for (const auto& [weight, frame] : order) sum -= weight;
  VertexWeights out;
  int rest = 255;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto share = static_cast<int>(std::lround(-order[i].first / sum * 255));
    out.frames[i] = static_cast<std::uint8_t>(order[i].second);
    out.weights[i] = static_cast<std::uint8_t>(share);
    rest -= share;
  }
  out.weights[0] = static_cast<std::uint8_t>(out.weights[0] + rest);
  return out;
}

Chain LimbChain(const std::vector<int>& segments) {
  Chain chain;
  double at = 0;
  for (const int segment : segments) {
    for (int i = 0; i < SwingFrames(segment); ++i) {
      const int frame = SwingFrame(segment, i);
      chain.Add(at + Frames()[At(frame)].share, frame);
    }
    at += 1;
    const int twists = TwistFrames(segment);
    for (int i = 0; i < twists; ++i) {
      chain.Add(at + Frames()[At(TwistFrame(segment, i))].share, TwistFrame(segment, i));
    }
    if (twists > 0) at += 1;
    chain.Add(at, SegmentFrame(segment));
  }
  return chain;
}

Chain FingerChain(int hand, int ray) {
  Chain chain;
  const int first = urdf::MetacarpalOf(ray) + (ray == 0 ? 0 : 1);
  for (int i = 0; i < 3; ++i) {
    chain.Add(i + 0.5, FingerFrame(hand, first + i, true));
    chain.Add(i + 1.0, FingerFrame(hand, first + i, false));
  }
  return chain;
}

struct Limbs {
  explicit Limbs(urdf::Side side)
      : hand(urdf::HandSegmentOf(side)),
        arm(LimbChain({hand - 2, hand - 1, hand})),
        leg(side == urdf::kLeft ? LimbChain({urdf::kLeftUpperLeg, urdf::kLeftLowerLeg,
                                             urdf::kLeftFoot, urdf::kLeftToe})
                                : LimbChain({urdf::kRightUpperLeg, urdf::kRightLowerLeg,
                                             urdf::kRightFoot, urdf::kRightToe})) {
    for (int ray = 0; ray < 5; ++ray) rays[At(ray)] = FingerChain(hand, ray);
  }

  int hand;
  Chain arm, leg;
  std::array<Chain, 5> rays;
};

VertexWeights WeightsAt(const Point& p, const Fields& f, const Limbs& own,
                        const Limbs& other_side) {
  std::map<int, double> weights;
  // From a joint on, the limb follows what lies beyond it.
  const double arm = f[kPastShoulder] + f[kAlongUpperArm] * Ramp(0.90, 1, f[kPastShoulder]) +
                     f[kPastElbow] + f[kAlongForeArm] + f[kPastWrist];
  const double is_past_knee = f[kPastKnee] > 0.99 ? 1 : 0;
  const double leg = f[kPastHip] + f[kAlongThigh] * Ramp(0.97, 1, f[kPastHip]) + f[kPastKnee] +
                     is_past_knee * (f[kPastAnkle] + f[kPastBall]);
  double trunk = 1;
  if (arm > leg) {
    trunk = own.arm.Add(arm, 1, weights);
    AddFingers(f, own.hand, own.rays, weights);
  } else if (leg > 0) {
    // On the midline both thighs pull alike.
    const double other = 0.5 * Ramp(0.028, 0, std::abs(p.y())) * Ramp(-0.22, -0.16, p.z());
    trunk = own.leg.Add(leg, 1 - other, weights);
    if (other > 0) trunk += other_side.leg.Add(leg, other, weights);
  }
  // The trunk's share: from the head down, each takes what those above leave.
  constexpr std::array<std::pair<int, std::size_t>, 6> kSpine = {{{urdf::kHead, kPastHead},
                                                                  {urdf::kNeck, kPastNeck},
                                                                  {urdf::kT8, kPastT8},
                                                                  {urdf::kT12, kPastT12},
                                                                  {urdf::kL3, kPastL3},
                                                                  {urdf::kL5, kPastL5}}};
  std::map<int, double> spine;
  double rest = trunk;
  for (const auto& [segment, field] : kSpine) {
    spine[segment] = rest * f[field];
    rest -= spine[segment];
  }
  spine[urdf::kPelvis] = rest;
  const double of_t8 = f[kGirdle] * spine[urdf::kT8],
               of_t12 = 0.35 * f[kGirdle] * spine[urdf::kT12];
  spine[urdf::kT8] -= of_t8;
  spine[urdf::kT12] -= of_t12;
  spine[own.hand - 3] += of_t8 + of_t12;
  for (const auto& [segment, weight] : spine) weights[SegmentFrame(segment)] += weight;
  return Strongest(weights);
}

}  // namespace

std::vector<VertexWeights> MakeWeights(const BodySolid& body, const std::vector<Point>& vertices,
                                       const std::vector<Triangle>& triangles) {
  std::vector<Fields> fields;
  fields.reserve(vertices.size());
  for (const Point& vertex : vertices) fields.push_back(FieldsAt(body, vertex));
  const Evener even(vertices, triangles);
  constexpr std::pair<std::size_t, int> kRounds[] = {
      {kPastShoulder, 32}, {kPastHip, 24},      {kGirdle, 20},   {kPastNeck, 6},
      {kPastHead, 3},      {kAlongUpperArm, 4}, {kPastAnkle, 3}, {kRay, 2},
      {kRay + 1, 2},       {kRay + 2, 2},       {kRay + 3, 2},   {kRay + 4, 2}};
  for (const auto& [field, rounds] : kRounds) even(fields, field, rounds);
  const Limbs left(urdf::kLeft), right(urdf::kRight);
  std::vector<VertexWeights> weights;
  weights.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const bool is_left = vertices[i].y() >= 0;
    weights.push_back(
        WeightsAt(vertices[i], fields[i], is_left ? left : right, is_left ? right : left));
  }
  return weights;
}

}  // namespace kinescope::skin
