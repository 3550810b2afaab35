#include "server/app/render/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "server/options/option_json.h"
#include "server/options/option_list.h"
#include "server/scene/scene_options.h"
#include "server/source/source_identity.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCapacityTable = "Stobbe 1982, Delp 1996, Vasavada 2001 (docs/loads.md)";

Json DescribeLoads(const LoadOptions& options) {
  const loads::LoadMeter::Settings meter = ToLoadSettings(options).meter;
  return {{"class_ratios_up", meter.up},  {"class_ratios_down", meter.down},
          {"rise_secs", meter.rise_secs}, {"hold_secs", meter.hold_secs},
          {"fall_secs", meter.fall_secs}, {"capacities", kCapacityTable}};
}

const char* NameOf(OutputKind kind) {
  switch (kind) {
    case OutputKind::kStill: return "picture";
    case OutputKind::kSequence: return "sequence";
    case OutputKind::kClip: return "clip";
  }
  return "";
}

// The options that determine pixels, of every kind of output.
options::OptionList DecidingOptions(RenderOptions& options) {
  options::OptionList list;
  options.moment.List(list);
  options.clip.List(list);
  options.pack.List(list);
  options.view.List(list);
  options.person.List(list);
  options.loads.List(list);
  return list;
}

// --figure means something else since schema 2.
std::string NameSince(int schema, const std::string& name) {
  return schema == 1 && name == "figure" ? "body_model" : name;
}

// Earlier versions did not name it.
int EncodingOf(const Json& provenance) {
  const int encoding = provenance.value("encoding", 1);
  if (encoding >= 1 && encoding <= render::kClipEncoding) return encoding;
  throw std::runtime_error(
      fmt::format("provenance from a newer Kinescope ({}): encoding {}; expected 1 to {}",
                  provenance.value("kinescope", "unknown"), encoding, render::kClipEncoding));
}

}  // namespace

Provenance::Provenance(const RenderOptions& options, const std::string& source,
                       const render::RendererInfo& renderer)
    : options_(options) {
  RenderOptions copy = options;  // a list refers to values that can be set
  options::OptionList list;
  copy.view.List(list);
  copy.person.List(list);
  copy.loads.List(list);
  const SourceIdentity identity = IdentityOf(source);
  is_repeatable_ = identity.is_repeatable;
  shared_ = {{"kinescope", KINESCOPE_VERSION},       {"schema", kProvenanceSchema},
             {"source", ToJson(identity)},           {"inputs", options::InputsOf(list)},
             {"renderer", renderer.renderer},        {"gl_version", renderer.gl_version},
             {"backend", renderer.backend},          {"backend_note", renderer.note},
             {"loads", DescribeLoads(options.loads)}};
}

Json Provenance::Of(const Output& output, std::optional<long> number) const {
  Json result = shared_;
  result["kind"] = NameOf(output.kind);
  result["format"] = fs::path(output.path).extension().string().substr(1);
  RenderOptions copy = options_;
  copy.view.camera.Parse(output.camera);
  options::OptionList list;
  if (output.kind == OutputKind::kStill) {
    copy.moment.List(list);
  } else {
    copy.clip.List(list);
  }
  copy.view.List(list);
  copy.person.List(list);
  copy.loads.List(list);
  Json values = options::ValuesOf(list);
  if (HasCrf(output.path)) {
    result["encoding"] = copy.pack.encoding;
    if (copy.pack.crf) values["crf"] = *copy.pack.crf;
  } else if (output.kind == OutputKind::kClip) {
    values["quality"] = *copy.pack.quality;
  }
  if (number) result["number"] = *number;
  if (number && !DependsOnWholeClip(copy.view)) {
    values.erase("seconds");  // a picture is the same in a longer sequence
    values.erase("end");
  }
  result["options"] = std::move(values);
  return result;
}

RenderOptions OptionsOf(const Json& provenance, const std::string& path) {
  const int schema = provenance.value("schema", 0);
  if (schema < 1 || schema > kProvenanceSchema ||
      !provenance.value("options", Json()).is_object()) {
    throw std::runtime_error(
        fmt::format("provenance from an unknown program or a newer Kinescope ({})",
                    provenance.value("kinescope", "unknown")));
  }
  Json values = Json::object();
  for (const auto& [name, value] : provenance.at("options").items()) {
    values[NameSince(schema, name)] = value;
  }
  if (!values.contains("figure")) {  // of a version before skins and headings
    values["figure"] = "urdf";
    values["camera_frame"] = "world";
    if (!values.contains("fit")) values["fit"] = "off";
  }
  const auto lookup = [&values](const std::string& name) -> std::optional<options::Found> {
    const auto found = values.find(name);
    if (found == values.end() || found->empty()) return std::nullopt;
    if (found->is_array()) return options::Found{"", "provenance: ", *found};
    const std::string text = found->is_string() ? found->get<std::string>() : JsonText(*found);
    if (text.empty()) return std::nullopt;  // schema 1 has "" where nothing was given
    return options::Found{text, "provenance: "};
  };
  RenderOptions options;
  options::OptionList list = DecidingOptions(options);
  options::SetFrom(lookup, options::Channel::kFile, list);
  options.pack.encoding = EncodingOf(provenance);
  // A .gif names a quality, too, which it does not have.
  if (!HasQuality(path)) options.pack.quality = *PackOptions().quality;
  options.outs = std::vector<std::string>{path};
  return options;
}

std::vector<std::string> UnknownOptionsOf(const Json& provenance) {
  RenderOptions options;
  options::OptionList list = DecidingOptions(options);
  std::vector<std::string> unknown;
  const Json values = provenance.value("options", Json::object());
  for (const auto& [name, value] : values.items()) {
    if (list.Find(name) == nullptr) unknown.push_back(name);
  }
  return unknown;
}

std::string PresentNameOf(const std::string& former_name, int schema) {
  const std::string name = NameSince(schema, former_name);
  RenderOptions options;
  options::OptionList list = DecidingOptions(options);
  const options::Option* const option = list.Find(name);
  return option == nullptr ? name : option->name;
}

bool DependsOnWholeClip(const ViewOptions& options) {
  const Fit fit = *options.moves.fit;  // auto: of a clip
  const bool is_legend_beside =
      *options.legend == LegendChoice::kBelow || *options.legend == LegendChoice::kOutside;
  return !options.plot->empty() || is_legend_beside || fit == Fit::kClip || fit == Fit::kAuto ||
         options.moves.orbit->is_one_turn;
}

std::string ToText(const Json& provenance) { return JsonText(provenance, -1, JsonBytes::kAscii); }

std::optional<Json> FromText(const std::string& text) {
  Json json = ParseOrderedJson(text);
  if (!json.is_object() || !json.contains("kinescope")) return std::nullopt;
  return json;
}

}  // namespace kinescope::app
