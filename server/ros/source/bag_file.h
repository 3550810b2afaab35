/// Provides a bag as a file that rosbag can seek in. A bag that is compressed as a whole is
/// decompressed to a temporary file without a name, which the system deletes when it is closed. One
/// thread.
#pragma once

#include <string>

#include "core/system/input_file.h"

namespace kinescope::ros_bridge {

class BagFile {
 public:
  /// @throws SourceError with `path` and the remedy.
  explicit BagFile(const std::string& path);

  /// Path to open; valid while this object exists.
  const std::string& path() const { return path_; }

 private:
  struct Descriptor {
    Descriptor() = default;
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number = -1;
  };

  void Unpack(InputFile packed);

  std::string path_;
  Descriptor unpacked_;  // the temporary file, if needed
};

}  // namespace kinescope::ros_bridge
