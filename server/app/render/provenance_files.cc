#include "server/app/render/provenance_files.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/system/json_text.h"
#include "core/system/sha256.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "render/video.h"

namespace kinescope::app {

std::optional<Json> ReadEmbedded(const std::string& path) {
  try {
    std::map<std::string, std::string> texts;
    std::string key = "comment";
    if (render::ClipFormatOf(path)) {
      texts = render::OpenVideo(path)->metadata();
    } else {
      texts = render::ReadPngText(path);
      key = kProvenanceKey;
    }
    const auto found = texts.find(key);
    return found == texts.end() ? std::nullopt : FromText(found->second);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

std::string SidecarOf(const std::string& path) { return path + ".json"; }

std::optional<Json> ReadSidecar(const std::string& path) {
  constexpr std::uintmax_t kMaxBytes = 16u << 20;  // ours have some kilobytes
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(SidecarOf(path), error);
  if (error || size > kMaxBytes) return std::nullopt;
  std::ifstream file(SidecarOf(path), std::ios::binary);
  return FromText({std::istreambuf_iterator<char>(file), {}});
}

void WriteSidecar(const Output& output, Json provenance, const std::string& source, long pictures) {
  provenance["path"] = source;
  provenance["pictures"] = pictures;
  if (output.kind != OutputKind::kSequence) {
    const FileDigest digest = DigestOf(output.path);
    provenance["file"] = {{"sha256", digest.sha256}, {"bytes", digest.bytes}};
  }
  const std::string text = JsonText(provenance, 2, JsonBytes::kAscii) + "\n";
  render::WriteNewFile(SidecarOf(output.path), text);
}

}  // namespace kinescope::app
