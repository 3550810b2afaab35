/// Holds the forces of one person for one sample, as every sink shows them. Plain data, part of
/// PersonState; computed by server/loads/load_estimator.h. World frame, metres, newtons, N·m. Joint
/// forces and moments are those that the parent exerts on the child. The texts live as long as the
/// program. Any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/hand_load.h"
#include "urdf/segments.h"

namespace kinescope {

/// Which quantity the load ratio of a joint compares with its capacity (joint-loads.md 2.8, 3,
/// 5.7).
enum class LoadMetric {
  kTotal = 0,     // gravity, motion and hand loads
  kOverload = 1,  // the effect of hand loads or of a measured ground force alone
  kExternal = 2,  // only loads that another program computed
  kNorm = 3,      // |moment| against the capacity of the weaker direction
};

/// "total", "overload", "external", "norm".
const char* Name(LoadMetric metric);

/// Two feet with at most six points each.
constexpr std::size_t kMaxSupportPoints = 12;

/// Support polygon: convex, counter-clockwise, corners (x, y) on the floor, world, m. Empty without
/// foot contact.
struct SupportPolygon {
  std::array<Eigen::Vector2d, kMaxSupportPoints> corners{};
  std::size_t size = 0;
};

struct JointForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N; NaN where unknown
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N·m, about the joint's centre; NaN where
                                                     // unknown
  std::string_view why_unknown;                      // "" where known
};

struct FootForce {
  bool touches_floor = false;
  double contact_weight = 0;  // 0 to 1; changes gradually after a change of contact
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // ground reaction force on the foot, N; NaN
                                                    // where unknown
  Eigen::Vector3d cop = Eigen::Vector3d::Zero();    // centre of pressure of the foot, world, m; NaN
                                                    // where unknown
  double free_moment = 0;                           // N·m, about the vertical through `cop`
  /// Of heel and forefoot alone, 0 to 1; changes gradually after a change of contact.
  double heel_weight = 0, forefoot_weight = 0;
};

/// L5/S1 disc forces from a single-equivalent-muscle model, joint-loads.md 4.4; accuracy ±25 %.
struct LumbarLoad {
  double compression = 0;  // N, along the spine at L5/S1
  double shear = 0;        // N, along x of segment L5
  double ratio = 0;        // of compression or shear, on the scale of load ratios
};

/// Load of one hand at this sample, ramps included.
struct HandForce {
  double mass_kg = 0;    // hand load, with this hand's share of a load in both hands
  double shared_kg = 0;  // the part of mass_kg that both hands share
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, on the hand
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // where `force` acts, world, m
  Eigen::Vector3d grip = Eigen::Vector3d::Zero();   // grip point inside the fist, world, m
  bool is_measured = false;                         // at least partly, by a sensor
};

struct BodyForces {
  LoadMetric metric = LoadMetric::kTotal;  // of the ratios
  /// Why `metric` is not the requested one ("no load is known: posture only"); "" if it is.
  std::string_view why_other_metric;
  bool is_dynamic = false;      // inertial forces are included
  std::string_view why_static;  // "" while is_dynamic
  bool is_zero_phase = false;   // accelerations were filtered without lag, as of recordings
  double delay_secs = 0;        // by which forces and moments are late; 0 without filter or lag
  bool acceleration_is_limited = false;  // an acceleration was implausible and has been shortened
  double body_mass_kg = 0;               // with added masses
  bool body_mass_is_assumed = false;

  std::array<JointForce, urdf::kJointCount> joints{};  // by urdf::Joint

  double floor_z = 0;  // that the legs stand on, world, m
  /// Why `floor_z` is only the height of the lowest point of the feet; "" if it was set or found.
  std::string_view why_no_floor;
  /// Why the ground reaction force is unknown (no foot contact, sitting or leaning, legs not
  /// recorded); "" otherwise. If it is unknown, so are the loads of the leg joints.
  std::string_view why_no_ground;
  bool ground_is_measured = false;
  bool external_contact_suspected =
      false;  // sits, leans or holds on: the CoP is outside the support
  Eigen::Vector3d ground_force = Eigen::Vector3d::Zero();  // N, total, on the person; 0 where
                                                           // unknown
  double ground_free_moment = 0;                           // N·m, about the vertical
  /// Distance from the CoP, before it is clamped, to the border of the support polygon, m; positive
  /// inside. NaN without a CoP or without foot contact.
  double cop_inside = 0;
  std::array<FootForce, 2> feet{};  // by urdf::Side
  SupportPolygon support;
  std::optional<Eigen::Vector3d> extrapolated_com;  // on the floor, world, m (Hof 2005)
  std::optional<double> margin_of_stability;        // m; positive inside the support polygon

  std::array<HandForce, 2> hands{};  // by urdf::Side
  HandLoad stated_hand_load;         // as it was set: the end values of the ramps
  std::optional<LumbarLoad> lumbar;

  Eigen::Vector3d com_of_model = Eigen::Vector3d::Zero();  // world, m
  std::optional<Eigen::Vector3d> com_velocity;             // of the model, world, m/s
  std::optional<Eigen::Vector3d> com_acceleration;  // of the model, filtered, world, m/s^2; absent
                                                    // while not is_dynamic
  std::optional<Eigen::Vector3d> com_minus_mvn;  // com_of_model minus MVN's CoM, world, m; absent
                                                 // where MVN's is not streamed
  bool com_disagrees = false;  // by more than 1 cm: wrong frames, segment lengths or body model

  /// The part of the measured ground forces that the motion does not explain, relative to body
  /// weight (force) and to weight x stature (moment). 0 where the ground force is computed.
  double residual_force_share = 0;
  double residual_moment_share = 0;
};

/// The filter that the accelerations have passed: "zero-phase" or "causal"; "" while not
/// is_dynamic.
const char* FilterName(const BodyForces& forces);

/// Marks all computed forces as unknown for the reason `why`. Body, hand loads and support polygon
/// stay.
void MakeUnknown(std::string_view why, BodyForces& forces);

}  // namespace kinescope
