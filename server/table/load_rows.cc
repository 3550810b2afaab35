#include "server/table/load_rows.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/system/clocks.h"
#include "core/unknown.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

const Vector3d kNowhere = Vector3d::Constant(kUnknown);

void Vector(const std::string& name, const char* unit, const Vector3d& value, CellSink& cells) {
  cells.Number(name + "_x_" + unit, value.x());
  cells.Number(name + "_y_" + unit, value.y());
  cells.Number(name + "_z_" + unit, value.z());
}

const urdf::JointInfo& InfoOf(std::size_t index) {
  return urdf::kJoints[urdf::At(urdf::kScoredJoints[index])];
}

void VisitFoot(const FootForce& foot, const std::string& name, CellSink& cells) {
  cells.Whole(name + "_on_floor", foot.touches_floor ? 1 : 0);
  Vector(name + "_force", "N", foot.force, cells);
  cells.Number(name + "_cop_x_m", foot.cop.x());
  cells.Number(name + "_cop_y_m", foot.cop.y());
}

bool IsScored(int joint) {
  return std::count(urdf::kScoredJoints.begin(), urdf::kScoredJoints.end(), joint) > 0;
}

// That of a joint without capacity has force and moment only.
JointLoad LoadOf(const PersonState& person, int joint) {
  const auto scored = std::find_if(person.loads.begin(), person.loads.end(),
                                   [&](const JointLoad& load) { return load.joint == joint; });
  if (scored != person.loads.end()) return *scored;
  const JointForce& force = person.forces.joints[urdf::At(joint)];
  JointLoad load;
  load.joint = joint;
  load.moment = force.moment;
  load.force = force.force;
  load.ratio = load.shown_ratio = load.deciding_moment = load.capacity = kUnknown;
  load.reason = force.why_unknown;
  return load;
}

double AreaOf(const SupportPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Eigen::Vector2d& a = polygon.corners[i];
    const Eigen::Vector2d& b = polygon.corners[(i + 1) % polygon.size];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

// "0.1 0.2; 0.3 0.4": x and y of each corner.
std::string CornersText(const SupportPolygon& polygon) {
  std::string text;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    text += fmt::format("{}{:.4f} {:.4f}", i == 0 ? "" : "; ", polygon.corners[i].x(),
                        polygon.corners[i].y());
  }
  return text;
}

}  // namespace

std::vector<int> JointsOf(const Columns& columns) {
  std::vector<int> joints(urdf::kScoredJoints.begin(), urdf::kScoredJoints.end());
  if (!columns.all_joints) return joints;
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    if (!IsScored(joint)) joints.push_back(joint);
  }
  return joints;
}

std::string_view ColumnNameOf(int joint) { return urdf::kJoints[urdf::At(joint)].ros_name; }
std::string_view ScoredName(std::size_t index) { return InfoOf(index).ros_name; }
std::string_view ScoredLabel(std::size_t index) { return InfoOf(index).label; }

std::string IsoTime(std::int64_t stamp_nanos) {
  std::int64_t secs = stamp_nanos / kNanosPerSecond;
  std::int64_t rest = stamp_nanos % kNanosPerSecond;
  if (rest < 0) {
    rest += kNanosPerSecond;
    --secs;
  }
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:06}Z", fmt::gmtime(static_cast<std::time_t>(secs)),
                     rest / 1000);
}

void VisitTime(const PersonState& person, std::int64_t begin_nanos, CellSink& cells) {
  const std::int64_t stamp = person.sample.stamp_nanos;
  cells.Number("time_s", SecsSince(begin_nanos, stamp));
  cells.Text("utc", person.sample.has_time_of_day ? IsoTime(stamp) : "");
  cells.Whole("sample_counter", person.sample.counter);
  cells.Whole("person", person.character);
}

