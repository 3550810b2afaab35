/// The formats that `kinescope convert` writes. A further format is a MotionFile and a line in
/// MotionFormats(). One thread.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene_state.h"
#include "server/app/convert/motion_rows.h"

namespace kinescope::app {

/// How the columns of a table are arranged. kWide: one row per sample. kLong: one row per value.
enum class TableLayout { kWide, kLong };

/// What the first second of a motion says about all of it, for files that must say it first.
struct MotionOutline {
  std::string source;                         // name of the file or stream
  double rate_hz = 0;                         // samples per second; 0: unknown, of a single sample
  std::int64_t begin_nanos = 0;               // stamp of the first sample: time 0
  QuantitySet quantities;                     // that were asked for and that the source has
  std::bitset<urdf::kSegmentCount> trackers;  // of any person
  bool has_foot_contacts = false;
  std::string provenance;  // JSON, in ASCII
  TableLayout layout = TableLayout::kWide;
};

/// A file under construction. It gets its name with Finish(); without it, nothing remains. All
/// functions @throw std::runtime_error with the path and the reason.
class MotionFile {
 public:
  virtual ~MotionFile() = default;
  MotionFile(const MotionFile&) = delete;
  MotionFile& operator=(const MotionFile&) = delete;

  /// The next sample of any person. `frame`: its number at the constant rate of the file, per
  /// person from 0; missing samples are counted.
  virtual void Add(const PersonState& person, std::int64_t frame) = 0;
  virtual void Finish() = 0;
  /// The files, and one sentence for each thing that the format could not hold. Valid after
  /// Finish().
  virtual std::vector<std::string> paths() const = 0;
  virtual std::vector<std::string> notes() const { return {}; }

 protected:
  MotionFile() = default;
};

struct MotionFormat {
  std::string ending;  // ".csv"
  std::string about;
  std::unique_ptr<MotionFile> (*make)(const std::string& path, const MotionOutline& outline);
};

const std::vector<MotionFormat>& MotionFormats();

/// By the ending of `path`; null if there is none.
const MotionFormat* FindMotionFormat(const std::string& path);

/// ".csv (table) or .mvnx (MVNX 4)", for --help and errors.
std::string MotionFormatNames();

}  // namespace kinescope::app
