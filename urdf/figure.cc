#include "urdf/figure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "urdf/loft.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

// All measures below are those of a person of this stature; girths of others are in proportion.
constexpr double kReferenceHeight = 1.75;

double GirthOf(const Skeleton& skeleton) {
  // Whatever a stream claims, a person is between a toddler and a giant.
  return std::clamp(skeleton.height, 0.3, 3.0) / kReferenceHeight;
}

bool IsLeft(int segment) {
  return (segment >= kLeftShoulder && segment <= kLeftHand) || segment >= kLeftUpperLeg;
}

// Away from the middle of the body.
Vector3d Outward(int segment) { return {0, IsLeft(segment) ? 1.0 : -1.0, 0}; }

// Trunk and neck are one profile, so that the outline runs on across their joints: 0 is at the
// hips, then a whole number for each joint upwards; 6 is C1. u is forward, v to the left.
const Profile& TrunkProfile() {
  const auto oval = [](double at, double front, double back, double side, double power) {
    return Widths(at, front, back, side, side).Power(power, power);
  };
  static const Profile kProfile(
      {oval(0.25, .097, .115, .166, 2.2), oval(0.55, .099, .112, .162, 2.2),
       oval(1.00, .097, .098, .147, 2.2), oval(1.50, .095, .087, .137, 2.2),
       oval(2.00, .095, .084, .131, 2.2), oval(2.50, .099, .086, .132, 2.2),
       oval(3.00, .106, .092, .138, 2.2), oval(3.50, .114, .100, .146, 2.2),
       oval(4.00, .119, .107, .153, 2.2), oval(4.30, .118, .110, .155, 2.2),
       oval(4.57, .104, .106, .146, 2.2), oval(4.80, .078, .088, .103, 2.1),
       oval(5.00, .060, .070, .068, 2.0), oval(5.25, .054, .060, .057, 2.0),
       oval(6.00, .050, .050, .050, 2.0)});
  return kProfile;
}

// Thigh (0 to 1) and shank (1 to 2). u is forward, v outward.
const Profile& LegProfile() {
  static const Profile kProfile(
      {Widths(0.10, .084, .094, .081, .080), Widths(0.22, .087, .089, .083, .080),
       Widths(0.40, .086, .080, .078, .076), Widths(0.70, .069, .065, .063, .064),
       Widths(0.90, .058, .055, .055, .057), Widths(1.00, .057, .052, .054, .054),
       Widths(1.10, .051, .054, .052, .053), Widths(1.26, .045, .067, .056, .056),
       Widths(1.42, .042, .063, .051, .052), Widths(1.62, .037, .047, .041, .041),
       Widths(1.82, .033, .036, .034, .034), Widths(2.00, .035, .037, .036, .036)});
  return kProfile;
}

// Upper arm (0 to 1) and forearm (1 to 2). u is forward, v outward.
const Profile& ArmProfile() {
  static const Profile kProfile(
      {Widths(0.12, .056, .055, .059, .050), Widths(0.22, .055, .053, .056, .047),
       Widths(0.36, .050, .047, .049, .044), Widths(0.56, .049, .046, .043, .042),
       Widths(0.80, .041, .040, .040, .040), Widths(1.00, .038, .040, .041, .040),
       Widths(1.14, .042, .040, .043, .041), Widths(1.32, .041, .038, .040, .038),
       Widths(1.56, .034, .033, .032, .031), Widths(1.82, .028, .028, .024, .024),
       Widths(2.00, .028, .028, .021, .021)});
  return kProfile;
}

// From the middle (0) to the shoulder joint (1). u is up, v forward.
const Profile& GirdleProfile() {
  static const Profile kProfile(
      {Widths(0.0, .072, .060, .060, .078), Widths(0.4, .057, .060, .060, .072),
       Widths(0.8, .046, .052, .050, .054), Widths(1.0, .043, .048, .045, .045)});
  return kProfile;
}

// From the wrist (0) over the knuckles to where the fingers part; 1 is the tip of the middle
// finger. u is towards the thumb, v the back of the hand.
const Profile& PalmProfile() {
  const auto flat = [](double at, double thumb, double small, double thick) {
    return Widths(at, thumb, small, thick, thick).Power(2.6, 2.6);
  };
  static const Profile kProfile({flat(0.00, .028, .028, .021).Power(2, 2),
                                 flat(0.14, .032, .031, .018), flat(0.30, .040, .038, .017),
                                 flat(0.44, .042, .040, .0145), flat(0.52, .039, .038, .0115)});
  return kProfile;
}

