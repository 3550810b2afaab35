// joint-loads.md 1.5: de Leva, J. Biomech. 29 (1996) 1223, split onto the MVN joints.
#include <cmath>

#include "urdf/body_tables.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

enum class RadiiShareOf { kStature, kLength };

struct Column {
  double mass_percent;
  double com_fraction;  // of the segment's length, from its origin
  double kx, ky, kz;    // radii of gyration, as fractions
};

struct Row {
  RadiiShareOf radii_of;
  Column male, female;
};

// joint-loads.md 1.5. Rows by segment; right and left share one. The CoM fraction of the foot is
// that of the whole foot, heel to toe tip.
constexpr Row kPelvisRow = {
    RadiiShareOf::kStature, {10.88, 0.40, .0507, .0453, .0491}, {9.40, 0.51, .0409, .0372, .0464}};
constexpr Row kL5Row = {
    RadiiShareOf::kStature, {6.96, 0.55, .0513, .0368, .0576}, {7.30, 0.48, .0412, .0328, .0480}};
constexpr Row kL3Row = {
    RadiiShareOf::kStature, {8.86, 0.52, .0507, .0355, .0579}, {7.99, 0.52, .0420, .0299, .0491}};
constexpr Row kT12Row = {
    RadiiShareOf::kStature, {6.99, 0.46, .0567, .0270, .0580}, {7.61, 0.46, .0436, .0259, .0480}};
constexpr Row kT8Row = {
    RadiiShareOf::kStature, {5.78, 0.43, .0600, .0311, .0581}, {6.41, 0.44, .0478, .0298, .0480}};
constexpr Row kNeckRow = {
    RadiiShareOf::kLength, {1.39, 0.50, .33, .33, .23}, {1.34, 0.50, .33, .33, .23}};
constexpr Row kHeadRow = {
    RadiiShareOf::kLength, {5.55, 0.45, .30, .32, .33}, {5.34, 0.45, .30, .32, .33}};
constexpr Row kShoulderRow = {
    RadiiShareOf::kLength, {1.995, 0.50, .30, .125, .30}, {1.93, 0.50, .30, .125, .30}};
constexpr Row kUpperArmRow = {
    RadiiShareOf::kLength, {2.71, 0.5772, .285, .269, .158}, {2.55, 0.5754, .278, .260, .148}};
constexpr Row kForeArmRow = {
    RadiiShareOf::kLength, {1.62, 0.4574, .265, .276, .121}, {1.38, 0.4559, .257, .261, .094}};
constexpr Row kHandRow = {
    RadiiShareOf::kLength, {0.61, 0.3624, .235, .288, .184}, {0.56, 0.3427, .208, .244, .154}};
constexpr Row kUpperLegRow = {
    RadiiShareOf::kLength, {14.16, 0.4095, .329, .329, .149}, {14.78, 0.3612, .369, .364, .162}};
constexpr Row kLowerLegRow = {
    RadiiShareOf::kLength, {4.33, 0.4395, .251, .246, .102}, {4.81, 0.4352, .267, .263, .092}};
constexpr Row kFootRow = {
    RadiiShareOf::kLength, {1.233, 0.4415, .124, .257, .245}, {1.161, 0.4014, .139, .299, .279}};
constexpr Row kToeRow = {
    RadiiShareOf::kLength, {0.137, 0.50, .40, .40, .40}, {0.129, 0.50, .40, .40, .40}};

const Row& RowOf(int segment) {
  switch (segment) {
    case kPelvis: return kPelvisRow;
    case kL5: return kL5Row;
    case kL3: return kL3Row;
    case kT12: return kT12Row;
    case kT8: return kT8Row;
    case kNeck: return kNeckRow;
    case kHead: return kHeadRow;
    case kRightShoulder:
    case kLeftShoulder: return kShoulderRow;
    case kRightUpperArm:
    case kLeftUpperArm: return kUpperArmRow;
    case kRightForeArm:
    case kLeftForeArm: return kForeArmRow;
    case kRightHand:
    case kLeftHand: return kHandRow;
    case kRightUpperLeg:
    case kLeftUpperLeg: return kUpperLegRow;
    case kRightLowerLeg:
    case kLeftLowerLeg: return kLowerLegRow;
    case kRightFoot:
    case kLeftFoot: return kFootRow;
    default: return kToeRow;
  }
}

