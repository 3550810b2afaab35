/// Defines what `kinescope convert` puts into tables: each value is named once, with its unit,
/// beside its value. World frame (z up, m) unless stated. Pure functions; any thread.
#pragma once

#include <bitset>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::app {

/// Groups of values that may be chosen.
enum class Quantity {
  kPoses,          // position and orientation of each *segment* frame
  kVelocities,     // linear and angular, of each segment's origin
  kAccelerations,  // linear and angular, of each segment's origin
  kAngles,         // of the joints, ZXY and XZY
  kErgonomic,      // the six ergonomic angles, ZXY and XZY
  kCom,            // with velocity and acceleration
  kGround,         // contacts, ground reaction forces, CoP, floor
  kLoads,          // of the joints, as in `kinescope loads`
  kTrackers,       // the sensors of the suit
};
constexpr std::size_t kQuantityCount = 9;
using QuantitySet = std::bitset<kQuantityCount>;

/// "poses", "velocities", ...
std::vector<std::pair<std::string, Quantity>> QuantityNames();

/// Names of a value; parts that do not apply are "".
struct MotionCell {
  std::string_view item;       // "right_knee"
  std::string_view quantity;   // "angle_zxy"
  std::string_view component;  // "flexion"
  std::string_view unit;       // "deg"
};

/// "right_knee_angle_zxy_flexion_deg": the parts that apply, in their order.
std::string ColumnName(const MotionCell& cell);

class MotionCells {
 public:
  virtual ~MotionCells() = default;
  /// NaN: unknown.
  virtual void Number(const MotionCell& cell, double value) = 0;
  virtual void Text(const MotionCell& cell, std::string_view value) = 0;
};

/// The quantities that this sample has, of those asked for: velocities and trackers are not
/// computed where they are not sent.
QuantitySet QuantitiesOf(const PersonState& person);

/// All values of `quantities`, in the same order for every sample. `trackers`: which of them have
/// columns.
void VisitMotion(const PersonState& person, QuantitySet quantities,
                 const std::bitset<urdf::kSegmentCount>& trackers, MotionCells& cells);

}  // namespace kinescope::app