void VisitBody(const PersonState& person, CellSink& cells) {
  const BodyForces& forces = person.forces;
  cells.Text("metric", Name(forces.metric));
  cells.Text("metric_reason", forces.why_other_metric);
  cells.Whole("is_dynamic", forces.is_dynamic ? 1 : 0);
  cells.Text("static_reason", forces.why_static);
  cells.Text("filter", FilterName(forces));
  cells.Number("delay_s", forces.delay_secs);
  cells.Number("floor_z_m", forces.floor_z);
  Vector("com", "m", forces.com_of_model, cells);
  Vector("com_minus_mvn", "m", forces.com_minus_mvn.value_or(kNowhere), cells);
  Vector("ground_force", "N", forces.why_no_ground.empty() ? forces.ground_force : kNowhere, cells);
  const Vector3d cop = person.cop.value_or(kNowhere);
  cells.Number("cop_x_m", cop.x());
  cells.Number("cop_y_m", cop.y());
  cells.Number("cop_inside_m", forces.cop_inside);
  cells.Text("ground_reason", forces.why_no_ground);
  VisitFoot(forces.feet[urdf::kRight], "right_foot", cells);
  VisitFoot(forces.feet[urdf::kLeft], "left_foot", cells);
  cells.Number("margin_of_stability_m", forces.margin_of_stability.value_or(kUnknown));
  cells.Number("right_hand_load_kg", forces.hands[urdf::kRight].mass_kg);
  cells.Number("left_hand_load_kg", forces.hands[urdf::kLeft].mass_kg);
  const LumbarLoad lumbar = forces.lumbar.value_or(LumbarLoad{kUnknown, kUnknown});
  cells.Number("l5_s1_compression_N", lumbar.compression);
  cells.Number("l5_s1_shear_N", lumbar.shear);
}

void VisitDetails(const PersonState& person, CellSink& cells) {
  const BodyForces& forces = person.forces;
  cells.Text("floor_reason", forces.why_no_floor);
  cells.Whole("acceleration_is_limited", forces.acceleration_is_limited ? 1 : 0);
  Vector("com_velocity", "m_s", forces.com_velocity.value_or(kNowhere), cells);
  Vector("extrapolated_com", "m", forces.extrapolated_com.value_or(kNowhere), cells);
  cells.Whole("ground_is_measured", forces.ground_is_measured ? 1 : 0);
  cells.Number("ground_free_moment_Nm",
               forces.why_no_ground.empty() ? forces.ground_free_moment : kUnknown);
  cells.Whole("external_contact_suspected", forces.external_contact_suspected ? 1 : 0);
  cells.Number("residual_force_ratio", forces.residual_force_share);
  cells.Number("residual_moment_ratio", forces.residual_moment_share);
  cells.Number("support_area_m2", AreaOf(forces.support));
  cells.Text("support_corners_m", CornersText(forces.support));
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const FootForce& foot = forces.feet[side];
    const std::string name = side == urdf::kRight ? "right_foot" : "left_foot";
    cells.Number(name + "_contact_ratio", foot.contact_weight);
    cells.Number(name + "_heel_contact_ratio", foot.heel_weight);
    cells.Number(name + "_forefoot_contact_ratio", foot.forefoot_weight);
    cells.Number(name + "_free_moment_Nm", foot.free_moment);
  }
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const HandForce& hand = forces.hands[side];
    const std::string name = side == urdf::kRight ? "right_hand" : "left_hand";
    cells.Whole(name + "_is_measured", hand.is_measured ? 1 : 0);
    Vector(name + "_force", "N", hand.force, cells);
    Vector(name + "_point", "m", hand.point, cells);
  }
  cells.Number("l5_s1_moment_ratio", person.loads[urdf::kScoredL5S1].moment_ratio);
  cells.Number("l5_s1_compression_ratio", forces.lumbar ? forces.lumbar->ratio : kUnknown);
}

void VisitJoint(const PersonState& person, int joint, const std::string& prefix,
                const Columns& columns, CellSink& cells) {
  const JointLoad load = LoadOf(person, joint);
  const bool is_scored = IsScored(joint);
  const Eigen::Quaterniond parent_from_world =
      person.links[urdf::At(urdf::ParentOf(joint))].orientation.conjugate();
  cells.Number(prefix + "ratio", load.ratio);
  cells.Number(prefix + "shown_ratio", load.shown_ratio);
  cells.Text(prefix + "class", is_scored ? Name(load.load_class) : "");
  cells.Text(prefix + "channel", load.channel);
  cells.Number(prefix + "channel_moment_Nm", load.deciding_moment);
  cells.Number(prefix + "capacity_Nm", load.capacity);
  Vector(prefix + "moment", "Nm", parent_from_world * load.moment, cells);
  Vector(prefix + "force", "N", parent_from_world * load.force, cells);
  cells.Text(prefix + "reason", load.reason);
  if (!columns.is_detailed) return;
  cells.Text(prefix + "next_channel", load.next_channel);
  cells.Number(prefix + "next_ratio", load.next_ratio);
}

void VisitWide(const PersonState& person, std::int64_t begin_nanos, const Columns& columns,
               CellSink& cells) {
  VisitTime(person, begin_nanos, cells);
  VisitBody(person, cells);
  if (columns.is_detailed) VisitDetails(person, cells);
  for (const int joint : JointsOf(columns)) {
    VisitJoint(person, joint, std::string(ColumnNameOf(joint)) + "_", columns, cells);
  }
}

}  // namespace kinescope::app
