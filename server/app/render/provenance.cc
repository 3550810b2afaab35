#include "server/app/render/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "core/json_text.h"
#include "core/sha256.h"
#include "render/new_file.h"
#include "render/png_file.h"
#include "server/options/option_list.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr int kSchema = 1;
constexpr const char* kCapacityTable = "Stobbe 1982, Delp 1996, Vasavada 2001 (docs/loads.md)";

// Option names and values; those that nobody gave and that have no default are left out.
class ValueGetter {
 public:
  explicit ValueGetter(Json& values) : values_(values) {}

  template <class T>
  void operator()(const std::string& name, const T& value, const std::string& = {}) {
    if constexpr (OptionalOf<T>::value) {
      if (value) values_[name] = *value;
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      values_[name] = fmt::format("{}", fmt::join(value, ";"));  // as ParseOption reads it
    } else {
      values_[name] = value;
    }
  }

 private:
  Json& values_;
};

// Files that the value of an option names: the whole of it, what follows a colon ("mesh:FOLDER"),
// and parts of a list.
class FileFinder {
 public:
  template <class T>
  void operator()(const std::string& name, const T& value, const std::string& = {}) {
    if constexpr (std::is_same_v<T, std::string>) Look(name, value);
    if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      for (const std::string& each : value) Look(name, each);
    }
  }

  const Json& found() const { return found_; }

 private:
  void Look(const std::string& name, const std::string& value) {
    if (name == "title") return;
    std::vector<std::string> candidates = {value};
    for (std::size_t at = value.find_first_of(":,"); at != std::string::npos;
         at = value.find_first_of(":,", at + 1)) {
      const std::size_t end = value.find(',', at + 1);
      candidates.push_back(value.substr(at + 1, end - at - 1));
    }
    candidates.push_back(value.substr(0, value.find(',')));
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    for (const std::string& path : candidates) Add(name, path);
  }

  void Add(const std::string& name, const fs::path& path) {
    std::error_code ignored;
    if (fs::is_regular_file(path, ignored)) {
      const FileDigest digest = DigestOf(path);
      found_.push_back({{"option", name},
                        {"name", path.filename().string()},
                        {"sha256", digest.sha256},
                        {"bytes", digest.bytes}});
    } else if (path != "." && path != "/" && fs::is_directory(path, ignored)) {
      std::vector<fs::path> files;
      for (const auto& entry : fs::directory_iterator(path, ignored)) {
        if (entry.is_regular_file(ignored)) files.push_back(entry.path());
      }
      std::sort(files.begin(), files.end());
      for (const fs::path& file : files) Add(name, file);
    }
  }

  Json found_ = Json::array();
};

Json DescribeSource(const std::string& source, bool& is_repeatable) {
  std::error_code ignored;
  if (source.rfind("demo:", 0) == 0) return {{"name", source}};
  is_repeatable = fs::is_regular_file(source, ignored);
  if (!is_repeatable) return {{"name", fs::path(source).filename().string()}};
  const FileDigest digest = DigestOf(source);
  return {{"name", fs::path(source).filename().string()},
          {"sha256", digest.sha256},
          {"bytes", digest.bytes}};
}

Json DescribeLoads(const LoadOptions& options) {
  const loads::LoadClassifier::Settings classes = ToLoadSettings(options).classes;
  return {{"class_ratios_up", classes.up},
          {"class_ratios_down", classes.down},
          {"low_pass_secs", classes.low_pass_secs},
          {"dwell_up_secs", classes.dwell_up_secs},
          {"dwell_down_secs", classes.dwell_down_secs},
          {"capacities", kCapacityTable}};
}

const char* NameOf(OutputKind kind) {
  switch (kind) {
    case OutputKind::kStill: return "picture";
    case OutputKind::kSequence: return "sequence";
    case OutputKind::kClip: return "clip";
  }
  return "";
}

