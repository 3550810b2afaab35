/// Writes GLB files (glTF 2.0): a document, to which arrays are added as accessors. One thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kinescope::rig {

class GlbWriter {
 public:
  /// Kinds of components and targets, as glTF numbers them.
  enum : int {
    kUnsignedByte = 5121,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126,
    kOfVertices = 34962,
    kOfIndices = 34963
  };
  struct Kind {
    int component = 0;
    const char* type = "";  // "VEC3"
    std::size_t per_element = 1;
    int target = 0;  // 0: none
  };

  GlbWriter();

  /// Its scene 0 is shown.
  nlohmann::json& document() { return document_; }

  /// Returns the number of the accessor.
  template <class T>
  std::size_t Add(const std::vector<T>& values, const Kind& kind) {
    return AddBytes(values.data(), sizeof(T) * values.size(), values.size() / kind.per_element,
                    kind);
  }
  /// Of positions, with the box around them, which glTF demands. @pre there are some
  std::size_t AddPositions(const std::vector<float>& values);

  /// The file. Call it once, at the end.
  std::string Write();

 private:
  std::size_t AddBytes(const void* bytes, std::size_t size, std::size_t count, const Kind& kind);

  nlohmann::json document_;
  std::string binary_;
};

/// From x forward, y left, z up to the axes of the format: x left, y up, z forward.
const Eigen::Matrix3d& GlbAxes();

}  // namespace kinescope::rig
