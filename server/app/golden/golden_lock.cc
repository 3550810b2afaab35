#include "server/app/golden/golden_lock.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "core/picture_limits.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/sha256.h"
#include "core/system/starts_with.h"
#include "render/font.h"
#include "render/image/new_file.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kLockSchema = 1;
constexpr std::uintmax_t kMostLockBytes = 256 << 20;

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
  const std::string unmasked =
      accepted.unmasked_sha256.empty()
          ? ""
          : fmt::format(" \"unmasked\": \"{}\",\n", accepted.unmasked_sha256);
  return fmt::format(
      "{{\n \"pixels\": \"{}\",\n{} \"file\": \"{}\",\n \"width\": {}, \"height\": {},\n"
      " \"options\": {},\n {},\n \"environment\": {},\n {}\n}}",
      accepted.pixels_sha256, unmasked, accepted.file_sha256, accepted.width, accepted.height,
      JsonText(json(accepted.options)), InputLines(accepted.inputs),
      JsonText(json(accepted.environment)), ToJson(accepted.facts));
}

AcceptedCase AcceptedFrom(const json& json) {
  AcceptedCase accepted;
  accepted.pixels_sha256 = json.at("pixels");
  accepted.unmasked_sha256 = json.value("unmasked", "");
  accepted.file_sha256 = json.at("file");
  accepted.width = static_cast<int>(CountFrom(json.at("width"), kMaxPictureSide));
  accepted.height = static_cast<int>(CountFrom(json.at("height"), kMaxPictureSide));
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

GoldenLock ReadLock(const fs::path& path, std::string* pictures) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  std::string text;
  try {
    text = ReadSmallFile(path);
    return ParseLock(text, pictures);
  } catch (const std::exception& error) {
    const bool is_merged =
        text.find("\n<<<<<<<") != std::string::npos || StartsWith(text, "<<<<<<<");
    if (!is_merged) {
      throw std::runtime_error(
          fmt::format("{}: {}; restore it from version control", path.string(), error.what()));
    }
    throw std::runtime_error(
        path.string() +
        ": has the marks of a merge conflict; take one side whole (git checkout --ours or "
        "--theirs), then run `kinescope golden check` and accept what is to change");
  }
}

// JSON keeps the last of two members of one name, which a merge may have left behind.
GoldenLock ParseLock(const std::string& text, std::string* pictures) {
  constexpr int kDepthOfCases = 2;
  std::set<std::string> names;
  const auto see = [&](int depth, json::parse_event_t event, json& parsed) {
    if (event != json::parse_event_t::key || depth != kDepthOfCases) return true;
    if (names.insert(parsed.get<std::string>()).second) return true;
    throw std::runtime_error(
        fmt::format("{} stands there twice, as after a merge; remove the one "
                    "that is not accepted",
                    JsonText(parsed)));
  };
  const json document = ParseJsonOrThrow(text, see);
  if (document.at("schema") != kLockSchema) {
    throw std::runtime_error(fmt::format("schema {}; this version reads {}",
                                         JsonText(document.at("schema")), kLockSchema));
  }
  if (pictures != nullptr) *pictures = document.value("pictures", "");
  GoldenLock lock;
  for (const auto& [name, accepted] : document.at("cases").items()) {
    lock[name] = AcceptedFrom(accepted);
  }
  return lock;
}

std::string ReadSmallFile(const fs::path& path) {
  if (!fs::is_regular_file(path)) throw std::runtime_error("is no file");
  if (fs::file_size(path) > kMostLockBytes) {
    throw std::runtime_error(fmt::format("has more than {} bytes", kMostLockBytes));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot be read (no permission)");
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteLock(const fs::path& path, const GoldenLock& lock, const std::string& pictures) {
  std::string text = fmt::format("{{\"schema\": {},\n", kLockSchema);
  if (!pictures.empty()) text += fmt::format("\"pictures\": {},\n", JsonText(json(pictures)));
  text += "\"cases\": {";
  const char* separator = "\n";
  for (const auto& [name, accepted] : lock) {
    text += fmt::format("{}{}: {}", separator, JsonText(json(name)), ToJson(accepted));
    separator = ",\n";
  }
  render::WriteNewFile(path, text + "\n}}\n");
}

}  // namespace kinescope::app
