// The tables other than the default one. Their trunks have fewer parts than MVN's, and they lack
// values that the default has: each function says what it takes from there.
#include "urdf/body_tables.h"

#include <cmath>
#include <initializer_list>

#include "urdf/primitive_body.h"

namespace kinescope::urdf {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Segments = std::initializer_list<int>;

// What the coarser tables call thorax and abdomen, in MVN's segments. With the pelvis as one piece,
// the mass above L5/S1 is what joint-loads.md 1.5 quotes of each table.
const Segments kThorax = {kT12, kT8, kRightShoulder, kLeftShoulder};
const Segments kAbdomen = {kL5, kL3};
const Segments kHeadAndNeck = {kNeck, kHead};

struct BothSides {
  int right, left;
};
constexpr BothSides kUpperArms = {kRightUpperArm, kLeftUpperArm};
constexpr BothSides kForeArms = {kRightForeArm, kLeftForeArm};
constexpr BothSides kHands = {kRightHand, kLeftHand};
constexpr BothSides kUpperLegs = {kRightUpperLeg, kLeftUpperLeg};
constexpr BothSides kLowerLegs = {kRightLowerLeg, kLeftLowerLeg};
constexpr BothSides kFeet = {kRightFoot, kLeftFoot};

// Gives `segments` together `mass`, shared as the default table does.
void Share(double mass, const Segments& segments, BodyShares& shares) {
  double sum = 0;
  for (const int i : segments) sum += shares[At(i)].mass;
  for (const int i : segments) shares[At(i)].mass *= mass / sum;
}

void ShareFoot(double mass, BodyShares& shares) {
  for (const int foot : {kFeet.right, kFeet.left}) {
    shares[At(foot)].mass = (1 - kToeShareOfFoot) * mass;
    shares[At(foot + 1)].mass = kToeShareOfFoot * mass;
  }
}

Matrix3d Squares(double kx, double ky, double kz) {
  return Vector3d(kx, ky, kz).cwiseAbs2().asDiagonal();
}

// Moves the CoMs of `segments` together, so that their common one is at `target` (N-pose, from the
// pelvis).
void MoveTogether(const Vector3d& target, const Segments& segments, const Skeleton& skeleton,
                  BodyShares& shares) {
  std::array<Vector3d, kSegmentCount> origin;
  origin[kPelvis] = Vector3d::Zero();
  for (int i = 1; i < kSegmentCount; ++i) {
    origin[At(i)] = origin[At(kSegments[At(i)].parent)] + skeleton.origin_in_parent[At(i)];
  }
  Vector3d sum = Vector3d::Zero();
  double mass = 0;
  for (const int i : segments) {
    sum += shares[At(i)].mass * (origin[At(i)] + shares[At(i)].com_in_link);
    mass += shares[At(i)].mass;
  }
  for (const int i : segments) shares[At(i)].com_in_link += target - sum / mass;
}

}  // namespace

Vector3d FootComWithoutToes(const Vector3d& whole_com_in_foot, const Vector3d& toe_com_in_toe,
                            const Vector3d& toe_in_foot) {
  return (whole_com_in_foot - kToeShareOfFoot * (toe_in_foot + toe_com_in_toe)) /
         (1 - kToeShareOfFoot);
}

