#include "server/wrenches/wrench_reader.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/system/errors.h"
#include "server/wrenches/csv_wrenches.h"
#include "server/wrenches/mot_wrenches.h"

namespace kinescope::wrenches {
namespace {

// At the times and places that the settings give.
class PlacedWrenches : public WrenchReader {
 public:
  PlacedWrenches(std::unique_ptr<WrenchReader> rows, const WrenchSettings& settings)
      : rows_(std::move(rows)),
        offset_secs_(settings.offset_secs),
        turn_(Eigen::AngleAxisd(settings.place.z(), Eigen::Vector3d::UnitZ())),
        origin_(settings.place.x(), settings.place.y(), 0) {}

  std::optional<WrenchRow> Next() override {
    std::optional<WrenchRow> row = rows_->Next();
    if (!row) return row;
    row->secs += offset_secs_;
    row->force = turn_ * row->force;
    row->torque = turn_ * row->torque;
    if (row->point) *row->point = origin_ + turn_ * *row->point;
    return row;
  }

 private:
  std::unique_ptr<WrenchReader> rows_;
  const double offset_secs_;
  const Eigen::Matrix3d turn_;
  const Eigen::Vector3d origin_;
};

}  // namespace

std::optional<WrenchFormat> FindWrenchFormat(const std::string& path) {
  std::filesystem::path name(path);
  for (const char* packed : {".gz", ".xz", ".zst", ".bz2", ".lz4"}) {
    if (name.extension() == packed) {
      name.replace_extension();
      break;
    }
  }
  const std::string ending = name.extension().string();
  if (ending == ".csv") return WrenchFormat::kCsv;
  if (ending == ".mot" || ending == ".sto") return WrenchFormat::kMot;
  return std::nullopt;
}

WrenchFormat WrenchFormatOf(const std::string& path) {
  if (const auto format = FindWrenchFormat(path)) return *format;
  throw SourceError(path + ": unknown kind of file; expected the ending .csv, .mot or .sto");
}

std::unique_ptr<WrenchReader> ReadWrenches(InputFile file, const std::string& name,
                                           WrenchFormat format, const WrenchSettings& settings) {
  BoundedLines lines(std::move(file), name);
  const double sign = settings.is_on_plate ? -1 : 1;
  std::unique_ptr<WrenchReader> rows;
  if (format == WrenchFormat::kMot) {
    rows = std::make_unique<MotWrenches>(std::move(lines), settings.groups, sign);
  } else if (settings.groups.empty()) {
    rows = std::make_unique<CsvWrenches>(std::move(lines), sign);
  } else {
    throw UsageError("--wrench_bodies: has no effect with a CSV file, which names its bodies");
  }
  return std::make_unique<PlacedWrenches>(std::move(rows), settings);
}

}  // namespace kinescope::wrenches
