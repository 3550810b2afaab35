/// What `kinescope loads` says of one sample: the list of columns behind CSV and JSON. Each is
/// named once, with its unit, beside its value. Pure functions; any thread.
///
/// World frame for points and ground forces; moments and forces of joints in the axes of the
/// parent's link frame (x forward, y left, z up along the segment; urdf/segments.h): what the
/// parent exerts on the child, at the joint's centre.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/scene_state.h"

namespace kinescope::app {

/// Where the names or the values of a row go.
class CellSink {
 public:
  virtual ~CellSink() = default;
  /// `value` NaN: nothing is known.
  virtual void Number(const std::string& name, double value) = 0;
  virtual void Whole(const std::string& name, long long value) = 0;
  virtual void Text(const std::string& name, std::string_view value) = 0;
};

/// `begin_nanos`: time 0.
void VisitTime(const PersonState& person, std::int64_t begin_nanos, CellSink& cells);
/// Body, floor and spine: what there is one of.
void VisitBody(const PersonState& person, CellSink& cells);
/// Of the scored joint `index`; names begin with `prefix`.
void VisitJoint(const PersonState& person, std::size_t index, const std::string& prefix,
                CellSink& cells);
/// Everything in one row; joints' names begin with theirs: "right_knee_ratio".
void VisitWide(const PersonState& person, std::int64_t begin_nanos, CellSink& cells);

/// "2020-01-01T00:00:00.008333Z", UTC, to the microsecond.
std::string IsoTime(std::int64_t stamp_nanos);

/// "right_knee", of kScoredJoints[index].
std::string_view ScoredName(std::size_t index);
/// "Right knee", likewise.
std::string_view ScoredLabel(std::size_t index);

}  // namespace kinescope::app
