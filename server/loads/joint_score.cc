#include "server/loads/joint_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/load_class.h"
#include "core/system/errors.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;
using namespace urdf;

// Static strength of one joint, side and direction, N·m: joint-loads.md 4.2. The outer percentiles
// are 0 if not published.
struct Range {
  double p50, p5 = 0, p95 = 0;
};
struct Capacity {
  Range positive, negative;
};
struct BySex {
  Capacity male, female;
};
constexpr BySex kTrunkFlexion = {{{143, 75, 216}, {234, 164, 503}},
                                 {{75, 49, 161}, {184, 71, 287}}};
constexpr BySex kTrunkLateral = {{{159, 95, 261}, {159, 95, 261}}, {{94, 50, 162}, {94, 50, 162}}};
constexpr BySex kTrunkAxial = {{{70}, {70}}, {{45}, {45}}};
constexpr BySex kNeckFlexion = {{{30}, {51}}, {{15}, {21}}};
constexpr BySex kNeckLateral = {{{32}, {32}}, {{16}, {16}}};
constexpr BySex kNeckAxial = {{{13}, {13}}, {{6}, {6}}};
// The single values for the abducted arm: only the ratios of their percentiles are used.
constexpr BySex kShoulderAbduction = {{{71, 43, 101}, {71, 43, 101}}, {{37, 15, 57}, {37, 15, 57}}};
constexpr BySex kShoulderAxial = {{{52}, {33}}, {{21}, {19}}};
constexpr BySex kElbowFlexion = {{{77, 42, 111}, {46, 31, 67}}, {{41, 16, 55}, {27, 9, 39}}};
constexpr BySex kWristPalmar = {{{12.2}, {7.1}}, {{7.8}, {4.5}}};
constexpr BySex kWristRadial = {{{11.0}, {9.5}}, {{7.0}, {6.1}}};
constexpr BySex kHipFlexion = {{{185, 118, 342}, {190, 94, 309}}, {{126, 57, 177}, {97, 38, 180}}};
constexpr BySex kHipAbduction = {{{97}, {97}}, {{70}, {70}}};
constexpr BySex kHipAxial = {{{60}, {50}}, {{40}, {33}}};
constexpr BySex kKneeFlexion = {{{100, 58, 157}, {168, 84, 318}}, {{62, 22, 104}, {106, 52, 219}}};
constexpr BySex kAnkleDorsiflexion = {{{43}, {126, 69, 237}}, {{27}, {81, 31, 131}}};

constexpr const BySex* kAllCapacities[] = {
    &kTrunkFlexion, &kTrunkLateral, &kTrunkAxial,        &kNeckFlexion,
    &kNeckLateral,  &kNeckAxial,    &kShoulderAxial,     &kElbowFlexion,
    &kWristPalmar,  &kWristRadial,  &kShoulderAbduction, &kHipFlexion,
    &kHipAbduction, &kHipAxial,     &kKneeFlexion,       &kAnkleDorsiflexion};

const Capacity& Of(const BySex& by_sex, Sex sex) {
  return sex == Sex::kMale ? by_sex.male : by_sex.female;
}

double Outer(const Range& range, Percentile percentile) {
  return percentile == Percentile::k5 ? range.p5 : range.p95;
}

// Ratio of an outer percentile to the median, averaged over all directions that have both.
double MeanProportion(Sex sex, Percentile percentile) {
  double sum = 0;
  int count = 0;
  for (const BySex* by_sex : kAllCapacities) {
    for (const Range& range : {Of(*by_sex, sex).positive, Of(*by_sex, sex).negative}) {
      if (range.p5 == 0) continue;
      sum += Outer(range, percentile) / range.p50;
      ++count;
    }
  }
  return sum / count;
}

double Proportion(const Range& range, const Strength& strength) {
  if (strength.percentile == Percentile::k50) return 1;
  if (range.p5 > 0) return Outer(range, strength.percentile) / range.p50;
  static const std::array<std::array<double, 2>, 2> kMeans = {
      {{MeanProportion(Sex::kMale, Percentile::k5), MeanProportion(Sex::kMale, Percentile::k95)},
       {MeanProportion(Sex::kFemale, Percentile::k5),
        MeanProportion(Sex::kFemale, Percentile::k95)}}};
  return kMeans[strength.sex == Sex::kMale ? 0 : 1][strength.percentile == Percentile::k5 ? 0 : 1];
}

