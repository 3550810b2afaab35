/// The mesh files that the URDF of a person names. A model names them without writing them: a
/// stream may change the body with every sample, and most bodies are never shown.
///
/// Everything that reads the files of a model, or passes its URDF on to a program that does, calls
/// Provide() first: the renderer before it reads a model, the page's route before it serves a mesh,
/// the ROS bridge before it sets robot_description. RViz reads the files later, whenever its
/// RobotModel display is enabled. Therefore the files stay as long as this object exists, and a
/// sink keeps the model while its URDF is published.
#pragma once

namespace kinescope {

class MeshFiles {
 public:
  virtual ~MeshFiles() = default;
  MeshFiles(const MeshFiles&) = delete;
  MeshFiles& operator=(const MeshFiles&) = delete;

  /// Writes the files unless they exist. Waits for the disk. Any thread.
  /// @return false if they cannot be written; the reason is in the log.
  virtual bool Provide() const = 0;

 protected:
  MeshFiles() = default;
};

}  // namespace kinescope
