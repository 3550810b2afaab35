#include "server/body/own_skin.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "server/body/body_color.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"

namespace kinescope::app {
namespace {

using Fault = std::runtime_error;

std::string BytesOf(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw Fault("no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw Fault("not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Fault(error.message());
  if (size > rig::kMaxFileBytes) {
    throw Fault("is larger than " + std::to_string(rig::kMaxFileBytes >> 20) +
                " MiB; textures, which are not drawn, can be left out");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) throw Fault("cannot be read");
  return bytes;
}

skin::SkinTemplate::Color SafeColor(const skin::SkinTemplate::Color& color) {
  const Rgb safe = NearestSafeColor({color[0] / 255.0, color[1] / 255.0, color[2] / 255.0});
  skin::SkinTemplate::Color bytes = color;
  for (std::size_t i = 0; i < safe.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(std::lround(255 * safe[i]));
  }
  return bytes;
}

}  // namespace

std::shared_ptr<const skin::SkinTemplate> ReadOwnSkin(const std::filesystem::path& path) {
  const rig::Rig rig = rig::ReadRig(BytesOf(path));
  auto skin = std::make_shared<skin::SkinTemplate>(rig::SkinOf(rig));
  std::map<skin::SkinTemplate::Color, skin::SkinTemplate::Color> safe;
  std::size_t changed = 0;
  for (skin::SkinTemplate::Color& color : skin->colors) {
    const auto [known, is_new] = safe.emplace(color, color);
    if (is_new) {
      known->second = SafeColor(color);
      changed += known->second != color ? 1 : 0;
    }
    color = known->second;
  }
  if (changed > 0) {
    spdlog::warn("{}: {} of its {} colours look like those of load classes and were changed",
                 path.string(), changed, safe.size());
  }
  if (rig.has_textures) {
    spdlog::info("{}: its textures are not drawn; textured parts have one plain colour",
                 path.string());
  }
  return skin;
}

}  // namespace kinescope::app
