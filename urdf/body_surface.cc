#include "urdf/body_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "urdf/body_profiles.h"
#include "urdf/loft.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

double GirthOf(const Skeleton& skeleton) {
  // Whatever a stream claims, a person is between a toddler and a giant.
  return std::clamp(skeleton.height, 0.3, 3.0) / kReferenceHeight;
}

bool IsLeft(int segment) {
  return (segment >= kLeftShoulder && segment <= kLeftHand) || segment >= kLeftUpperLeg;
}

// Away from the middle of the body.
Vector3d Outward(int segment) { return {0, IsLeft(segment) ? 1.0 : -1.0, 0}; }

// A joint-to-joint axis with sections across x (forward) and `v`.
LoftAxis SegmentAxis(const Skeleton& skeleton, int segment, const Vector3d& v) {
  return {Curve({Vector3d::Zero(), EndOf(skeleton, segment)}), Vector3d::UnitX(), v,
          GirthOf(skeleton)};
}

// The axis of a chain of segments whose profile counts them: one smooth line from joint to joint in
// the N-pose, seen from `segment`.
LoftAxis ChainAxis(const Skeleton& skeleton, int first, int count, int segment, const Vector3d& v) {
  std::vector<Vector3d> joints = {Vector3d::Zero()};
  for (int child = first + 1; child <= first + count; ++child) {
    joints.push_back(joints.back() + skeleton.origin_in_parent[At(child)]);
  }
  const Vector3d origin = joints[At(segment - first)];
  for (Vector3d& joint : joints) joint -= origin;
  return {Curve(std::move(joints)), Vector3d::UnitX(), v, GirthOf(skeleton)};
}

// How much wider than the reference body's a person is built, for their height: across the hips and
// across the shoulders, as the suit has measured them.
struct Build {
  double hips = 1, shoulders = 1;
};

Build BuildOf(const Skeleton& skeleton) {
  const auto half_width = [](const Skeleton& of, int right, int left) {
    return 0.5 * (of.origin_in_parent[At(left)].y() - of.origin_in_parent[At(right)].y());
  };
  static const Skeleton kReference = DefaultSkeleton(kReferenceHeight);
  const auto ratio = [&](double own, double reference) {
    return std::clamp(own / (reference * GirthOf(skeleton)), 0.85, 1.2);
  };
  const auto shoulders = [&](const Skeleton& of) {
    return half_width(of, kRightShoulder, kLeftShoulder) +
           half_width(of, kRightUpperArm, kLeftUpperArm);
  };
  return {ratio(half_width(skeleton, kRightUpperLeg, kLeftUpperLeg),
                half_width(kReference, kRightUpperLeg, kLeftUpperLeg)),
          ratio(shoulders(skeleton), shoulders(kReference))};
}

void AddTrunk(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  LoftRange range;
  range.from = segment;
  range.to = segment + 1;
  // Kept wide of the joint on both sides: the fuller half of a spine that bends stays closed.
  range.start_cap = range.end_cap = 0.075;
  range.points = 28;  // a spine twists: facets of neighbours that are coarse would show each other
  range.rings = 5;
  range.start_runs_on = range.end_runs_on = true;
  switch (segment) {
    case kPelvis:  // begins above the hips, so that its cap is the seat
      range.from = 0.25;
      range.start_cap = 0.112;
      range.start_runs_on = false;
      break;
    case kT8:
      range.rings = 7;
      range.end_cap = 0.030;
      range.end_rings = 3;
      range.end_runs_on = false;
      break;
    case kNeck:
      range.start_cap = range.end_cap = 0.045;
      range.start_runs_on = range.end_runs_on = false;
      break;
    default: break;
  }
  const Build build = BuildOf(skeleton);
  const Profile profile = TrunkProfile().Widened([&](double at) {
    const double up = std::clamp((at - 1) / 2.5, 0.0, 1.0);  // waist to chest
    if (at > 4.7) return 1.0;                                // the neck
    return build.hips + (build.shoulders - build.hips) * up;
  });
  LoftAxis axis = ChainAxis(skeleton, kPelvis, 6, segment, Vector3d::UnitY());
  axis.relief = [scale = axis.scale](const Vector3d& point, double at) -> Vector3d {
    const TrunkRelief relief = TrunkReliefAt(point.y() / scale, at);
    // Sides have none; it begins gently behind them.
    const double forward = std::clamp(point.x() / (0.06 * scale), -1.0, 1.0);
    return {scale * forward * std::abs(forward) * (forward > 0 ? relief.front : relief.back), 0, 0};
  };
  AddLoft(axis, profile, range, mesh);
}

