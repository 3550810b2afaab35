#include "server/loads/load_estimator.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"
#include "core/unknown.h"
#include "server/loads/gap.h"
#include "server/loads/support_polygon.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;
using namespace urdf;

constexpr std::string_view kNoLegs = "the source does not measure the legs";
constexpr std::string_view kLeans =
    "the person sits, leans or holds on to something; the feet alone do not explain the posture";
constexpr std::string_view kMisfit = "the measured ground force is inconsistent with the motion";
constexpr std::string_view kHandLost = "no data from the hand force sensor";
constexpr std::string_view kNoLoadKnown = "hand load unknown";
constexpr std::string_view kPostureOnly =
    "hand load unknown, so only the total moment can be rated";
constexpr std::string_view kNeverExternal = "no external load received for this joint";
constexpr std::string_view kExternalStopped = "no more external loads received for this joint";
constexpr std::string_view kNoPose = "the pose contains numbers that are not finite or too large";

bool IsLegJoint(int joint) { return joint >= jRightHip; }
bool IsTrunkJoint(int joint) { return joint <= jT9T8; }
bool IsArmJoint(int joint, Side side) {
  return side == kRight ? joint >= jRightC7Shoulder && joint <= jRightWrist
                        : joint >= jLeftC7Shoulder && joint <= jLeftWrist;
}

bool IsPose(const LinkPoses& links) {
  constexpr double kMax = 1e9;  // far beyond any room; its square does not overflow
  double sum = 0;
  for (const Pose& link : links) {
    sum += link.position.cwiseAbs().sum() + link.orientation.coeffs().cwiseAbs().sum();
  }
  return sum < kMax;  // also false if one of them is NaN
}

Vector3d VelocityOf(const BodySample& sample, const BodyDemand& demand,
                    const BodyParameters& body) {
  Vector3d sum = Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < demand.size(); ++i) {
    const SegmentState& segment = sample.segments[i];
    sum += body[i].mass *
           (segment.velocity + segment.angular_velocity.cross(demand[i].com - segment.position));
    mass += body[i].mass;
  }
  return sum / mass;
}

const MeasuredGroundForce* FreshOf(const std::optional<MeasuredGroundForce>& measured,
                                   std::int64_t stamp) {
  return measured && IsFresh(measured->stamp_nanos, stamp) ? &*measured : nullptr;
}

GroundSensors SensorsOf(const Measurements& measured, std::int64_t stamp) {
  GroundSensors sensors;
  sensors.total = FreshOf(measured.ground, stamp);
  for (const Side side : {kRight, kLeft}) sensors.feet[side] = FreshOf(measured.feet[side], stamp);
  return sensors;
}

// Whether the values of a plate exceed its noise and the errors of the body model (joint-loads.md
// 3.3).
bool FeelsLoad(const GroundReaction& measured, const GroundReaction& bare) {
  constexpr double kMinForce = 5, kMinDistance = 0.005;  // N, m
  if (!measured.is_measured || !measured.cop || !bare.cop) return true;
  return std::abs(measured.force.z() - bare.force.z()) >= kMinForce ||
         (measured.cop->point - bare.cop->point).norm() >= kMinDistance;
}

// Shortens what no body does. True if there was such.
bool Limit(const LoadSettings& settings, BodyMotion& motion) {
  bool is_limited = false;
  const auto shorten = [&](Vector3d& vector, double longest) {
    const double length = vector.norm();
    if (length < longest) return;
    vector *= longest / length;
    is_limited = true;
  };
  for (SegmentMotion& segment : motion) {
    shorten(segment.acceleration, settings.most_acceleration);
    shorten(segment.angular_acceleration, settings.motion.most_angular_acceleration);
  }
  return is_limited;
}

using JointMoments = std::array<Vector3d, kJointCount>;

JointMoments MomentsOf(const GroundReaction& loaded) {
  JointMoments moments;
  for (int joint = 0; joint < kJointCount; ++joint) {
    moments[At(joint)] = loaded.joints[At(ChildOf(joint))].moment;
  }
  return moments;
}

// Moments that hand loads or a measured ground force add to the `bare` body's (joint-loads.md 3.3).
JointMoments AddedMoments(const GroundReaction& loaded, const GroundReaction& bare) {
  JointMoments moments = MomentsOf(loaded);
  const bool feels = FeelsLoad(loaded, bare);
  for (int joint = 0; joint < kJointCount; ++joint) {
    moments[At(joint)] -= bare.joints[At(ChildOf(joint))].moment;
    if (IsLegJoint(joint) && !feels) moments[At(joint)].setZero();
  }
  return moments;
}

