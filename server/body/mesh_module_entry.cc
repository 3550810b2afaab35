#include "server/body/mesh_module.h"
#include "urdf/mesh/mesh_file.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopeMeshModule() {
  static const kinescope::app::MeshModule module = {
      {}, [](const std::string& path) { return kinescope::urdf::ReadMeshFile(path); }};
  return &module;
}
