#include "urdf/rig/glb_container.h"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace kinescope::urdf {
namespace {

using Fault = std::runtime_error;

std::uint32_t GlbWord(std::string_view bytes, std::size_t at) {  // little-endian
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

// The depth alone: brackets within strings do not count.
void CheckJsonDepth(std::string_view text) {
  int depth = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_string = !is_string;
    if (is_string && c == '\\') ++i;
    if (is_string) continue;
    if ((c == '[' || c == '{') && ++depth > kMaxGlbDepth) {
      throw Fault("its JSON is nested too deeply");
    }
    if (c == ']' || c == '}') --depth;
  }
}

}  // namespace

GlbChunks SplitGlb(std::string_view bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4E4F534A;
  if (bytes.size() < kHeader + kChunkHeader || bytes.compare(0, 4, "glTF") != 0) {
    throw Fault("not a GLB: it does not begin with 'glTF'");
  }
  if (GlbWord(bytes, 4) != 2) {
    throw Fault("GLB version " + std::to_string(GlbWord(bytes, 4)) + "; expected 2");
  }
  const std::uint64_t json_bytes = GlbWord(bytes, kHeader);
  if (GlbWord(bytes, 8) > bytes.size() || GlbWord(bytes, kHeader + 4) != kJson ||
      json_bytes > bytes.size() - kHeader - kChunkHeader) {
    throw Fault("it declares " + std::to_string(GlbWord(bytes, 8)) + " bytes and " +
                std::to_string(json_bytes) + " of JSON, but has " + std::to_string(bytes.size()));
  }
  GlbChunks chunks;
  chunks.json = bytes.substr(kHeader + kChunkHeader, json_bytes);
  const std::size_t binary = kHeader + kChunkHeader + json_bytes;
  if (bytes.size() - binary < kChunkHeader) return chunks;
  const std::uint64_t binary_bytes = GlbWord(bytes, binary);
  if (binary_bytes > bytes.size() - binary - kChunkHeader) {
    throw Fault("its binary part declares " + std::to_string(binary_bytes) +
                " bytes, but the file ends before");
  }
  chunks.binary = bytes.substr(binary + kChunkHeader, binary_bytes);
  return chunks;
}

nlohmann::json ParseGlbJson(std::string_view text) {
  if (text.size() > kMaxGlbJsonBytes) throw Fault("its JSON part is too large");
  CheckJsonDepth(text);
  nlohmann::json document = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) throw Fault("its JSON part is not an object");
  return document;
}

}  // namespace kinescope::urdf