// Head and neck, and the parts of the trunk, have their CoM and radii from the default table
// (Winter has none of the parts), and so have radii about the long axes.
BodyShares WinterShares(Sex sex, const Skeleton& skeleton) {
  BodyShares shares = DeLevaShares(sex, skeleton);
  Share(0.081, kHeadAndNeck, shares);
  Share(0.216, kThorax, shares);
  Share(0.139, kAbdomen, shares);
  shares[kPelvis].mass = 0.142;
  ShareFoot(0.0145, shares);

  // Wrist to knuckle III, of wrist to finger tip: de Leva's hands, 86.2 and 187.9 mm.
  constexpr double kKnuckle = 86.2 / 187.9;
  struct Row {
    BothSides limb;
    double mass, com, radius;
    double length = 1;  // of the table's segment, of ours
  };
  const Row rows[] = {{kHands, 0.006, 0.506, 0.297, kKnuckle},
                      {kForeArms, 0.016, 0.430, 0.303},
                      {kUpperArms, 0.028, 0.436, 0.322},
                      {kLowerLegs, 0.0465, 0.433, 0.302},
                      {kUpperLegs, 0.100, 0.433, 0.323}};
  for (const Row& row : rows) {
    for (const int i : {row.limb.right, row.limb.left}) {
      SegmentShare& share = shares[At(i)];
      const double length = row.length * EndOf(skeleton, i).norm();
      const double k = row.radius * length;
      share.mass = row.mass;
      share.com_in_link = {0, 0, -row.com * length};
      share.inertia_by_mass = Squares(k, k, std::sqrt(share.inertia_by_mass(2, 2)));
    }
  }
  for (const int i : {kFeet.right, kFeet.left}) {  // malleolus to second metatarsal, our ball
    const Vector3d ball = EndOf(skeleton, i);
    const double k = 0.475 * ball.norm();
    shares[At(i)].com_in_link = FootComWithoutToes(0.5 * ball, shares[At(i + 1)].com_in_link, ball);
    shares[At(i)].inertia_by_mass = Squares(std::sqrt(shares[At(i)].inertia_by_mass(0, 0)), k, k);
  }
  return shares;
}

// The parts of head and trunk keep the default's shares of their part's mass, their distances and
// radii, and are moved together to where Dumas has the part's CoM. ISB axes (x forward, y up, z
// right) of the right side in the anatomical pose: palms forward, so that forearm and hand are a
// quarter turn from our link frames, whose x is the thumb's side.
BodyShares DumasShares(Sex sex, const Skeleton& skeleton) {
  struct Row {
    double mass;
    Vector3d com, radii;  // ISB axes, percent of length
  };
  struct Table {
    Row head, thorax, abdomen, pelvis, upper_arm, fore_arm, hand, thigh, shank, foot;
  };
  static const Table kMale = {
      {6.7, {2.0, 53.6, 0.1}, {28, 21, 30}},    {30.4, {0, -55.5, -0.4}, {42, 33, 36}},
      {2.9, {17.3, -36.1, -0.3}, {54, 66, 40}}, {14.2, {2.8, -28.0, -0.6}, {101, 106, 95}},
      {2.4, {1.7, -45.2, -2.6}, {31, 14, 32}},  {1.7, {1.0, -41.7, 1.4}, {28, 11, 27}},
      {0.6, {3.5, -35.7, 3.2}, {26, 16, 24}},   {12.3, {-4.1, -42.9, 3.3}, {29, 15, 30}},
      {4.8, {-4.8, -41.0, 0.7}, {28, 10, 28}},  {1.2, {38.2, -15.1, 2.6}, {17, 37, 36}}};
  static const Table kFemale = {
      {6.7, {1.6, 57.5, 0.1}, {29, 23, 30}},    {26.3, {2.1, -52.8, 0.1}, {39, 33, 35}},
      {4.1, {24.4, -41.5, 0.5}, {67, 77, 55}},  {14.6, {-0.9, -23.2, 0.2}, {91, 100, 79}},
      {2.2, {-7.3, -45.4, -2.8}, {33, 17, 33}}, {1.3, {2.1, -41.1, 1.9}, {26, 14, 25}},
      {0.5, {3.3, -32.7, 2.1}, {27, 18, 25}},   {14.6, {-7.7, -37.7, 0.9}, {31, 19, 32}},
      {4.5, {-4.9, -40.4, 3.1}, {28, 10, 28}},  {1.0, {27.0, -21.8, 3.9}, {17, 36, 35}}};
  const Table& table = sex == Sex::kMale ? kMale : kFemale;
  const auto in_link = [](const Vector3d& isb) { return Vector3d(isb.x(), -isb.z(), isb.y()); };
  const auto percent = [&](const Row& row, double length) -> Vector3d {
    return 0.01 * length * in_link(row.com);
  };
  const auto& origin = skeleton.origin_in_parent;
  BodyShares shares = DeLevaShares(sex, skeleton);

  Share(table.head.mass, kHeadAndNeck, shares);
  Share(table.thorax.mass, kThorax, shares);
  Share(table.abdomen.mass, kAbdomen, shares);
  shares[kPelvis].mass = table.pelvis.mass;
  const Vector3d l5s1 = origin[kL5];
  const Vector3d l1t12 = l5s1 + origin[kL3] + origin[kT12];
  const Vector3d c7t1 = l1t12 + origin[kT8] + origin[kNeck];
  const Vector3d crown = c7t1 + origin[kHead] + skeleton.head_top_in_head;
  MoveTogether(c7t1 + percent(table.head, (crown - c7t1).norm()), kHeadAndNeck, skeleton, shares);
  MoveTogether(c7t1 + percent(table.thorax, (l1t12 - c7t1).norm()), kThorax, skeleton, shares);
  MoveTogether(l1t12 + percent(table.abdomen, (l5s1 - l1t12).norm()), kAbdomen, skeleton, shares);
  shares[kPelvis].com_in_link = l5s1 + percent(table.pelvis, l5s1.norm());
  const Vector3d pelvis_radii = 0.01 * l5s1.norm() * table.pelvis.radii;
  shares[kPelvis].inertia_by_mass = Squares(pelvis_radii.x(), pelvis_radii.z(), pelvis_radii.y());

  const std::pair<BothSides, const Row*> limbs[] = {
      {kUpperArms, &table.upper_arm}, {kForeArms, &table.fore_arm}, {kHands, &table.hand},
      {kUpperLegs, &table.thigh},     {kLowerLegs, &table.shank},   {kFeet, &table.foot}};
  for (const auto& [limb, row] : limbs) {
    const bool palm_turns = limb.right == kForeArms.right || limb.right == kHands.right;
    for (const int i : {limb.right, limb.left}) {
      const double length = EndOf(skeleton, i).norm();
      // Palm forward (ISB x) is towards the body (y of the right hand) when the thumb is forward.
      Vector3d com =
          palm_turns ? Vector3d(row->com.z(), row->com.x(), row->com.y()) : in_link(row->com);
      const Vector3d k = palm_turns ? Vector3d(row->radii.z(), row->radii.x(), row->radii.y())
                                    : Vector3d(row->radii.x(), row->radii.z(), row->radii.y());
      if (i == limb.left) com.y() = -com.y();
      const double scale = 0.01 * length;
      shares[At(i)].mass = row->mass;
      shares[At(i)].com_in_link = scale * com;
      shares[At(i)].inertia_by_mass = Squares(scale * k.x(), scale * k.y(), scale * k.z());
    }
  }
  ShareFoot(table.foot.mass, shares);
  for (const int i : {kFeet.right, kFeet.left}) {
    shares[At(i)].com_in_link = FootComWithoutToes(
        shares[At(i)].com_in_link, shares[At(i + 1)].com_in_link, EndOf(skeleton, i));
  }
  return shares;
}

