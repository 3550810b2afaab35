/// Defines the columns of `kinescope loads` for CSV and JSON. Each column is named once, with its
/// unit, beside its value. Pure functions; any thread.
///
/// World frame for points and ground reaction forces. Joint moments and forces are in the axes of
/// the parent's link frame (x forward, y left, z up along the segment; urdf/segments.h): those that
/// the parent exerts on the child, at the joint's centre.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::app {

/// Receives the names or the values of a row.
class CellSink {
 public:
  virtual ~CellSink() = default;
  /// `value` NaN: unknown.
  virtual void Number(const std::string& name, double value) = 0;
  virtual void Whole(const std::string& name, long long value) = 0;
  virtual void Text(const std::string& name, std::string_view value) = 0;
};

/// Which columns there are.
struct Columns {
  bool all_joints = false;   // also the joints without capacity, after the scored ones
  bool is_detailed = false;  // also contacts, hands, support, checks, and the second direction
};

/// The joints of a row, in their order: urdf::Joint.
std::vector<int> JointsOf(const Columns& columns);

/// `begin_nanos`: time 0, ns.
void VisitTime(const PersonState& person, std::int64_t begin_nanos, CellSink& cells);
/// Body, ground reaction force and spine: values that exist once per person.
void VisitBody(const PersonState& person, CellSink& cells);
/// More about the body, for Columns::is_detailed.
void VisitDetails(const PersonState& person, CellSink& cells);
/// `joint`: urdf::Joint; names begin with `prefix`. A joint without capacity has no ratio.
void VisitJoint(const PersonState& person, int joint, const std::string& prefix,
                const Columns& columns, CellSink& cells);
/// Everything in one row; column names of joints begin with the joint: "right_knee_ratio".
void VisitWide(const PersonState& person, std::int64_t begin_nanos, const Columns& columns,
               CellSink& cells);

/// s, divided and not multiplied by 1e-9, which is inexact: 0.1 and not 0.10000000000000002.
constexpr double SecsSince(std::int64_t begin_nanos, std::int64_t stamp_nanos) {
  return static_cast<double>(stamp_nanos - begin_nanos) / 1e9;
}

/// "2020-01-01T00:00:00.008333Z", UTC, to the microsecond.
std::string IsoTime(std::int64_t stamp_nanos);

/// "right_knee", the name of urdf::Joint `joint` in columns.
std::string_view ColumnNameOf(int joint);
/// "right_knee", the name of kScoredJoints[index].
std::string_view ScoredName(std::size_t index);
/// "Right knee", the label of kScoredJoints[index].
std::string_view ScoredLabel(std::size_t index);

}  // namespace kinescope::app
