#include "render/vtk/mesh_file.h"
#include "server/app/mesh_module.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopeMeshModule() {
  static const kinescope::app::MeshModule module = {
      {}, [](const std::string& path) { return kinescope::render::ReadMeshFile(path); }};
  return &module;
}
