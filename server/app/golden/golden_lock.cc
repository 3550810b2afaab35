#include "server/app/golden/golden_lock.h"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "core/system/json_text.h"
#include "core/system/sha256.h"
#include "render/font.h"
#include "render/image/new_file.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using nlohmann::json;

constexpr int kLockSchema = 1;

std::string InputLines(const std::vector<InputFact>& inputs) {
  std::string lines = "\"inputs\": [";
  const char* separator = "\n  ";
  for (const InputFact& input : inputs) {
    Json line = {{"option", input.option}, {"name", input.name}};
    if (!input.sha256.empty()) line["sha256"] = input.sha256;
    lines += separator + JsonText(line);
    separator = ",\n  ";
  }
  return lines + (inputs.empty() ? "]" : "\n ]");
}

}  // namespace

std::string PixelsHash(const render::Image& image) {
  const std::string size = fmt::format("{}x{}\n", image.width, image.height);
  Sha256 hash;
  hash.Add(size);
  hash.Add({reinterpret_cast<const char*>(image.rgba.data()), image.rgba.size()});
  return hash.Finish();
}

std::map<std::string, std::string> EnvironmentOf(const render::RendererInfo& renderer) {
  return {{"backend", renderer.backend},
          {"renderer", renderer.renderer},
          {"gl_version", renderer.gl_version},
          {"scene_library", renderer.scene_library},
          {"font", DigestOf(render::FontPath("DejaVuSans.ttf")).sha256},
          {"bold font", DigestOf(render::FontPath("DejaVuSans-Bold.ttf")).sha256}};
}

std::string ToJson(const AcceptedCase& accepted) {
  return fmt::format(
      "{{\n \"pixels\": \"{}\",\n \"file\": \"{}\",\n \"width\": {}, \"height\": {},\n"
      " \"options\": {},\n {},\n \"environment\": {},\n {}\n}}",
      accepted.pixels_sha256, accepted.file_sha256, accepted.width, accepted.height,
      JsonText(json(accepted.options)), InputLines(accepted.inputs),
      JsonText(json(accepted.environment)), ToJson(accepted.facts));
}

AcceptedCase AcceptedFrom(const json& json) {
  AcceptedCase accepted;
  accepted.pixels_sha256 = json.at("pixels");
  accepted.file_sha256 = json.at("file");
  accepted.width = json.at("width");
  accepted.height = json.at("height");
  for (const auto& [name, value] : json.at("options").items()) accepted.options[name] = value;
  for (const auto& input : json.at("inputs")) {
    accepted.inputs.push_back({input.at("option"), input.at("name"), input.value("sha256", "")});
  }
  for (const auto& [name, value] : json.at("environment").items()) {
    accepted.environment[name] = value.get<std::string>();
  }
  accepted.facts = FactsFrom(json);
  return accepted;
}

GoldenLock ReadLock(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read (no permission)");
  GoldenLock lock;
  try {
    const json document = json::parse(file);
    if (const int schema = document.at("schema"); schema != kLockSchema) {
      throw std::runtime_error(
          fmt::format("{}: schema {}; this version reads {}", path.string(), schema, kLockSchema));
    }
    for (const auto& [name, accepted] : document.at("cases").items()) {
      lock[name] = AcceptedFrom(accepted);
    }
  } catch (const std::ios_base::failure&) {
    throw std::runtime_error(path.string() + ": cannot be read (a folder?)");
  } catch (const json::exception& error) {
    throw std::runtime_error(
        fmt::format("{}: {}; restore it from version control", path.string(), error.what()));
  }
  return lock;
}

void WriteLock(const fs::path& path, const GoldenLock& lock) {
  std::string text = fmt::format("{{\"schema\": {},\n\"cases\": {{", kLockSchema);
  const char* separator = "\n";
  for (const auto& [name, accepted] : lock) {
    text += fmt::format("{}{}: {}", separator, JsonText(json(name)), ToJson(accepted));
    separator = ",\n";
  }
  render::WriteNewFile(path, text + "\n}}\n");
}

}  // namespace kinescope::app
