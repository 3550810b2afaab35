#include "server/app/convert/motion_rows.h"

#include <array>

#include "core/unknown.h"
#include "server/table/load_rows.h"
#include "urdf/anatomical_angles.h"

namespace kinescope::app {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::AngleSequence;
using urdf::At;

const Vector3d kUnknownVector = Vector3d::Constant(kUnknown);

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

void VectorCells(std::string_view item, std::string_view quantity, std::string_view unit,
                 const Vector3d& value, MotionCells& cells) {
  for (int i = 0; i < 3; ++i) cells.Number({item, quantity, kAxes[At(i)], unit}, value[i]);
}

void QuaternionCells(std::string_view item, std::string_view quantity, const Quaterniond& value,
                     MotionCells& cells) {
  cells.Number({item, quantity, "w", ""}, value.w());
  for (int i = 0; i < 3; ++i) cells.Number({item, quantity, kAxes[At(i)], ""}, value.vec()[i]);
}

template <class Visit>
void ForSegments(const PersonState& person, const Visit& visit) {
  for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
    visit(urdf::kSegments[i].link_name, person.sample.segments[i]);
  }
}

void VisitPoses(const PersonState& person, MotionCells& cells) {
  ForSegments(person, [&](std::string_view name, const SegmentState& segment) {
    VectorCells(name, "position", "m", segment.position, cells);
    QuaternionCells(name, "orientation", segment.orientation, cells);
  });
}

void VisitVelocities(const PersonState& person, MotionCells& cells) {
  const bool linear = person.sample.has_linear, angular = person.sample.has_angular;
  ForSegments(person, [&](std::string_view name, const SegmentState& segment) {
    VectorCells(name, "velocity", "m_s", linear ? segment.velocity : kUnknownVector, cells);
    VectorCells(name, "angular_velocity", "rad_s",
                angular ? segment.angular_velocity : kUnknownVector, cells);
  });
}

void VisitAccelerations(const PersonState& person, MotionCells& cells) {
  const bool linear = person.sample.has_linear, angular = person.sample.has_angular;
  ForSegments(person, [&](std::string_view name, const SegmentState& segment) {
    VectorCells(name, "acceleration", "m_s2", linear ? segment.acceleration : kUnknownVector,
                cells);
    VectorCells(name, "angular_acceleration", "rad_s2",
                angular ? segment.angular_acceleration : kUnknownVector, cells);
  });
}

using AngleWords = std::array<const char*, 3>;
constexpr AngleWords kTrunkWords = {"lateral_bending", "axial_rotation", "flexion"};
constexpr AngleWords kLimbWords = {"abduction", "rotation", "flexion"};

void AngleCells(std::string_view item, std::string_view quantity, const AngleWords& words,
                const Vector3d& degrees, MotionCells& cells) {
  for (int i = 0; i < 3; ++i) cells.Number({item, quantity, words[At(i)], "deg"}, degrees[i]);
}

void VisitAngles(const PersonState& person, MotionCells& cells) {
  const auto orientations = OrientationsOf(person.sample);
  const auto zxy = urdf::AnatomicalAngles(orientations, AngleSequence::kZxy);
  const auto xzy = urdf::AnatomicalAngles(orientations, AngleSequence::kXzy);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const std::string_view name = urdf::kJoints[At(joint)].ros_name;
    const auto& words = joint <= urdf::jC1Head ? kTrunkWords : kLimbWords;
    AngleCells(name, "angle_zxy", words, zxy[At(joint)], cells);
    AngleCells(name, "angle_xzy", words, xzy[At(joint)], cells);
  }
}

void VisitErgonomicAngles(const PersonState& person, MotionCells& cells) {
  static constexpr std::array<const char*, urdf::kErgonomicAngleCount> kNames = {
      "t8_head",   "t8_left_upper_arm", "t8_right_upper_arm",
      "pelvis_t8", "vertical_pelvis",   "vertical_t8"};
  const auto orientations = OrientationsOf(person.sample);
  const auto zxy = urdf::ErgonomicAngles(orientations, AngleSequence::kZxy);
  const auto xzy = urdf::ErgonomicAngles(orientations, AngleSequence::kXzy);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto angle = static_cast<urdf::ErgonomicAngle>(i);
    const bool is_arm = angle == urdf::ErgonomicAngle::kT8LeftUpperArm ||
                        angle == urdf::ErgonomicAngle::kT8RightUpperArm;
    const auto& words = is_arm ? kLimbWords : kTrunkWords;
    AngleCells(kNames[i], "angle_zxy", words, zxy[i], cells);
    AngleCells(kNames[i], "angle_xzy", words, xzy[i], cells);
  }
}