double CapacityFor(double moment, const BySex& by_sex, const Strength& strength) {
  const Capacity& capacity = Of(by_sex, strength.sex);
  const Range& range = moment >= 0 ? capacity.positive : capacity.negative;
  return strength.factor * range.p50 * Proportion(range, strength);
}

// One anatomical direction of a joint and its opposite: the component of the moment, and its sign.
struct Channel {
  enum Axis { kParentX, kParentY, kFloating, kChildZ } axis;
  double right_sign, left_sign;
  const BySex* capacity;
  std::string_view positive, negative;
};
struct Channels {
  std::array<Channel, 3> all;
  std::size_t size;
};
constexpr Channels kTrunk = {
    {{{Channel::kParentY, 1, 1, &kTrunkFlexion, "flexion", "extension"},
      {Channel::kFloating, 1, 1, &kTrunkLateral, "bend right", "bend left"},
      {Channel::kChildZ, 1, 1, &kTrunkAxial, "turn left", "turn right"}}},
    3};
constexpr Channels kNeckJoints = {
    {{{Channel::kParentY, 1, 1, &kNeckFlexion, "flexion", "extension"},
      {Channel::kFloating, 1, 1, &kNeckLateral, "bend right", "bend left"},
      {Channel::kChildZ, 1, 1, &kNeckAxial, "turn left", "turn right"}}},
    3};
constexpr Channels kShoulder = {
    {{{Channel::kChildZ, 1, -1, &kShoulderAxial, "internal rotation", "external rotation"}}}, 1};
constexpr Channels kElbow = {
    {{{Channel::kParentY, -1, -1, &kElbowFlexion, "flexion", "extension"}}}, 1};
constexpr Channels kWrist = {
    {{{Channel::kParentX, 1, -1, &kWristPalmar, "palmar flexion", "dorsal flexion"},
      {Channel::kParentY, -1, -1, &kWristRadial, "radial deviation", "ulnar deviation"}}},
    2};
constexpr Channels kHip = {
    {{{Channel::kParentY, -1, -1, &kHipFlexion, "flexion", "extension"},
      {Channel::kFloating, -1, 1, &kHipAbduction, "abduction", "adduction"},
      {Channel::kChildZ, 1, -1, &kHipAxial, "internal rotation", "external rotation"}}},
    3};
constexpr Channels kKnee = {{{{Channel::kParentY, 1, 1, &kKneeFlexion, "flexion", "extension"}}},
                            1};
constexpr Channels kAnkle = {
    {{{Channel::kParentY, -1, -1, &kAnkleDorsiflexion, "dorsiflexion", "plantar flexion"}}}, 1};
constexpr Channels kNotScored = {{}, 0};  // clavicle and ball of the foot

// By urdf::JointGroup.
constexpr std::array<const Channels*, kJointGroupCount> kChannels = {
    &kTrunk, &kNeckJoints, &kNotScored, &kShoulder, &kElbow,
    &kWrist, &kHip,        &kKnee,      &kAnkle,    &kNotScored};

const Channels& ChannelsOf(int joint) { return *kChannels[At(JointGroupOf(joint))]; }

bool IsShoulder(int joint) { return JointGroupOf(joint) == JointGroup::kShoulder; }

// The joint coordinate axes of MVN's ZXY angles.
struct Axes {
  std::array<Vector3d, 4> unit;  // by Channel::Axis
};

Axes AxesOf(int joint, const LinkPoses& links) {
  const Pose& parent = links[At(ParentOf(joint))];
  const Pose& child = links[At(ChildOf(joint))];
  Axes axes;
  axes.unit[Channel::kParentX] = parent.orientation * Vector3d::UnitX();
  axes.unit[Channel::kParentY] = parent.orientation * Vector3d::UnitY();
  axes.unit[Channel::kChildZ] = child.orientation * Vector3d::UnitZ();
  const Vector3d& y = axes.unit[Channel::kParentY];
  const Vector3d& z = axes.unit[Channel::kChildZ];
  constexpr double kAlmostParallel = 0.985;
  axes.unit[Channel::kFloating] = std::abs(z.dot(y)) > kAlmostParallel
                                      ? axes.unit[Channel::kParentX]
                                      : Vector3d(z.cross(-y).normalized());
  return axes;
}

