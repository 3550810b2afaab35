/// `kinescope urdf picture`: any robot as a picture.
#pragma once

#include <string>
#include <vector>

#include "server/picture/backend.h"
#include "server/picture/view_options.h"

namespace kinescope::app {

struct UrdfPictureOptions {
  std::string file;
  std::string out;
  ViewOptions view;
  BackendOptions backend;
  bool json = false;
  std::vector<std::string> joints;        // NAME=RADIANS (or metres)
  std::vector<std::string> package_path;  // folders
};

/// Draws the robot standing on the floor and writes options.out. Says on the log which meshes are
/// boxes instead. @throws SourceError, UsageError.
void DrawUrdf(const UrdfPictureOptions& options);

}  // namespace kinescope::app