// Each segment is one solid with its CoM in the middle; the solids are those of the primitive
// figure.
BodyShares IitShares(const Skeleton& skeleton) {
  static constexpr double kMass[kSegmentCount] = {
      0.080, 0.102,  0.102,  0.102,    // pelvis, L5, L3, T12
      0.040, 0.012,  0.036,            // T8, neck, head
      0.031, 0.030,  0.020,  0.006,    // shoulder to hand, right
      0.031, 0.030,  0.020,  0.006,    // left
      0.125, 0.0365, 0.0130, 0.0015,   // thigh to toe, right
      0.125, 0.0365, 0.0130, 0.0015};  // left
  BodyShares shares;
  for (int i = 0; i < kSegmentCount; ++i) {
    const Primitive solid = PrimitiveBody(skeleton, i).front();
    SegmentShare& share = shares[At(i)];
    share.mass = kMass[i];
    share.com_in_link = solid.center;
    const Vector3d& size = solid.size;
    const double r = size.x();
    switch (solid.kind) {
      case Primitive::Kind::kBox: {
        const Vector3d squares = size.cwiseAbs2() / 12;
        share.inertia_by_mass = (Vector3d::Constant(squares.sum()) - squares).asDiagonal();
        break;
      }
      case Primitive::Kind::kCylinder: {
        const Vector3d axis = EndOf(skeleton, i).normalized();
        const double across = (3 * r * r + size.y() * size.y()) / 12;
        share.inertia_by_mass =
            across * Matrix3d::Identity() + (r * r / 2 - across) * axis * axis.transpose();
        break;
      }
      case Primitive::Kind::kSphere:
        share.inertia_by_mass = 0.4 * r * r * Matrix3d::Identity();
        break;
    }
  }
  return shares;
}

}  // namespace kinescope::urdf