// Decreases as the upper arm is raised relative to the trunk; half of it for women.
double ElevationCapacity(int joint, const LinkPoses& links, const Strength& strength) {
  const Vector3d trunk_up = links[kT8].orientation * Vector3d::UnitZ();
  const Vector3d arm_up = links[At(ChildOf(joint))].orientation * Vector3d::UnitZ();
  const double cosine = std::clamp(trunk_up.dot(arm_up), -1.0, 1.0);
  const double elevation_deg = std::min(std::acos(cosine) * 180 / M_PI, 120.0);
  const double male = 90 - 0.47 * elevation_deg;
  return strength.factor * (strength.sex == Sex::kMale ? male : 0.5 * male) *
         Proportion(Of(kShoulderAbduction, strength.sex).positive, strength);
}

class Best {
 public:
  void Try(double moment, double capacity, std::string_view channel) {
    const double ratio = std::abs(moment) / capacity;
    if (score_.channel.empty()) {
      score_ = {ratio, moment, capacity, channel};
    } else if (ratio > score_.ratio) {
      score_ = {ratio, moment, capacity, channel, score_.ratio, score_.channel};
    } else if (score_.next_channel.empty() || ratio > score_.next_ratio) {
      score_.next_ratio = ratio;
      score_.next_channel = channel;
    }
  }
  const Score& score() const { return score_; }

 private:
  Score score_;
};

}  // namespace

std::string FindDefect(const Strength& strength) {
  constexpr double kMin = 0.1, kMax = 5;
  if (strength.factor >= kMin && strength.factor <= kMax) return "";
  return fmt::format("capacity factor {}: expected {} to {}", strength.factor, kMin, kMax);
}

Score ScoreJoint(int joint, const Vector3d& moment, const LinkPoses& links,
                 const Strength& strength) {
  const Channels& channels = ChannelsOf(joint);
  const Axes axes = AxesOf(joint, links);
  Best best;
  if (IsShoulder(joint)) {  // elevation and rotation: no singularity with the arm sideways
    const Vector3d& along = axes.unit[Channel::kChildZ];
    best.Try((moment - moment.dot(along) * along).norm(), ElevationCapacity(joint, links, strength),
             "elevation");
  }
  for (std::size_t i = 0; i < channels.size; ++i) {
    const Channel& channel = channels.all[i];
    const double sign = IsLeftJoint(joint) ? channel.left_sign : channel.right_sign;
    const double value = sign * moment.dot(axes.unit[channel.axis]);
    best.Try(value, CapacityFor(value, *channel.capacity, strength),
             value >= 0 ? channel.positive : channel.negative);
  }
  return best.score();
}

Score ScoreNorm(int joint, const Vector3d& moment, const LinkPoses& links,
                const Strength& strength) {
  const Channels& channels = ChannelsOf(joint);
  if (channels.size == 0) return {};
  const BySex& flexion = *channels.all[0].capacity;
  const double capacity = IsShoulder(joint) ? ElevationCapacity(joint, links, strength)
                                            : std::min(CapacityFor(1, flexion, strength),
                                                       CapacityFor(-1, flexion, strength));
  Best best;
  best.Try(moment.norm(), capacity, "norm");
  return best.score();
}

LumbarLoad LumbarLoadOf(const Vector3d& force, const Vector3d& moment, const LinkPoses& links,
                        double lever_arm_m) {
  const Axes axes = AxesOf(jL5S1, links);
  const double flexion = moment.dot(axes.unit[Channel::kParentY]);
  const double lateral = moment.dot(axes.unit[Channel::kFloating]);
  const Vector3d x = links[kL5].orientation * Vector3d::UnitX();
  return {std::hypot(flexion, lateral) / lever_arm_m + force.dot(axes.unit[Channel::kChildZ]),
          force.dot(x)};
}

double LumbarRatio(const LumbarLoad& load, const std::array<double, 2>& limits) {
  constexpr auto kActionLimit = kCompressionLimits[0], kUpperLimit = kCompressionLimits[1];
  constexpr double kShearLimit = 1000;  // N
  const auto [medium, high] = limits;
  const double of_compression = load.compression <= kActionLimit
                                    ? medium * std::max(load.compression, 0.0) / kActionLimit
                                    : medium + (high - medium) * (load.compression - kActionLimit) /
                                                   (kUpperLimit - kActionLimit);
  return std::max(of_compression, std::min(medium * std::abs(load.shear) / kShearLimit, high));
}

}  // namespace kinescope::loads
