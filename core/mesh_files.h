/// The mesh files that the URDF of a person names. A model names them without writing them: a
/// stream may change the body with every sample, and most bodies are never shown.
///
/// Readers in this process, the renderer and the page, read the meshes from memory, by Content().
/// Files are only written for other programs: the sink that passes the URDF of a model on to one
/// calls Provide() first, such as the ROS bridge before it sets robot_description. RViz reads the
/// files later, whenever its RobotModel display is enabled. Therefore the files stay as long as
/// this object exists, and a sink keeps the model while its URDF is published.
#pragma once

#include <memory>
#include <string>

namespace kinescope {

class MeshFiles {
 public:
  virtual ~MeshFiles() = default;
  MeshFiles(const MeshFiles&) = delete;
  MeshFiles& operator=(const MeshFiles&) = delete;

  /// The content of the file called `name`, such as "right_forearm.stl", without reading or writing
  /// files. Null if the set has no such file. Any thread; may take milliseconds.
  virtual std::shared_ptr<const std::string> Content(const std::string& name) const = 0;

  /// Writes the files unless they exist. Waits for the disk. Any thread.
  /// @return false if they cannot be written; the reason is in the log.
  virtual bool Provide() const = 0;

 protected:
  MeshFiles() = default;
};

}  // namespace kinescope