// A ratio in the middle of a class, for a meter, which reads ratios only.
double RatioIn(LoadClass load_class, const LoadMeter::Settings& meter) {
  switch (load_class) {
    case LoadClass::kLow: return 0.5 * meter.down[0];
    case LoadClass::kMedium: return 0.5 * (meter.up[0] + meter.down[1]);
    case LoadClass::kHigh: return 2 * meter.up[1];
    case LoadClass::kUnknown: break;
  }
  return kUnknown;
}

void MakeUnknown(std::string_view why, JointLoad& load) {
  load.ratio = load.shown_ratio = load.deciding_moment = load.capacity = kUnknown;
  load.channel = {};
  load.reason = why;
}

void Show(const Score& score, JointLoad& load) {
  load.ratio = load.moment_ratio = score.ratio;
  load.next_ratio = score.next_ratio;
  load.next_channel = score.next_channel;
  load.deciding_moment = score.moment;
  load.capacity = score.capacity;
  load.channel = score.channel;
}

}  // namespace

void LoadEstimator::ForgetEverything(const LinkPoses& links, std::string_view why,
                                     std::int64_t stamp) {
  result_.cop.reset();
  kinescope::MakeUnknown(why, result_.forces);
  result_.forces.com_of_model = Vector3d::Constant(kUnknown);
  for (std::size_t i = 0; i < result_.loads.size(); ++i) {
    JointLoad& load = result_.loads[i];
    load = JointLoad();
    load.joint = urdf::kScoredJoints[i];
    load.position = links[At(ChildOf(load.joint))].position;
    load.moment = load.force = Vector3d::Constant(kUnknown);
    MakeUnknown(why, load);
    meters_[i].Update(kUnknown, stamp);
  }
}

void LoadEstimator::ShowBody(const BodySample& sample, const LoadSubject& subject,
                             const BodyDemand& demand) {
  BodyForces& forces = result_.forces;
  forces.body_mass_kg = TotalMass(subject.body);
  forces.body_mass_is_assumed = subject.mass_is_assumed;
  forces.com_of_model = CenterOfMassOf(demand, subject.body);
  if (sample.has_linear && sample.has_angular) {
    const Vector3d velocity = VelocityOf(sample, demand, subject.body);
    if (velocity.allFinite()) forces.com_velocity = velocity;
  }
  if (sample.com && sample.com->position.allFinite() && !subject.has_added_masses) {
    constexpr double kMaxDifference = 0.01;  // m, joint-loads.md 1.6
    forces.com_minus_mvn = forces.com_of_model - sample.com->position;
    forces.com_disagrees = forces.com_minus_mvn->norm() > kMaxDifference;
  }
  forces.support = contacts_.support();
  if (forces.com_velocity && forces.support.size > 2 && subject.has_legs) {
    const Eigen::Vector2d xcom =
        ExtrapolatedCenterOfMass(forces.com_of_model, *forces.com_velocity, subject.floor_z);
    forces.extrapolated_com = Vector3d(xcom.x(), xcom.y(), subject.floor_z);
    forces.margin_of_stability = DistanceInside(forces.support, xcom);
  }
  for (const Side side : {kRight, kLeft}) {
    forces.feet[side].touches_floor = subject.has_legs && contacts_.touches(side);
    if (!subject.has_legs) continue;
    forces.feet[side].contact_weight = contacts_.feet()[side].weight;
    forces.feet[side].heel_weight = contacts_.heel_weight(side);
    forces.feet[side].forefoot_weight = contacts_.forefoot_weight(side);
  }
}

bool LoadEstimator::SuspectContact(bool outside, std::int64_t stamp) {
  constexpr double kDwellSecs = 0.2;
  const auto secs_since = [&](const std::optional<std::int64_t>& since) {
    return Secs(stamp - *since);
  };
  const bool fresh = !last_cop_nanos_ || secs_since(last_cop_nanos_) < 0 ||
                     secs_since(last_cop_nanos_) > kLongestGapSecs;
  last_cop_nanos_ = stamp;
  if (fresh) suspects_contact_ = outside;
  if (outside == suspects_contact_) {
    contrary_since_nanos_.reset();
  } else if (!contrary_since_nanos_) {
    contrary_since_nanos_ = stamp;
  } else if (secs_since(contrary_since_nanos_) >= kDwellSecs) {
    suspects_contact_ = outside;
    contrary_since_nanos_.reset();
  }
  return suspects_contact_;
}

