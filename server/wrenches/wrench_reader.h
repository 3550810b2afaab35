/// Reads files of measured forces, row by row: memory does not grow with the file. One thread.
/// Formats (docs/loads.md): CSV with the columns of kCsvColumns, and OpenSim's MOT and STO, which
/// are y up. Packed files are unpacked while they are read.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/system/input_file.h"
#include "server/wrenches/wrench_row.h"

namespace kinescope::wrenches {

class WrenchReader {
 public:
  virtual ~WrenchReader() = default;
  WrenchReader(const WrenchReader&) = delete;
  WrenchReader& operator=(const WrenchReader&) = delete;

  /// The next row; nullopt at the end. Times never decrease; those of one body increase.
  /// @throws SourceError with file, line, value and what was expected.
  virtual std::optional<WrenchRow> Next() = 0;

 protected:
  WrenchReader() = default;
};

enum class WrenchFormat { kCsv, kMot };

/// By the ending of `path`, .csv, .mot or .sto; .gz and the like may follow. nullopt: another one.
std::optional<WrenchFormat> FindWrenchFormat(const std::string& path);
/// @throws SourceError for another ending.
WrenchFormat WrenchFormatOf(const std::string& path);

struct WrenchSettings {
  std::string path;
  std::vector<GroupBody> groups;  // of MOT and STO; by name where a group is not listed
  double offset_secs = 0;         // added to the times of the file
  bool is_on_plate = false;       // feet and ground: the file has the force on the plate
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // of the file's origin in the world: x and y
                                                    // (m), and yaw (rad)
};

/// Reads `file`, named `name` in errors. Times, signs and places as in the settings.
/// @throws SourceError if the header is refused; UsageError if the groups do not fit it.
std::unique_ptr<WrenchReader> ReadWrenches(InputFile file, const std::string& name,
                                           WrenchFormat format, const WrenchSettings& settings);

}  // namespace kinescope::wrenches
