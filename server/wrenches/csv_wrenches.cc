#include "server/wrenches/csv_wrenches.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/system/words.h"
#include "server/wrenches/wrench_cells.h"

namespace kinescope::wrenches {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kTime = 0, kBody = 1, kForce = 2, kPoint = 5, kTorque = 8;
constexpr std::size_t kMostCells = 64;  // more are not counted

std::vector<std::string_view> CellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  std::size_t begin = 0;
  while (begin <= line.size() && cells.size() <= kMostCells) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(Trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

std::string Header() { return fmt::format("{}", fmt::join(kCsvColumns, ",")); }

}  // namespace

CsvWrenches::CsvWrenches(BoundedLines lines, double sign)
    : lines_(std::move(lines)),
      sign_(sign),
      newest_secs_(-std::numeric_limits<double>::infinity()) {
  newest_secs_of_.fill(newest_secs_);
  const auto line = lines_.Next();
  if (!line) lines_.RefuseFile("the file is empty; expected the header " + Header());
  const std::vector<std::string_view> cells = CellsOf(*line);
  for (std::size_t i = 0; i < kCsvColumns.size(); ++i) {
    const auto found = std::find(cells.begin(), cells.end(), kCsvColumns[i]);
    if (found == cells.end()) {
      lines_.Refuse(fmt::format("{}: column {} is missing; expected the header {}", Quoted(*line),
                                kCsvColumns[i], Header()));
    }
    place_[i] = static_cast<std::size_t>(found - cells.begin());
  }
  if (cells.size() != kCsvColumns.size()) {
    lines_.Refuse(fmt::format("{} columns; expected the header {}", cells.size(), Header()));
  }
}

Vector3d CsvWrenches::Vector(std::size_t column, double most) const {
  Vector3d vector;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    vector[static_cast<Eigen::Index>(axis)] =
        NumberIn(Cell(column + axis), kCsvColumns[column + axis], most, lines_);
  }
  return vector;
}

std::optional<WrenchRow> CsvWrenches::Next() {
  std::optional<std::string_view> line;
  do {
    line = lines_.Next();
    if (!line) return std::nullopt;
  } while (Trimmed(*line).empty());
  const std::vector<std::string_view> cells = CellsOf(*line);
  if (cells.size() != cells_.size()) {
    lines_.Refuse(
        fmt::format("{} cells; expected {}, with commas between them and points as "
                    "decimal signs",
                    cells.size(), cells_.size()));
  }
  std::copy(cells.begin(), cells.end(), cells_.begin());
  WrenchRow row;
  row.secs = NumberIn(Cell(kTime), kCsvColumns[kTime], kMostSecs, lines_);
  const auto body = FindWrenchBody(Cell(kBody));
  if (!body) {
    lines_.Refuse(fmt::format("column body: {}: expected {}", Quoted(Cell(kBody)),
                              Alternatives(WrenchBodyNames())));
  }
  row.body = *body;
  const double sign = IsHand(row.body) ? 1 : sign_;
  row.force = sign * Vector(kForce, kMostForce);
  row.torque = sign * Vector(kTorque, kMostForce);
  const bool has_point =
      !Cell(kPoint).empty() || !Cell(kPoint + 1).empty() || !Cell(kPoint + 2).empty();
  if (has_point) row.point = Vector(kPoint, kFarthestPoint);

  if (row.secs < newest_secs_) {
    lines_.Refuse(fmt::format("time_s goes back from {} to {}; expected rows in order of time",
                              newest_secs_, row.secs));
  }
  if (row.secs <= newest_secs_of_[At(row.body)]) {
    lines_.Refuse(
        fmt::format("a second row of {} at {} s; expected one per time", Name(row.body), row.secs));
  }
  newest_secs_ = newest_secs_of_[At(row.body)] = row.secs;
  CheckRow(row, lines_);
  return row;
}

}  // namespace kinescope::wrenches