struct Finger {
  double base_u, base_at;  // knuckle: across (m, towards the thumb) and along the hand
  double tip_u, tip_at;
  double radius;  // m, at the base
};

constexpr std::array<Finger, 4> kDigits = {{{.0300, .46, .0370, .92, .0092},
                                            {.0100, .49, .0120, 1.00, .0096},
                                            {-.0100, .48, -.0130, .94, .0092},
                                            {-.0290, .44, -.0370, .79, .0080}}};

// Base (0), middle joint (1) and tip (2) of a finger, or root and tip of the thumb.
const Profile& FingerProfile() {
  const auto round = [](double at, double radius) {
    return Widths(at, radius, radius, radius, radius);
  };
  static const Profile kProfile({round(0, 1), round(1, .93), round(2, .72)});
  return kProfile;
}

// From C1 (0) to the crown (1), and down to the chin. u is forward, v to the left.
const Profile& HeadProfile() {
  const auto egg = [](double at, double front, double back, double side, double center) {
    return Widths(at, front - center, back + center, side, side).Center(center, 0);
  };
  static const Profile kProfile(
      {egg(-0.23, .086, -.026, .030, .056), egg(-0.13, .097, .022, .047, .040),
       egg(0.00, .099, .060, .060, .024), egg(0.20, .099, .083, .0715, .012),
       egg(0.33, .098, .0905, .0755, .006), egg(0.44, .097, .092, .076, .002)});
  return kProfile;
}

// Along the sole from the back of the heel (0) to the ball (1). u is up, v outward; the underside
// is flat.
const Profile& FootProfile() {
  const auto shoe = [](double at, double height, double side, double inward) {
    const double center = 0.36 * height;
    return Widths(at, height - center, center, side, side).Center(center, -inward).Power(2.0, 3.5);
  };
  static const Profile kProfile({shoe(0.14, .084, .033, 0), shoe(0.30, .094, .035, 0),
                                 shoe(0.48, .080, .036, 0), shoe(0.72, .060, .042, .002),
                                 shoe(1.00, .047, .046, .003)});
  return kProfile;
}

const Profile& ToeProfile() {
  const auto shoe = [](double at, double height, double side, double inward) {
    const double center = 0.38 * height;
    return Widths(at, height - center, center, side, side).Center(center, -inward).Power(2.0, 3.5);
  };
  static const Profile kProfile(
      {shoe(0.0, .047, .046, .003), shoe(0.45, .040, .044, .005), shoe(0.85, .030, .033, .009)});
  return kProfile;
}

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
  AddLoft(ChainAxis(skeleton, kPelvis, 6, segment, Vector3d::UnitY()), profile, range, mesh);
}

// How much a bump centred at 0 with this half-width has left at x.
double Bump(double x, double width) { return std::exp(-(x * x) / (width * width)); }

// Nose, brow, eyes, lips and chin: how far forward the face is at (y, z), which are fractions of
// the head's length from C1 to the crown.
double FaceRelief(double y, double z) {
  const double across = Bump(y, 0.075);
  const double nose = z < 0.21 ? Bump(z - 0.21, 0.05) : Bump(z - 0.21, 0.16);
  const double eyes = Bump(std::abs(y) - 0.17, 0.09) * Bump(z - 0.40, 0.06);
  const double brow = Bump(y, 0.30) * Bump(z - 0.50, 0.06);
  const double lips = Bump(y, 0.14) * Bump(z - 0.035, 0.05);
  const double chin = Bump(y, 0.14) * Bump(z + 0.16, 0.06);
  return 0.115 * nose * across - 0.040 * eyes + 0.018 * brow + 0.024 * lips + 0.030 * chin;
}

