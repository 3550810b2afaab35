/// A bag as rosbag wants it: a file to seek in. What is compressed as a whole is unpacked to a
/// temporary file without a name, which is gone when nobody has it open any more.
#pragma once

#include <string>

#include "core/input_file.h"

namespace kinescope::ros_bridge {

class BagFile {
 public:
  /// @throws SourceError naming `path` and what would help.
  explicit BagFile(const std::string& path);

  /// What to open; valid while this lives.
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
  Descriptor unpacked_;  // the temporary file, where one is needed
};

}  // namespace kinescope::ros_bridge