void LoadEstimator::ShowFloor(const GroundReaction& ground, const LoadSubject& subject,
                              std::int64_t stamp) {
  BodyForces& forces = result_.forces;
  forces.why_no_ground = subject.has_legs ? ground.why_not : kNoLegs;
  forces.ground_is_measured = ground.is_measured;
  forces.cop_inside = subject.has_legs ? ground.cop_inside : kUnknown;
  result_.cop.reset();
  if (!forces.why_no_ground.empty()) {
    last_cop_nanos_.reset();
  } else if (ground.is_measured) {
    constexpr double kMaxForce = 0.10, kMaxMoment = 0.05;  // joint-loads.md 2.2
    const double weight = forces.body_mass_kg * kGravity;
    const Wrench& residual = ground.joints[kPelvis];
    forces.residual_force_share = residual.force.norm() / weight;
    forces.residual_moment_share = residual.moment.norm() / (weight * subject.skeleton.height);
    if (forces.residual_force_share > kMaxForce || forces.residual_moment_share > kMaxMoment) {
      forces.why_no_ground = kMisfit;
    }
  } else {
    constexpr double kMaxOutside = 0.03;  // m, joint-loads.md 2.4
    forces.external_contact_suspected = SuspectContact(ground.cop_inside < -kMaxOutside, stamp);
    if (forces.external_contact_suspected) forces.why_no_ground = kLeans;
  }
  if (subject.has_legs && ground.cop) {
    result_.cop = Vector3d(ground.shown_cop.x(), ground.shown_cop.y(), subject.floor_z);
  }
  const bool known = forces.why_no_ground.empty();
  if (known) {
    forces.ground_force = ground.force;
    forces.ground_free_moment = ground.cop->free_moment;
  }
  for (const Side side : {kRight, kLeft}) {
    FootForce& foot = forces.feet[side];
    const FootShare& share = ground.feet[side];
    foot.force = known ? share.force : Vector3d::Constant(kUnknown);
    foot.cop = known ? Vector3d(share.point.x(), share.point.y(), subject.floor_z)
                     : Vector3d::Constant(kUnknown);
    foot.free_moment = known ? share.free_moment : kUnknown;
  }
}

std::string_view LoadEstimator::WhyUnknown(int joint) const {
  for (const Side side : {kRight, kLeft}) {
    const bool carries_it = IsArmJoint(joint, side) || IsTrunkJoint(joint) || IsLegJoint(joint);
    if (hand_is_lost_[side] && carries_it) return kHandLost;
  }
  return IsLegJoint(joint) ? result_.forces.why_no_ground : std::string_view();
}

void LoadEstimator::ShowJoints(const GroundReaction& ground, const LinkPoses& links) {
  BodyForces& forces = result_.forces;
  for (int joint = 0; joint < kJointCount; ++joint) {
    JointForce& shown = forces.joints[At(joint)];
    const Wrench& wrench = ground.joints[At(ChildOf(joint))];
    shown = {wrench.force, wrench.moment, WhyUnknown(joint)};
    if (!shown.why_unknown.empty()) {
      shown.force = shown.moment = Vector3d::Constant(kUnknown);
    }
  }
  const JointForce& l5s1 = forces.joints[jL5S1];
  if (l5s1.why_unknown.empty()) forces.lumbar = LumbarLoadOf(l5s1.force, l5s1.moment, links);
}