void AddHead(const Skeleton& skeleton, TriangleMesh& mesh) {
  LoftAxis axis = SegmentAxis(skeleton, kHead, Vector3d::UnitY());
  // Depth and width go with the height of the head, which is measured.
  const double length = std::max(EndOf(skeleton, kHead).norm(), 0.01);
  axis.scale = length / 0.190;
  LoftRange range;
  range.from = -0.23;
  range.to = 0.44;
  range.start_cap = 0.012;
  range.end_cap = (1 - range.to) * 0.190;  // up to the crown
  range.points = 26;
  range.rings = 12;
  range.start_rings = 2;
  range.end_rings = 8;
  range.crowd_u = 0.62;  // in the face
  AddLoft(axis, HeadProfile(), range, mesh);
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3d at = vertex.cast<double>() / length;
    if (at.x() < 0.2) continue;  // the back of the head has no face
    vertex.x() += static_cast<float>(length * FaceRelief(at.y(), at.z()));
  }
  ComputeNormals(mesh);
}

void AddGirdle(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  AddLoft({Curve({Vector3d::Zero(), EndOf(skeleton, segment)}), Vector3d::UnitZ(),
           Vector3d::UnitX(), GirthOf(skeleton)},
          GirdleProfile(), {0, 1, 0.030, 0.042, 18, 6}, mesh);
}

void AddArm(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const bool is_upper = segment == kRightUpperArm || segment == kLeftUpperArm;
  LoftRange range;
  range.points = 16;
  if (is_upper) {
    range.rings = 8;
    range.from = 0.12;  // the rest of it is the deltoid: one long cap, over the joint
    range.start_cap = 0.086;
    range.start_rings = 6;
    range.end_cap = 0.039;
    range.end_runs_on = true;
  } else {
    range.from = 1;
    range.to = 2;
    range.start_cap = 0.039;
    range.end_cap = 0.022;
    range.rings = 10;
    range.start_runs_on = true;
  }
  const int upper = is_upper ? segment : segment - 1;
  AddLoft(ChainAxis(skeleton, upper, 2, segment, Outward(segment)), ArmProfile(), range, mesh);
}

void AddHand(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const LoftAxis hand = SegmentAxis(skeleton, segment, Outward(segment));
  const Vector3d along = hand.line.At(1);
  const Vector3d back = Outward(segment);
  LoftRange palm;
  palm.to = 0.46;
  palm.start_cap = 0.021;
  palm.end_cap = 0.012;
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
  const Vector3d root = 0.20 * along + hand.scale * (0.020 * hand.u - 0.004 * back);
  const Vector3d joint = 0.38 * along + hand.scale * (0.046 * hand.u - 0.012 * back);
  const Vector3d tip = 0.57 * along + hand.scale * (0.060 * hand.u - 0.022 * back);
  add_digit(root, joint, tip, 0.0125);
}

void AddLeg(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const bool is_thigh = segment == kRightUpperLeg || segment == kLeftUpperLeg;
  LoftRange range;
  range.points = 16;
  if (is_thigh) {
    range.from = 0.10;  // the rest of it is one long cap, within the pelvis while standing
    range.start_cap = 0.118;
    range.start_rings = 5;
    range.end_cap = 0.054;
    range.end_runs_on = true;
    range.rings = 9;
  } else {
    range.from = 1;
    range.to = 2;
    range.start_cap = 0.054;
    range.end_cap = 0.036;
    range.rings = 10;
    range.start_runs_on = true;
  }
  const int thigh = is_thigh ? segment : segment - 1;
  AddLoft(ChainAxis(skeleton, thigh, 2, segment, Outward(segment)), LegProfile(), range, mesh);
}

void AddFoot(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const Side side = IsLeft(segment) ? kLeft : kRight;
  const Vector3d& heel = skeleton.heel_in_foot[side];
  const Vector3d& ball = EndOf(skeleton, segment);
  AddLoft({Curve({heel, Vector3d(ball.x(), ball.y(), heel.z())}), Vector3d::UnitZ(),
           Outward(segment), GirthOf(skeleton)},
          FootProfile(), {0.14, 1, 0.038, 0.020, 18, 8, 5, 3}, mesh);
}

void AddToe(const Skeleton& skeleton, int segment, TriangleMesh& mesh) {
  const Vector3d& tip = EndOf(skeleton, segment);
  AddLoft({Curve({Vector3d(0, 0, tip.z()), tip}), Vector3d::UnitZ(), Outward(segment),
           GirthOf(skeleton)},
          ToeProfile(), {0, 0.85, 0.020, 0.016, 18, 5}, mesh);
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
