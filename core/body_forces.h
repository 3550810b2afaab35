/// What a person's motion says about forces, as every sink shows it: plain data, part of
/// PersonState. World frame, metres, newtons, N m; joint forces and moments are what the parent
/// exerts on the child. Made by server/loads/load_estimator.h. Texts live as long as the program.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "urdf/segments.h"

namespace kinescope {

/// What a joint's ratio is a ratio of (joint-loads.md 2.8, 3, 5.7).
enum class LoadMetric {
  kTotal = 0,     // gravity, motion and load
  kOverload = 1,  // what the load in the hands adds, or the measured ground force says
  kExternal = 2,  // as another program computed it, and nothing else
  kNorm = 3,      // |moment| against the weaker direction
};

/// "total", "overload", "external", "norm".
const char* Name(LoadMetric metric);

/// Two feet of six points each at most.
constexpr std::size_t kMostSupportPoints = 12;

/// Convex, counter-clockwise, on the floor: (x, y). Empty when no foot is on the floor.
struct SupportPolygon {
  std::array<Eigen::Vector2d, kMostSupportPoints> corners{};
  std::size_t size = 0;
};

struct JointForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N; NaN where it is not known
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N m, at the joint's centre; likewise
  std::string_view why_unknown;                      // "" where it is known
};

struct FootForce {
  bool touches_floor = false;
  double contact_weight = 0;                        // ramps 0..1 after a change
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, of the floor on the foot; NaN: unknown
  Eigen::Vector3d cop = Eigen::Vector3d::Zero();    // where it acts, world; likewise
  double free_moment = 0;                           // N m, about the vertical there
};

/// One equivalent muscle, joint-loads.md 4.4; +-25 %.
struct LumbarLoad {
  double compression = 0;  // N, along the spine at L5/S1
  double shear = 0;        // N, along x of segment L5
};

/// In a hand now, ramps included.
struct HandForce {
  double mass_kg = 0;                               // of what is held, this hand's share
  double shared_kg = 0;                             // of that, its share of what both hold together
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, on the hand
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // where, world
  Eigen::Vector3d grip = Eigen::Vector3d::Zero();   // inside the fist, world
  bool is_measured = false;                         // by a sensor, at least in part
};

/// What somebody said is held: where the ramps go to. kg.
struct ToldLoad {
  bool is_known = false;                   // false: nobody said anything
  std::array<double, 2> alone_kg{{0, 0}};  // by urdf::Side
  double both_kg = 0;
};

struct BodyForces {
  LoadMetric metric = LoadMetric::kTotal;  // that ratios were computed with
  /// Why it is not the one asked for ("no load is known: posture only"); "" when it is.
  std::string_view why_other_metric;
  bool is_dynamic = false;      // accelerations took part
  std::string_view why_static;  // "" while dynamic
  double body_mass_kg = 0;      // with extra masses
  bool body_mass_is_assumed = false;

  std::array<JointForce, urdf::kJointCount> joints{};  // by urdf::Joint

  /// Why nothing can be said about the floor (flight, no foot on it, sitting or leaning, legs not
  /// recorded); "" otherwise. Pelvis-down joints are unknown then.
  std::string_view why_no_ground;
  bool ground_is_measured = false;
  bool external_contact_suspected =
      false;  // sits, leans or holds on: the CoP is not under the feet
  Eigen::Vector3d ground_force = Eigen::Vector3d::Zero();  // N, total, on the person; 0: unknown
  double ground_free_moment = 0;                           // N m
  /// m, from the CoP before it is clamped to the border; positive inside. NaN: no CoP or no foot.
  double cop_inside = 0;
  std::array<FootForce, 2> feet{};  // by urdf::Side
  SupportPolygon support;
  std::optional<Eigen::Vector3d> extrapolated_com;  // on the floor, world (Hof 2005)
  std::optional<double> margin_of_stability;        // m, positive: inside the support

  std::array<HandForce, 2> hands{};  // by urdf::Side
  ToldLoad told;                     // what the hands hold, as somebody said
  std::optional<LumbarLoad> lumbar;

  Eigen::Vector3d com_of_model = Eigen::Vector3d::Zero();  // world
  std::optional<Eigen::Vector3d> com_velocity;             // of the model, m/s
  std::optional<Eigen::Vector3d> com_difference;           // ours - MVN's, where MVN's is streamed
  bool com_disagrees = false;  // by more than 1 cm: wrong frames, lengths or a wrong body

  /// What measured ground forces leave unexplained, as parts of weight and weight x stature; 0
  /// where the ground is computed.
  double residual_force_share = 0;
  double residual_moment_share = 0;
};

/// Lets go of everything that was computed about forces, with the reason; bodies, hands and support
/// stay.
void MakeUnknown(std::string_view why, BodyForces& forces);

}  // namespace kinescope