std::vector<double> ToList(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Provenance::Provenance(const RenderOptions& options, const std::string& source,
                       const render::RendererInfo& renderer)
    : options_(options) {
  FileFinder finder;
  RenderOptions copy = options;  // Visit() gives references that can be written
  copy.view.Visit(finder);
  copy.person.Visit(finder);
  copy.loads.Visit(finder);
  shared_ = {{"kinescope", KINESCOPE_VERSION},
             {"schema", kSchema},
             {"source", DescribeSource(source, is_repeatable_)},
             {"inputs", finder.found()},
             {"renderer", renderer.renderer},
             {"gl_version", renderer.gl_version},
             {"backend", renderer.backend},
             {"backend_note", renderer.note},
             {"loads", DescribeLoads(options.loads)}};
}

Json Provenance::Of(const Output& output, std::optional<long> number) const {
  Json result = shared_;
  result["kind"] = NameOf(output.kind);
  result["format"] = fs::path(output.path).extension().string().substr(1);
  Json values;
  RenderOptions copy = options_;
  copy.view.camera = output.camera;
  if (output.kind == OutputKind::kStill) {
    copy.moment.Visit(ValueGetter(values));
  } else {
    copy.clip.Visit(ValueGetter(values));
  }
  if (HasCrf(output.path)) {
    if (copy.pack.crf) values["crf"] = *copy.pack.crf;
  } else if (output.kind == OutputKind::kClip) {
    values["quality"] = copy.pack.quality;
  }
  copy.view.Visit(ValueGetter(values));
  copy.person.Visit(ValueGetter(values));
  copy.loads.Visit(ValueGetter(values));
  if (number) {
    result["number"] = *number;
    values.erase("seconds");  // a picture is the same in a longer sequence
    values.erase("end");
  }
  result["options"] = std::move(values);
  return result;
}

Json Describe(const render::Camera& camera) {
  return {{"position_m", ToList(camera.position)},
          {"target_m", ToList(camera.target)},
          {"up", ToList(camera.up)},
          {"vertical_fov_rad", camera.vertical_fov_rad}};
}

RenderOptions OptionsOf(const Json& provenance, const std::string& path) {
  if (provenance.value("schema", 0) != kSchema ||
      !provenance.value("options", Json()).is_object()) {
    throw std::runtime_error(
        fmt::format("its provenance is of another program or of a newer Kinescope ({})",
                    provenance.value("kinescope", "unknown")));
  }
  const Json& values = provenance.at("options");
  ValueSetter setter([&values](const std::string& name) -> std::optional<std::string> {
    const auto found = values.find(name);
    if (found == values.end()) return std::nullopt;
    return found->is_string() ? found->get<std::string>() : JsonText(*found);
  });
  RenderOptions options;
  options.moment.Visit(setter);
  options.clip.Visit(setter);
  options.pack.Visit(setter);
  options.view.Visit(setter);
  options.person.Visit(setter);
  options.loads.Visit(setter);
  // A .gif names a quality, too, which it does not have.
  if (!HasQuality(path)) options.pack.quality = PackOptions().quality;
  options.outs = {path};
  return options;
}

std::string ToText(const Json& provenance) { return JsonText(provenance, -1, JsonBytes::kAscii); }

std::optional<Json> FromText(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("kinescope")) return std::nullopt;
  return json;
}

bool DecideTheSame(const Json& a, const Json& b) {
  const auto decisive = [](const Json& given) {
    // Through text, so that 1.0 and 1 are what they are after reading.
    auto json = nlohmann::json::parse(ToText(given));
    for (const char* follows : {"camera", "path", "pictures", "file"}) json.erase(follows);
    return json;
  };
  return decisive(a) == decisive(b);
}

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
  constexpr std::uintmax_t kMostBytes = 16u << 20;  // ours have some kilobytes
  std::error_code error;
  const std::uintmax_t size = fs::file_size(SidecarOf(path), error);
  if (error || size > kMostBytes) return std::nullopt;
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

bool IsFinished(const Output& output, const Json& provenance, bool has_sidecar) {
  if (!has_sidecar) {
    const auto embedded = ReadEmbedded(output.path);
    return embedded && DecideTheSame(*embedded, provenance);
  }
  const auto sidecar = ReadSidecar(output.path);
  if (!sidecar || !DecideTheSame(*sidecar, provenance)) return false;
  try {
    const Json file = sidecar->value("file", Json());
    return file.is_object() && file.value("sha256", Json()) == DigestOf(output.path).sha256;
  } catch (const std::runtime_error&) {
    return false;  // the file is gone
  }
}

}  // namespace kinescope::app
