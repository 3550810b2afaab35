/// Rows of the CSV of measured forces. One thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "server/wrenches/bounded_lines.h"
#include "server/wrenches/wrench_reader.h"

namespace kinescope::wrenches {

constexpr std::array<const char*, 11> kCsvColumns = {
    "time_s", "body", "fx_N", "fy_N", "fz_N", "px_m", "py_m", "pz_m", "tx_Nm", "ty_Nm", "tz_Nm"};

class CsvWrenches : public WrenchReader {
 public:
  /// `sign`: -1 if forces on feet and ground are those on the plate.
  /// @throws SourceError if the first line is not a header with exactly kCsvColumns.
  CsvWrenches(BoundedLines lines, double sign);
  std::optional<WrenchRow> Next() override;

 private:
  std::string_view Cell(std::size_t column) const { return cells_[place_[column]]; }
  Eigen::Vector3d Vector(std::size_t column, double most) const;

  BoundedLines lines_;
  const double sign_;
  std::array<std::size_t, kCsvColumns.size()> place_{};  // of each column in a row
  std::array<std::string_view, kCsvColumns.size()> cells_;
  double newest_secs_;
  std::array<double, kWrenchBodyCount> newest_secs_of_;  // by body
};

}  // namespace kinescope::wrenches