void LoadEstimator::ShowLoads(const std::array<Vector3d, kJointCount>& rated,
                              const LinkPoses& links, const LoadSettings& settings,
                              const Measurements& measured, std::int64_t stamp) {
  const BodyForces& forces = result_.forces;
  const bool hands_are_known =
      settings.hands.is_known || measured.hands[kRight] || measured.hands[kLeft];
  for (std::size_t i = 0; i < result_.loads.size(); ++i) {
    const int joint = urdf::kScoredJoints[i];
    const JointForce& internal = forces.joints[At(joint)];
    JointLoad& load = result_.loads[i];
    load = JointLoad();
    load.joint = joint;
    load.position = links[At(ChildOf(joint))].position;
    load.moment = internal.moment;
    load.force = internal.force;
    const ExternalJointLoad& given = measured.joints[At(joint)];
    const bool is_given = given.stamp_nanos != 0 && IsFresh(given.stamp_nanos, stamp);
    if (forces.metric == LoadMetric::kExternal || is_given) {
      ShowExternal(given, links, settings, stamp, load);
    } else if (!internal.why_unknown.empty()) {
      MakeUnknown(internal.why_unknown, load);
    } else if (forces.metric == LoadMetric::kNorm) {
      Show(ScoreNorm(joint, rated[At(joint)], links, settings.strength), load);
    } else if (forces.metric == LoadMetric::kOverload && !hands_are_known && !IsLegJoint(joint)) {
      MakeUnknown(kNoLoadKnown, load);  // only a ground measurement
    } else {
      Show(ScoreJoint(joint, rated[At(joint)], links, settings.strength), load);
    }
  }
}

void LoadEstimator::ShowExternal(const ExternalJointLoad& given, const LinkPoses& links,
                                 const LoadSettings& settings, std::int64_t stamp,
                                 JointLoad& load) {
  load.is_external = true;
  load.moment = given.moment;
  load.force = Vector3d::Constant(kUnknown);
  const bool has_level = given.load_class != LoadClass::kUnknown;
  const bool has_ratio = std::isfinite(given.ratio) && given.ratio >= 0;
  const bool has_moment = given.moment.allFinite();
  if (!IsFresh(given.stamp_nanos, stamp)) {
    MakeUnknown(given.stamp_nanos == 0 ? kNeverExternal : kExternalStopped, load);
    load.moment = Vector3d::Constant(kUnknown);
  } else if (has_level || has_ratio) {
    load.ratio = has_ratio ? given.ratio : kUnknown;
    load.deciding_moment = load.capacity = kUnknown;
    load.load_class = given.load_class;  // input of ReadMeters
    load.channel = "external";
  } else if (has_moment) {
    Show(ScoreJoint(load.joint, given.moment, links, settings.strength), load);
  } else {
    MakeUnknown(kNeverExternal, load);
  }
}

void LoadEstimator::CountCompression(const LoadSettings& settings) {
  BodyForces& forces = result_.forces;
  JointLoad& lumbar = result_.loads[urdf::kScoredL5S1];
  if (forces.lumbar) forces.lumbar->ratio = LumbarRatio(*forces.lumbar, settings.meter.up);
  const bool counts = settings.compression_counts && forces.lumbar && !lumbar.is_external &&
                      std::isfinite(lumbar.ratio) && forces.metric != LoadMetric::kExternal &&
                      forces.metric != LoadMetric::kOverload;
  if (!counts) return;
  const double of_compression = forces.lumbar->ratio;
  if (of_compression <= lumbar.ratio) {
    if (lumbar.next_channel.empty() || of_compression > lumbar.next_ratio) {
      lumbar.next_ratio = of_compression;
      lumbar.next_channel = "compression";
    }
    return;
  }
  lumbar.next_ratio = lumbar.ratio;
  lumbar.next_channel = lumbar.channel;
  lumbar.ratio = of_compression;
  lumbar.deciding_moment = lumbar.capacity = kUnknown;
  lumbar.channel = "compression";
  lumbar.is_of_compression = true;
}

void LoadEstimator::ReadMeters(const LoadSettings& settings, std::int64_t stamp) {
  const BodyForces& forces = result_.forces;
  if (last_metric_ != forces.metric) {  // another scale: earlier ratios are meaningless
    meters_.fill(LoadMeter());
    last_metric_ = forces.metric;
  }
  for (std::size_t i = 0; i < result_.loads.size(); ++i) {
    JointLoad& load = result_.loads[i];
    if (load.is_external != was_external_[i]) meters_[i] = LoadMeter();  // as above
    was_external_[i] = load.is_external;
    meters_[i].set_settings(settings.meter);
    const LoadClass given = load.load_class;  // of another program
    load.band = given == LoadClass::kUnknown ? BandOf(load.ratio, settings.meter.up) : given;
    const LoadMeter::Reading shown = meters_[i].Update(
        given == LoadClass::kUnknown ? load.ratio : RatioIn(given, settings.meter), stamp);
    load.load_class = shown.load_class;
    // A class that was given comes without a number that could contradict it.
    load.shown_ratio = given == LoadClass::kUnknown ? shown.ratio : kUnknown;
  }
}

