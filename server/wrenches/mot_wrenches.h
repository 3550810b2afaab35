/// Rows of OpenSim's MOT and STO files of external forces: a header that ends with endheader, a
/// line of labels, then rows. Each group of columns (such as ground_force_1_vx ... _pz and
/// ground_torque_1_x ... _z) is one body. x forward, y up, z right. One thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/wrenches/bounded_lines.h"
#include "server/wrenches/wrench_reader.h"

namespace kinescope::wrenches {

class MotWrenches : public WrenchReader {
 public:
  /// `sign`: -1 if forces on feet and ground are those on the plate.
  /// @throws SourceError if header or labels are refused; UsageError if a group has no body,
  /// listing the groups.
  MotWrenches(BoundedLines lines, const std::vector<GroupBody>& bodies, double sign);
  std::optional<WrenchRow> Next() override;

 private:
  /// The columns of one body: force, point and torque.
  struct Group {
    std::string key;   // of the labels, without the words for the quantity
    std::string name;  // as users know it: of the labels of its force
    std::array<std::array<std::optional<std::size_t>, 3>, 3> columns;  // by quantity and axis
    std::optional<WrenchBody> body;
  };
  void ReadHeader();
  void ReadLabels();
  void Assign(const std::vector<GroupBody>& bodies);
  bool ReadRow();
  WrenchRow RowOf(const Group& group) const;
  Eigen::Vector3d Vector(const Group& group, std::size_t quantity) const;

  BoundedLines lines_;
  const double sign_;
  std::optional<long> announced_rows_, announced_columns_;
  std::vector<std::string> labels_;
  std::vector<Group> groups_;
  std::vector<double> values_;  // of the newest row, by column
  std::size_t next_group_;      // of the newest row
  long rows_ = 0;
};

}  // namespace kinescope::wrenches