// MVN's own where it is sent, else that of the body model.
void VisitCom(const PersonState& person, MotionCells& cells) {
  const BodySample& sample = person.sample;
  Vector3d velocity = person.forces.com_velocity.value_or(kUnknownVector);
  Vector3d acceleration = person.forces.com_acceleration.value_or(kUnknownVector);
  if (sample.com) {
    velocity = sample.com->has_derivatives ? sample.com->velocity : kUnknownVector;
    acceleration = sample.com->has_derivatives ? sample.com->acceleration : kUnknownVector;
  }
  VectorCells("com", "position", "m", person.com.value_or(kUnknownVector), cells);
  VectorCells("com", "velocity", "m_s", velocity, cells);
  VectorCells("com", "acceleration", "m_s2", acceleration, cells);
  cells.Text({"com", "source", "", ""}, sample.com ? "mvn" : "body_model");
}

void VisitGround(const PersonState& person, MotionCells& cells) {
  const BodyForces& forces = person.forces;
  constexpr std::array<const char*, 2> kFeet = {"right_foot", "left_foot"};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const char* const name = kFeet[At(side)];
    const auto& sent = person.sample.foot_contacts;
    cells.Number({name, "heel_contact", "", ""}, sent ? (*sent)[At(side)].heel : kUnknown);
    cells.Number({name, "forefoot_contact", "", ""}, sent ? (*sent)[At(side)].forefoot : kUnknown);
    const FootForce& foot = forces.feet[At(side)];
    cells.Number({name, "on_floor", "", ""}, foot.touches_floor ? 1 : 0);
    VectorCells(name, "force", "N", foot.force, cells);
    cells.Number({name, "cop", "x", "m"}, foot.cop.x());
    cells.Number({name, "cop", "y", "m"}, foot.cop.y());
  }
  VectorCells("", "ground_force", "N",
              forces.why_no_ground.empty() ? forces.ground_force : kUnknownVector, cells);
  const Vector3d cop = person.cop.value_or(kUnknownVector);
  cells.Number({"", "cop", "x", "m"}, cop.x());
  cells.Number({"", "cop", "y", "m"}, cop.y());
  cells.Number({"", "floor", "z", "m"}, forces.floor_z);
  cells.Text({"", "ground_reason", "", ""}, forces.why_no_ground);
}

// Columns of `kinescope loads` as cells: the unit and the axis are at the end of their names.
class LoadCells : public CellSink {
 public:
  LoadCells(std::string_view item, MotionCells& cells) : item_(item), cells_(cells) {}

  void Number(const std::string& name, double value) override {
    cells_.Number(CellOf(name), value);
  }
  void Whole(const std::string& name, long long value) override {
    cells_.Number(CellOf(name), static_cast<double>(value));
  }
  void Text(const std::string& name, std::string_view value) override {
    cells_.Text(CellOf(name), value);
  }

 private:
  MotionCell CellOf(std::string_view name) const {
    MotionCell cell{item_, name, "", ""};
    for (const std::string_view unit : {"Nm", "N"}) {
      if (TakeEnd(unit, cell.quantity)) cell.unit = unit;
    }
    for (const std::string_view axis : {"x", "y", "z"}) {
      if (TakeEnd(axis, cell.quantity)) cell.component = axis;
    }
    return cell;
  }

  // Removes "_end" from `name`.
  static bool TakeEnd(std::string_view end, std::string_view& name) {
    if (name.size() <= end.size() + 1 || name.substr(name.size() - end.size()) != end ||
        name[name.size() - end.size() - 1] != '_') {
      return false;
    }
    name.remove_suffix(end.size() + 1);
    return true;
  }

  std::string_view item_;
  MotionCells& cells_;
};