// What is held stays in the hands of the newest pose.
void LoadEstimator::CarryHands(const LinkPoses& from, const LinkPoses& to) {
  for (const Side side : {kRight, kLeft}) {
    const Pose& was = from[At(HandSegmentOf(side))];
    const Pose& is = to[At(HandSegmentOf(side))];
    HandForce& hand = result_.forces.hands[side];
    for (Vector3d* const point : {&hand.point, &hand.grip}) {
      *point =
          is.position + is.orientation * (was.orientation.conjugate() * (*point - was.position));
    }
  }
}

const LoadResult& LoadEstimator::Update(const BodySample& sample, const LinkPoses& newest,
                                        const LoadSubject& subject, const LoadSettings& settings,
                                        const Measurements& measured, const BodyMotion* motion) {
  const std::int64_t stamp = sample.stamp_nanos;
  BodyForces& forces = result_.forces;
  forces = BodyForces();
  forces.metric = settings.metric;
  forces.floor_z = subject.floor_z;
  forces.why_no_floor = subject.why_no_floor;
  forces.stated_hand_load = settings.hands;
  if (!IsPose(newest)) {
    ForgetEverything(newest, kNoPose, stamp);
    return result_;
  }
  const MotionFilter::Output& filtered = motion_.Update(sample, settings.motion);
  forces.is_dynamic = filtered.is_dynamic;
  forces.why_static = filtered.why_static;
  poses_.Add(stamp, newest);
  BodyMotion moving = filtered.motion;
  LinkPoses links = newest;
  if (filtered.is_dynamic && motion != nullptr) {
    moving = *motion;
  } else if (filtered.is_dynamic) {
    forces.delay_secs = filtered.delay_secs;
    links = poses_.At(stamp - static_cast<std::int64_t>(1e9 * filtered.delay_secs));
  }
  forces.is_zero_phase = filtered.is_dynamic && motion != nullptr;
  forces.acceleration_is_limited = Limit(settings, moving);
  contacts_.Update(sample, newest, subject.skeleton, subject.floor_z, settings.contact);
  hands_.Update(settings.hands, stamp);
  const BodyDemand demand = DemandOf(links, moving, subject.body, settings.most_acceleration);
  ShowBody(sample, subject, DemandOf(newest, BodyMotion(), subject.body));
  if (forces.is_dynamic) {
    Vector3d carried = Vector3d::Zero();  // N, with the weight
    for (const SegmentDemand& segment : demand) carried += segment.force;
    forces.com_acceleration = carried / forces.body_mass_kg - Vector3d(0, 0, kGravity);
  }

  ExternalForces hands;
  hands_.Push(links, moving, subject.skeleton, measured.hands, stamp, hands, forces.hands);
  for (const Side side : {kRight, kLeft}) {
    hand_is_lost_[side] =
        measured.hands[side] && !IsFresh(measured.hands[side]->stamp_nanos, stamp);
  }
  const GroundSensors sensors = SensorsOf(measured, stamp);
  const auto stand = [&](const ExternalForces& pushed, const GroundSensors& felt) {
    return SolveGroundReaction({links, demand, pushed, contacts_, subject.floor_z,
                                forces.body_mass_kg, settings.clamp_cop},
                               felt);
  };
  const GroundReaction loaded = stand(hands, sensors);
  ShowFloor(loaded, subject, stamp);
  ShowJoints(loaded, links);

  if (forces.metric == LoadMetric::kOverload && !settings.hands.is_known &&
      !measured.hands[kRight] && !measured.hands[kLeft] && !loaded.is_measured) {
    forces.metric = LoadMetric::kTotal;
    forces.why_other_metric = kPostureOnly;
  }
  const JointMoments rated = forces.metric == LoadMetric::kOverload
                                 ? AddedMoments(loaded, stand(ExternalForces(), GroundSensors()))
                                 : MomentsOf(loaded);
  ShowLoads(rated, links, settings, measured, stamp);
  CarryHands(links, newest);
  for (JointLoad& load : result_.loads) {
    load.position = newest[At(ChildOf(load.joint))].position;
  }
  CountCompression(settings);
  ReadMeters(settings, stamp);
  return result_;
}

}  // namespace kinescope::loads
