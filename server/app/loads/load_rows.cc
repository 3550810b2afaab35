#include "server/app/loads/load_rows.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <limits>

#include "core/system/clocks.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

constexpr double kEmptyCell = std::numeric_limits<double>::quiet_NaN();
const Vector3d kNowhere = Vector3d::Constant(kEmptyCell);

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

}  // namespace

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
  cells.Number("time_s", Secs(stamp - begin_nanos));
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
  cells.Text("filter", !forces.is_dynamic ? "" : forces.is_zero_phase ? "zero-phase" : "causal");
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
  cells.Number("margin_of_stability_m", forces.margin_of_stability.value_or(kEmptyCell));
  cells.Number("right_hand_load_kg", forces.hands[urdf::kRight].mass_kg);
  cells.Number("left_hand_load_kg", forces.hands[urdf::kLeft].mass_kg);
  const LumbarLoad lumbar = forces.lumbar.value_or(LumbarLoad{kEmptyCell, kEmptyCell});
  cells.Number("l5_s1_compression_N", lumbar.compression);
  cells.Number("l5_s1_shear_N", lumbar.shear);
}

void VisitJoint(const PersonState& person, std::size_t index, const std::string& prefix,
                CellSink& cells) {
  const JointLoad& load = person.loads[index];
  const Eigen::Quaterniond parent_from_world =
      person.links[urdf::At(urdf::ParentOf(load.joint))].orientation.conjugate();
  cells.Number(prefix + "ratio", load.ratio);
  cells.Number(prefix + "shown_ratio", load.shown_ratio);
  cells.Text(prefix + "class", Name(load.load_class));
  cells.Text(prefix + "channel", load.channel);
  cells.Number(prefix + "channel_moment_Nm", load.deciding_moment);
  cells.Number(prefix + "capacity_Nm", load.capacity);
  Vector(prefix + "moment", "Nm", parent_from_world * load.moment, cells);
  Vector(prefix + "force", "N", parent_from_world * load.force, cells);
  cells.Text(prefix + "reason", load.reason);
}

void VisitWide(const PersonState& person, std::int64_t begin_nanos, CellSink& cells) {
  VisitTime(person, begin_nanos, cells);
  VisitBody(person, cells);
  for (std::size_t i = 0; i < person.loads.size(); ++i) {
    VisitJoint(person, i, std::string(ScoredName(i)) + "_", cells);
  }
}

}  // namespace kinescope::app
