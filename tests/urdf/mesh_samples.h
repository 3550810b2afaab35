/// The same box in every format that is read: from (0, 0, 0) to (1, 2, 3) of its units, so that no
/// two axes can be mistaken for each other.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

namespace kinescope::testing {

inline constexpr std::array<std::array<int, 3>, 12> kBoxTriangles = {{{0, 2, 3},
                                                                      {0, 3, 1},
                                                                      {4, 5, 7},
                                                                      {4, 7, 6},
                                                                      {0, 1, 5},
                                                                      {0, 5, 4},
                                                                      {2, 6, 7},
                                                                      {2, 7, 3},
                                                                      {0, 4, 6},
                                                                      {0, 6, 2},
                                                                      {1, 3, 7},
                                                                      {1, 7, 5}}};

inline float BoxCorner(int corner, int axis) {
  return (corner >> axis) % 2 != 0 ? static_cast<float>(axis + 1) : 0;
}

template <class T>
void AppendBytes(std::string& to, T value) {  // little-endian, as every machine that we run on
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline std::string BoxStl(std::uint32_t announced = kBoxTriangles.size()) {
  std::string bytes(80, '\0');
  AppendBytes(bytes, announced);
  for (const auto& triangle : kBoxTriangles) {
    for (int i = 0; i < 3; ++i) AppendBytes(bytes, 0.0f);  // normal: not known
    for (const int corner : triangle) {
      for (int axis = 0; axis < 3; ++axis) AppendBytes(bytes, BoxCorner(corner, axis));
    }
    AppendBytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

inline std::string BoxObj(const std::string& before_faces = "") {
  std::string text = before_faces;
  for (int corner = 0; corner < 8; ++corner) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string(BoxCorner(corner, axis));
    text += "\n";
  }
  if (!before_faces.empty()) text += "usemtl paint\n";
  for (const auto& triangle : kBoxTriangles) {
    text += "f";
    for (const int corner : triangle) text += " " + std::to_string(corner + 1);
    text += "\n";
  }
  return text;
}

struct DaeOptions {
  std::string unit = "1";
  std::string up = "Z_UP";
  std::string count = "24";  // of the numbers
  std::string rgba = "0.8 0.1 0.2 1";
  std::string nodes =
      "<node id='n'><instance_geometry url='#g'><bind_material><technique_common>"
      "<instance_material symbol='s' target='#m'/></technique_common>"
      "</bind_material></instance_geometry></node>";
};

inline std::string BoxDae(const DaeOptions& options = {}) {
  std::string positions, corners;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) positions += std::to_string(BoxCorner(corner, axis)) + " ";
  }
  for (const auto& triangle : kBoxTriangles) {
    for (const int corner : triangle) corners += std::to_string(corner) + " ";
  }
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit name='u' meter='" +
         options.unit + "'/><up_axis>" + options.up +
         "</up_axis></asset><library_effects><effect id='e'><profile_COMMON><technique sid='c'>"
         "<lambert><diffuse><color>" +
         options.rgba +
         "</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
         "<library_materials><material id='m'><instance_effect url='#e'/></material>"
         "</library_materials><library_geometries><geometry id='g'><mesh><source id='p'>"
         "<float_array id='a' count='" +
         options.count + "'>" + positions +
         "</float_array><technique_common><accessor source='#a' count='8' stride='3'>"
         "<param name='X' type='float'/><param name='Y' type='float'/>"
         "<param name='Z' type='float'/></accessor></technique_common></source>"
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
         "<triangles count='12' material='s'><input semantic='VERTEX' source='#v' offset='0'/><p>" +
         corners +
         "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id='w'>" +
         options.nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#w'/></scene>"
         "</COLLADA>";
}

/// `json` without its braces, and the binary part, as a GLB.
inline std::string Glb(const std::string& json, const std::string& binary) {
  std::string text = "{" + json + "}";
  while (text.size() % 4 != 0) text += ' ';
  std::string bytes = "glTF";
  AppendBytes(bytes, std::uint32_t{2});
  AppendBytes(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
  AppendBytes(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  AppendBytes(bytes, static_cast<std::uint32_t>(binary.size()));
  return bytes + std::string("BIN\0", 4) + binary;
}

struct GlbOptions {
  std::string position_count = "8";
  std::string nodes = R"([{"mesh":0}])";
  std::string buffer_bytes = "168";
  std::string more;  // such as ,"a":1
};

inline std::string BoxGlb(const GlbOptions& options = {}) {
  std::string binary;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) AppendBytes(binary, BoxCorner(corner, axis));
  }
  for (const auto& triangle : kBoxTriangles) {
    for (const int corner : triangle) AppendBytes(binary, static_cast<std::uint16_t>(corner));
  }
  return Glb(
      R"("asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + options.nodes +
          R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,)"
          R"("material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":)"
          R"([0.5,0,0,1]}}],"buffers":[{"byteLength":)" +
          options.buffer_bytes +
          R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},)"
          R"({"buffer":0,"byteOffset":96,"byteLength":72}],"accessors":[{"bufferView":0,)"
          R"("componentType":5126,"type":"VEC3","min":[0,0,0],"max":[1,2,3],"count":)" +
          options.position_count +
          R"(},{"bufferView":1,"componentType":5123,"type":"SCALAR","count":36}])" + options.more,
      binary);
}

}  // namespace kinescope::testing