// `side` is 1 on the left and -1 on the right.
void AddEar(double side, double scale, TriangleMesh& mesh) {
  const Vector3d lobe = scale * Vector3d(0.002, side * 0.066, 0.022);
  const Vector3d middle = scale * Vector3d(-0.006, side * 0.0735, 0.050);
  const Vector3d top = scale * Vector3d(-0.012, side * 0.0770, 0.074);
  LoftRange range;
  range.to = 2;
  range.start_cap = 0.006;
  range.end_cap = 0.010;
  range.points = 6;
  range.rings = 4;
  range.start_rings = 1;
  range.end_rings = 1;
  AddLoft({Curve({lobe, middle, top}), Vector3d::UnitX(), side * Vector3d::UnitY(), scale},
          EarProfile(), range, mesh);
}

void AddHead(const Skeleton& skeleton, TriangleMesh& mesh) {
  LoftAxis axis = SegmentAxis(skeleton, kHead, Vector3d::UnitY());
  // Depth and width go with the height of the head, which is measured.
  const double length = std::max(EndOf(skeleton, kHead).norm(), 0.01);
  axis.scale = length / 0.190;
  LoftRange range;
  range.from = -0.23;
  range.to = 0.44;
  range.start_cap = 0.014;
  range.end_cap = (1 - range.to) * 0.190;  // up to the crown
  range.points = 26;
  range.rings = 10;
  range.start_rings = 3;
  range.end_rings = 7;
  range.crowd_u = 0.62;  // in the face
  axis.relief = [length](const Vector3d& point, double) -> Vector3d {
    const Vector3d at = point / length;
    // The back of the head has no face.
    const double front = std::clamp((at.x() - 0.15) / 0.15, 0.0, 1.0);
    return {length * front * FaceRelief(at.y(), at.z()), 0, 0};
  };
  AddLoft(axis, HeadProfile(), range, mesh);
  for (const double side : {1.0, -1.0}) AddEar(side, axis.scale, mesh);
}

void AddGirdle(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  AddLoft({Curve({Vector3d::Zero(), EndOf(skeleton, segment)}), Vector3d::UnitZ(),
           Vector3d::UnitX(), GirthOf(skeleton)},
          GirdleProfile(), {0, 0.9, 0.030, 0.042, 20, 6}, mesh);
}

// The two lofts of an arm or leg: they meet at the middle joint (elbow, knee), which runs on.
struct LimbLofts {
  double from;  // of the upper part: the rest of it is one long cap, over the proximal joint
  double proximal_cap;  // m, as the following
  double middle_cap;
  double distal_cap;
  int upper_points, lower_points;  // around
  int upper_rings, lower_rings;
  int start_rings;  // of the long cap
};
constexpr LimbLofts kArmLofts = {0.12, 0.084, 0.039, 0.022, 16, 16, 8, 10, 6};
constexpr LimbLofts kLegLofts = {0.10, 0.118, 0.054, 0.036, 18, 16, 7, 10, 5};

void AddLimb(const Skeleton& skeleton, int segment, bool is_upper, const LimbLofts& limb,
             const Profile& profile, TriangleMesh& mesh) {
  LoftRange range;
  if (is_upper) {
    range.from = limb.from;
    range.start_cap = limb.proximal_cap;
    range.start_rings = limb.start_rings;
    range.end_cap = limb.middle_cap;
    range.end_runs_on = true;
  } else {
    range.from = 1;
    range.to = 2;
    range.start_cap = limb.middle_cap;
    range.end_cap = limb.distal_cap;
    range.start_runs_on = true;
  }
  range.points = is_upper ? limb.upper_points : limb.lower_points;
  range.rings = is_upper ? limb.upper_rings : limb.lower_rings;
  const int upper = is_upper ? segment : segment - 1;
  AddLoft(ChainAxis(skeleton, upper, 2, segment, Outward(segment)), profile, range, mesh);
}

void AddArm(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const bool is_upper = segment == kRightUpperArm || segment == kLeftUpperArm;
  AddLimb(skeleton, segment, is_upper, kArmLofts, ArmProfile(), mesh);
}

void AddLeg(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const bool is_thigh = segment == kRightUpperLeg || segment == kLeftUpperLeg;
  AddLimb(skeleton, segment, is_thigh, kLegLofts, LegProfile(), mesh);
}