const Column& ColumnOf(int segment, Sex sex) {
  const Row& row = RowOf(segment);
  return sex == Sex::kMale ? row.male : row.female;
}

struct FootGeometry {
  double heel_x, ball_x, tip_x;  // from the ankle, foot frame
  double ankle_height;
  double toe_length;
};

FootGeometry FootOf(const Skeleton& skeleton, Side side) {
  const int toe = side == kRight ? kRightToe : kLeftToe;
  const double ball_x = skeleton.origin_in_parent[At(toe)].x();
  const double toe_length = skeleton.toe_tip_in_toe[side].x();
  return {skeleton.heel_in_foot[side].x(), ball_x, ball_x + toe_length,
          -skeleton.heel_in_foot[side].z(), toe_length};
}

Side SideOfFoot(int segment) {
  return segment == kRightFoot || segment == kRightToe ? kRight : kLeft;
}

// Axis along which the table measures a segment: +z trunk, +-y shoulder, -z limbs, +x toe.
Vector3d ComInLink(int segment, const Column& column, const Skeleton& skeleton) {
  const double f = column.com_fraction;
  const double length = EndOf(skeleton, segment).norm();
  switch (segment) {
    case kPelvis:
    case kL5:
    case kL3:
    case kT12:
    case kT8:
    case kNeck:
    case kHead: return {0, 0, f * std::abs(EndOf(skeleton, segment).z())};
    case kRightShoulder: return {0, -f * length, 0};
    case kLeftShoulder: return {0, f * length, 0};
    case kRightToe:
    case kLeftToe: return {f * FootOf(skeleton, SideOfFoot(segment)).toe_length, 0, 0};
    case kRightFoot:
    case kLeftFoot: {
      const FootGeometry foot = FootOf(skeleton, SideOfFoot(segment));
      const double toe_com_x = foot.ball_x + 0.5 * foot.toe_length;
      // The whole foot's CoM is known; a tenth of its mass is the toe segment.
      const double whole_x = foot.heel_x + f * (foot.tip_x - foot.heel_x);
      return {(whole_x - kToeShareOfFoot * toe_com_x) / (1 - kToeShareOfFoot), 0,
              -0.5 * foot.ankle_height};
    }
    default: return {0, 0, -f * length};
  }
}

double RadiiReference(int segment, const Skeleton& skeleton) {
  if (RowOf(segment).radii_of == RadiiShareOf::kStature) return skeleton.height;
  switch (segment) {
    case kRightFoot:
    case kLeftFoot: {
      const FootGeometry foot = FootOf(skeleton, SideOfFoot(segment));
      return foot.tip_x - foot.heel_x;
    }
    case kRightToe:
    case kLeftToe: return FootOf(skeleton, SideOfFoot(segment)).toe_length;
    case kHead:
    case kNeck: return std::abs(EndOf(skeleton, segment).z());
    default: return EndOf(skeleton, segment).norm();
  }
}

}  // namespace

BodyShares DeLevaShares(Sex sex, const Skeleton& skeleton) {
  BodyShares shares;
  for (int i = 0; i < kSegmentCount; ++i) {
    const Column& column = ColumnOf(i, sex);
    const double s = RadiiReference(i, skeleton);
    shares[At(i)].mass = column.mass_percent;
    shares[At(i)].com_in_link = ComInLink(i, column, skeleton);
    shares[At(i)].inertia_by_mass =
        Vector3d(column.kx * s, column.ky * s, column.kz * s).cwiseAbs2().asDiagonal();
  }
  return shares;
}

}  // namespace kinescope::urdf