void VisitLoads(const PersonState& person, MotionCells& cells) {
  const BodyForces& forces = person.forces;
  cells.Text({"", "metric", "", ""}, Name(forces.metric));
  cells.Text({"", "filter", "", ""}, FilterName(forces));
  cells.Number({"", "delay", "", "s"}, forces.delay_secs);
  cells.Number({"right_hand", "load", "", "kg"}, forces.hands[urdf::kRight].mass_kg);
  cells.Number({"left_hand", "load", "", "kg"}, forces.hands[urdf::kLeft].mass_kg);
  const LumbarLoad lumbar = forces.lumbar.value_or(LumbarLoad{kUnknown, kUnknown});
  cells.Number({"l5_s1", "compression", "", "N"}, lumbar.compression);
  cells.Number({"l5_s1", "shear", "", "N"}, lumbar.shear);
  for (const int joint : urdf::kScoredJoints) {
    LoadCells of_joint(ColumnNameOf(joint), cells);
    VisitJoint(person, joint, "", Columns(), of_joint);
  }
}

void VisitTrackers(const PersonState& person, const std::bitset<urdf::kSegmentCount>& trackers,
                   MotionCells& cells) {
  for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
    if (!trackers.test(i)) continue;
    const std::string_view name = urdf::kSegments[i].link_name;
    const bool is_here = person.sample.has_tracker.test(i);
    const TrackerState& tracker = person.sample.trackers[i];
    const bool has_rates = is_here && tracker.has_rates;
    static const Quaterniond kUnknownTurn(kUnknown, kUnknown, kUnknown, kUnknown);
    QuaternionCells(name, "sensor_orientation", is_here ? tracker.orientation : kUnknownTurn,
                    cells);
    VectorCells(name, "sensor_free_acceleration", "m_s2",
                is_here ? tracker.free_acceleration : kUnknownVector, cells);
    VectorCells(name, "sensor_acceleration", "m_s2",
                has_rates ? tracker.acceleration : kUnknownVector, cells);
    VectorCells(name, "sensor_angular_velocity", "rad_s",
                has_rates ? tracker.angular_velocity : kUnknownVector, cells);
    VectorCells(name, "sensor_magnetic_field", "",
                is_here ? tracker.magnetic_field : kUnknownVector, cells);
  }
}

}  // namespace

std::vector<std::pair<std::string, Quantity>> QuantityNames() {
  return {{"poses", Quantity::kPoses},
          {"velocities", Quantity::kVelocities},
          {"accelerations", Quantity::kAccelerations},
          {"angles", Quantity::kAngles},
          {"ergonomic", Quantity::kErgonomic},
          {"com", Quantity::kCom},
          {"ground", Quantity::kGround},
          {"loads", Quantity::kLoads},
          {"trackers", Quantity::kTrackers}};
}

std::string ColumnName(const MotionCell& cell) {
  std::string name;
  for (const std::string_view part : {cell.item, cell.quantity, cell.component, cell.unit}) {
    if (part.empty()) continue;
    if (!name.empty()) name += '_';
    name += part;
  }
  return name;
}

QuantitySet QuantitiesOf(const PersonState& person) {
  const BodySample& sample = person.sample;
  QuantitySet quantities;
  quantities.set();
  const bool has_derivatives = sample.has_linear || sample.has_angular;
  quantities.set(static_cast<std::size_t>(Quantity::kVelocities), has_derivatives);
  quantities.set(static_cast<std::size_t>(Quantity::kAccelerations), has_derivatives);
  quantities.set(static_cast<std::size_t>(Quantity::kTrackers), sample.has_tracker.any());
  return quantities;
}

void VisitMotion(const PersonState& person, QuantitySet quantities,
                 const std::bitset<urdf::kSegmentCount>& trackers, MotionCells& cells) {
  for (std::size_t i = 0; i < kQuantityCount; ++i) {
    if (!quantities.test(i)) continue;
    switch (static_cast<Quantity>(i)) {
      case Quantity::kPoses: VisitPoses(person, cells); break;
      case Quantity::kVelocities: VisitVelocities(person, cells); break;
      case Quantity::kAccelerations: VisitAccelerations(person, cells); break;
      case Quantity::kAngles: VisitAngles(person, cells); break;
      case Quantity::kErgonomic: VisitErgonomicAngles(person, cells); break;
      case Quantity::kCom: VisitCom(person, cells); break;
      case Quantity::kGround: VisitGround(person, cells); break;
      case Quantity::kLoads: VisitLoads(person, cells); break;
      case Quantity::kTrackers: VisitTrackers(person, trackers, cells); break;
    }
  }
}

}  // namespace kinescope::app