void AddHand(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const LoftAxis hand = SegmentAxis(skeleton, segment, Outward(segment));
  const Vector3d along = hand.line.At(1);
  const Vector3d back = Outward(segment);
  LoftRange palm;
  palm.to = 0.46;
  palm.start_cap = 0.021;
  palm.end_cap = 0.016;
  palm.points = 14;
  palm.rings = 5;
  palm.start_rings = palm.end_rings = 3;
  AddLoft(hand, PalmProfile(), palm, mesh);

  const auto add_digit = [&](const Vector3d& base, const Vector3d& middle, const Vector3d& tip,
                             double radius) {
    // The rounded end reaches the tip.
    const double end_cap = FingerProfile().At(2)[Section::kPlusU] * radius;
    const Vector3d last = tip - hand.scale * end_cap * (tip - middle).normalized();
    LoftRange range;
    range.to = 2;
    range.start_cap = 0.5;  // in radii, as the profile is
    range.end_cap = end_cap / radius;
    range.points = 8;
    range.rings = 4;
    range.start_rings = 1;
    range.end_rings = 2;
    AddLoft({Curve({base, middle, last}), hand.u, hand.v, hand.scale * radius}, FingerProfile(),
            range, mesh);
  };
  for (const Finger& finger : kDigits) {
    // A hand at rest: the fingers bend a little towards the palm.
    const double middle_at = finger.base_at + 0.42 * (finger.tip_at - finger.base_at);
    const double middle_u = finger.base_u + 0.42 * (finger.tip_u - finger.base_u);
    add_digit(finger.base_at * along + hand.scale * finger.base_u * hand.u,
              middle_at * along + hand.scale * (middle_u * hand.u - 0.004 * back),
              finger.tip_at * along + hand.scale * (finger.tip_u * hand.u - 0.022 * back),
              finger.radius);
  }
  // The thumb springs from the base of the palm and leans to the front.
  const Vector3d root = 0.15 * along + hand.scale * (0.016 * hand.u - 0.005 * back);
  const Vector3d joint = 0.37 * along + hand.scale * (0.045 * hand.u - 0.014 * back);
  const Vector3d tip = 0.59 * along + hand.scale * (0.060 * hand.u - 0.026 * back);
  add_digit(root, joint, tip, 0.0138);
}

void AddFoot(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const Side side = IsLeft(segment) ? kLeft : kRight;
  const Vector3d& heel = skeleton.heel_in_foot[side];
  const Vector3d& ball = EndOf(skeleton, segment);
  // The instep follows the height of the ankle, which is measured; the ball is the toes'.
  constexpr double kReferenceAnkle = 0.080;  // m
  const double tall = std::clamp(-heel.z() / (kReferenceAnkle * GirthOf(skeleton)), 0.8, 1.5);
  const Profile profile = FootProfile().Raised(
      [tall](double at) { return 1 + (tall - 1) * std::clamp(2 * (1 - at), 0.0, 1.0); });
  AddLoft({Curve({heel, Vector3d(ball.x(), ball.y(), heel.z())}), Vector3d::UnitZ(),
           Outward(segment), GirthOf(skeleton)},
          profile, {0.14, 1, 0.038, 0.020, 18, 8, 5, 3}, mesh);
}

void AddToe(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const Vector3d& tip = EndOf(skeleton, segment);
  AddLoft({Curve({Vector3d(0, 0, tip.z()), tip}), Vector3d::UnitZ(), Outward(segment),
           GirthOf(skeleton)},
          ToeProfile(), {0, 0.55, 0.020, 0.0315, 18, 5}, mesh);
}

}  // namespace

TriangleMesh SegmentMesh(const Skeleton& skeleton, int segment) {
  TriangleMesh mesh;
  switch (segment) {
    case kHead: AddHead(skeleton, mesh); break;
    case kRightShoulder:
    case kLeftShoulder: AddGirdle(skeleton, segment, mesh); break;
    case kRightUpperArm:
    case kLeftUpperArm:
    case kRightForeArm:
    case kLeftForeArm: AddArm(skeleton, segment, mesh); break;
    case kRightHand:
    case kLeftHand: AddHand(skeleton, segment, mesh); break;
    case kRightUpperLeg:
    case kLeftUpperLeg:
    case kRightLowerLeg:
    case kLeftLowerLeg: AddLeg(skeleton, segment, mesh); break;
    case kRightFoot:
    case kLeftFoot: AddFoot(skeleton, segment, mesh); break;
    case kRightToe:
    case kLeftToe: AddToe(skeleton, segment, mesh); break;
    default: AddTrunk(skeleton, segment, mesh);
  }
  return mesh;
}

std::string ToBinaryStl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const std::string title = "human segment, metres";  // must not begin with "solid": that is ASCII
  bytes.replace(0, title.size(), title);
  const auto append_u32 = [&](std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
  };
  const auto append = [&](const Eigen::Vector3f& v) {
    for (const float value : {v.x(), v.y(), v.z()}) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      append_u32(bits);
    }
  };
  append_u32(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f& corner = mesh.vertices[a];
    append((mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).normalized());
    for (const std::uint32_t i : {a, b, c}) append(mesh.vertices[i]);
    bytes.append(2, '\0');  // attribute byte count
  }
  return bytes;
}

}  // namespace kinescope::urdf
