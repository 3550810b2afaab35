#include "urdf/rig/glb_writer.h"

#include <algorithm>
#include <array>

namespace kinescope::rig {
namespace {

using nlohmann::json;

std::size_t RoundedUp(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

}  // namespace

GlbWriter::GlbWriter() {
  document_["asset"] = {{"version", "2.0"}, {"generator", "Kinescope"}};
  document_["scene"] = 0;
}

std::size_t GlbWriter::AddBytes(const void* bytes, std::size_t size, std::size_t count,
                                const Kind& kind) {
  json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
  if (kind.target != 0) view["target"] = kind.target;
  document_["bufferViews"].push_back(std::move(view));
  binary_.append(static_cast<const char*>(bytes), size);
  binary_.resize(RoundedUp(binary_.size()), '\0');
  document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                    {"componentType", kind.component},
                                    {"count", count},
                                    {"type", kind.type}});
  return document_["accessors"].size() - 1;
}

std::size_t GlbWriter::AddPositions(const std::vector<float>& values) {
  const std::size_t accessor = Add(values, {kFloat, "VEC3", 3, kOfVertices});
  std::array<float, 3> least = {values[0], values[1], values[2]}, most = least;
  for (std::size_t i = 0; i < values.size(); ++i) {
    least[i % 3] = std::min(least[i % 3], values[i]);
    most[i % 3] = std::max(most[i % 3], values[i]);
  }
  document_["accessors"][accessor]["min"] = least;
  document_["accessors"][accessor]["max"] = most;
  return accessor;
}

std::string GlbWriter::Write() {
  if (!binary_.empty()) document_["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string text = document_.dump();
  text.resize(RoundedUp(text.size()), ' ');
  std::string glb = "glTF";
  const auto word = [&](std::size_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    glb.append(reinterpret_cast<const char*>(&bits), sizeof bits);
  };
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;
  const std::size_t binary_chunk = binary_.empty() ? 0 : kChunkHeader + binary_.size();
  glb.reserve(kHeader + kChunkHeader + text.size() + binary_chunk);
  word(kVersion);
  word(kHeader + kChunkHeader + text.size() + binary_chunk);
  word(text.size());
  word(kJson);
  glb += text;
  if (binary_.empty()) return glb;
  word(binary_.size());
  word(kBinary);
  return glb + binary_;
}

const Eigen::Matrix3d& GlbAxes() {
  static const Eigen::Matrix3d kAxes = (Eigen::Matrix3d() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished();
  return kAxes;
}

}  // namespace kinescope::rig
