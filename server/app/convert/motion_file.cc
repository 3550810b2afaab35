#include "server/app/convert/motion_file.h"

#include <filesystem>

#include "server/app/convert/motion_csv.h"
#include "server/app/convert/motion_mvnx.h"

namespace kinescope::app {

const std::vector<MotionFormat>& MotionFormats() {
  static const std::vector<MotionFormat> kFormats = {
      {".csv", "table, wide or long", &MakeMotionCsv},
      {".mvnx", "MVNX 4, a file per person", &MakeMotionMvnx},
  };
  return kFormats;
}

const MotionFormat* FindMotionFormat(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  for (const MotionFormat& format : MotionFormats()) {
    if (format.ending == ending) return &format;
  }
  return nullptr;
}

std::string MotionFormatNames() {
  std::string names;
  for (const MotionFormat& format : MotionFormats()) {
    if (!names.empty()) names += &format == &MotionFormats().back() ? " or " : ", ";
    names += format.ending + " (" + format.about + ")";
  }
  return names;
}

}  // namespace kinescope::app
