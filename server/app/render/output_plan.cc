#include "server/app/render/output_plan.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "core/system/errors.h"
#include "core/system/not_source.h"
#include "server/app/render/provenance_files.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

// Where in a name the number of the picture goes.
struct NumberPlace {
  std::size_t begin = 0, size = 0;
  std::size_t digits = 1;  // at least so many
};

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::vector<NumberPlace> FindNumbers(const std::string& path) {
  std::vector<NumberPlace> places;
  for (std::size_t i = path.rfind('/') + 1; i < path.size(); ++i) {  // npos + 1 is 0
    if (path[i] == '#') {
      std::size_t end = i;
      while (end < path.size() && path[end] == '#') ++end;
      places.push_back({i, end - i, end - i});
      i = end - 1;
    } else if (path[i] == '%') {
      std::size_t end = i + 1;
      while (end < path.size() && end - i <= 2 && IsDigit(path[end])) ++end;
      if (end >= path.size() || path[end] != 'd') continue;  // "100%.png" is only a name
      const std::string digits = path.substr(i + 1, end - i - 1);
      places.push_back({i, end + 1 - i, digits.empty() ? 1 : std::stoul(digits)});
      i = end;
    }
  }
  return places;
}

OutputKind KindOf(const std::string& path) {
  const bool is_png = fs::path(path).extension() == ".png";
  const std::size_t numbers = FindNumbers(path).size();
  if (!is_png && !render::ClipFormatOf(path)) {
    throw UsageError(
        fmt::format("--out={}: expected a name that ends in .png (a picture, or a sequence if the "
                    "name contains %05d), .mp4, .webm, .webp or .gif (a clip)",
                    path));
  }
  if (numbers > 1) {
    throw UsageError(fmt::format(
        "--out={}: more than one number pattern in the name; expected one, such as %05d", path));
  }
  if (numbers == 1 && !is_png) {
    throw UsageError(
        fmt::format("--out={}: numbered names are supported only for .png; remove the number "
                    "pattern, or write a PNG sequence",
                    path));
  }
  if (!is_png) return OutputKind::kClip;
  return numbers == 1 ? OutputKind::kSequence : OutputKind::kStill;
}

void Replace(std::string& text, const std::string& name, const std::string& value) {
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size()) {
    text.replace(at, name.size(), value);
  }
}

// "demo:lift" and camera names as parts of file names.
std::string AsName(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_fine = std::isalnum(byte) != 0 || c == '-' || c == '_' || c == '.' || byte >= 128;
    name += is_fine ? c : '_';
  }
  return name;
}

void CheckPlace(const std::string& path) {
  std::error_code ignored;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  if (!fs::is_directory(folder, ignored)) {
    throw UsageError(
        fmt::format("--out={}: folder {} does not exist; create it first", path, folder.string()));
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    throw UsageError(
        fmt::format("--out={}: no write permission for folder {}", path, folder.string()));
  }
  if (fs::is_directory(path, ignored)) {
    throw UsageError(
        fmt::format("--out={}: is a folder; name a file in it, such as {}/%05d.png", path, path));
  }
}

// Every name must be needed by only one output; where it is not, what would tell them apart?
void CheckNames(const std::vector<SourcePlan>& plans) {
  std::map<std::string, std::pair<std::string, std::string>> seen;  // path: source, camera
  for (const SourcePlan& plan : plans) {
    for (const Output& output : plan.outputs) {
      const std::string path = fs::path(output.path).lexically_normal();
      const auto [found, is_new] = seen.insert({path, {plan.source, output.camera}});
      if (is_new) continue;
      const auto& [source, camera] = found->second;
      const char* way_out = source != plan.source     ? "add {source} to the name"
                            : camera != output.camera ? "add {camera} to the name"
                                                      : "give each output only once";
      throw UsageError(
          fmt::format("--out={}: two outputs have this name; {}", output.path, way_out));
    }
  }
}

// The record beside an output may replace an older record, but no source and nothing else.
void CheckRecord(const RenderOptions& options, const Output& output) {
  const std::string record = SidecarOf(output.path);
  for (const std::string& source : *options.sources) {
    CheckIsNotSource(source, record, fmt::format("--out={}: its record {}", output.path, record));
  }
  if (*options.force || !fs::exists(record)) return;
  const auto old = ReadSidecar(output.path);
  if (old && old->is_object() && old->contains("pictures")) return;
  throw UsageError(
      fmt::format("--out={}: {} exists and is not a record of pictures; choose another name, or "
                  "give --no_sidecar or --force",
                  output.path, record));
}

void CheckReplaced(const RenderOptions& options, const std::vector<SourcePlan>& plans) {
  for (const SourcePlan& plan : plans) {
    for (const Output& output : plan.outputs) {
      for (const std::string& source : *options.sources) {
        CheckIsNotSource(source, PathOfPicture(output.path, 0), "--out=" + output.path);
      }
      if (!*options.no_sidecar) CheckRecord(options, output);
    }
  }
}

// Options that nothing to be made would heed are mistakes.
void CheckUse(const RenderOptions& options, const std::vector<SourcePlan>& plans) {
  bool has_still = false, has_clip = false, has_crf = false, has_quality = false, has_mp4 = false;
  for (const SourcePlan& plan : plans) {
    for (const Output& output : plan.outputs) {
      (output.kind == OutputKind::kStill ? has_still : has_clip) = true;
      has_crf = has_crf || HasCrf(output.path);
      has_quality = has_quality || HasQuality(output.path);
      has_mp4 = has_mp4 || render::ClipFormatOf(output.path) == render::ClipFormat::kMp4;
    }
  }
  const MomentOptions& moment = options.moment;
  if (options.view.views->has_times() && (has_clip || moment.sample || moment.time)) {
    throw UsageError(fmt::format(
        "--views={}: names the moments of one still picture; {}", options.view.views.ToText(),
        has_clip ? "give --out only names that end in .png, without a number pattern"
                 : "leave out --time and --sample"));
  }
  if (moment.sample && moment.time) {
    throw UsageError("--sample and --time both select the picture; give only one of them");
  }
  if (moment.overlay_layer && !has_still) {
    throw UsageError(
        "--overlay_layer is written beside one picture; give --out a name that ends in .png");
  }
  if (!has_still && (moment.sample || moment.time)) {
    throw UsageError(
        "--sample and --time apply to still pictures only; use --out NAME.png, or select a part of "
        "the clip with --start and --seconds");
  }
  const ClipOptions& clip = options.clip;
  if (!has_clip && (clip.seconds || clip.end || *clip.start != 0)) {
    throw UsageError(
        "--start, --seconds and --end apply to clips and sequences only; use --out with a clip "
        "name (.mp4, .webm, .webp, .gif) or a sequence name (%05d.png), or select a picture with "
        "--time");
  }
  if (!has_crf && options.pack.crf) {
    throw UsageError(fmt::format(
        "--crf={}: applies to .mp4 and .webm only; for .webp use --quality", *options.pack.crf));
  }
  constexpr long kMaxCrfOfMp4 = 51;
  if (has_mp4 && options.pack.crf && *options.pack.crf > kMaxCrfOfMp4) {
    throw UsageError(fmt::format("--crf={}: expected 0 to {} for .mp4; .webm takes up to 63",
                                 *options.pack.crf, kMaxCrfOfMp4));
  }
  if (!has_quality && *options.pack.quality != *PackOptions().quality) {
    throw UsageError(
        fmt::format("--quality={}: applies to .webp only; for .mp4 and .webm use --crf",
                    *options.pack.quality));
  }
}

}  // namespace

std::string NameOfSource(const std::string& source) {
  if (source == "-") return "stdin";
  if (IsSubjectUrl(source)) return AsName(source);
  fs::path stem = fs::path(source).filename();
  for (const char* packed : {".gz", ".xz", ".zst", ".bz2", ".lz4"}) {
    if (stem.extension() == packed) stem = stem.stem();
  }
  return AsName(stem.stem().string());
}

std::string NameOfCamera(const std::string& camera) { return AsName(camera); }

bool AreStills(const std::vector<std::string>& outs) {
  return std::all_of(outs.begin(), outs.end(), [](const std::string& out) {
    return fs::path(out).extension() == ".png" && FindNumbers(out).empty();
  });
}

bool HasCrf(const std::string& path) {
  const auto format = render::ClipFormatOf(path);
  return format == render::ClipFormat::kMp4 || format == render::ClipFormat::kWebm;
}

bool HasQuality(const std::string& path) {
  return render::ClipFormatOf(path) == render::ClipFormat::kWebp;
}

std::string PathOfPicture(const std::string& pattern, long k) {
  const std::vector<NumberPlace> places = FindNumbers(pattern);
  if (places.empty()) return pattern;
  const NumberPlace& place = places.front();
  return pattern.substr(0, place.begin) + fmt::format("{:0{}}", k, place.digits) +
         pattern.substr(place.begin + place.size);
}

std::string LayerPathOf(const RenderOptions& options, const Output& output) {
  const auto& layer = options.moment.overlay_layer;
  if (!layer) return "";
  const bool is_svg = *layer == render::LayerFormat::kSvg;
  return fs::path(output.path).replace_extension(is_svg ? "svg" : "pdf");
}

std::vector<SourcePlan> PlanOutputs(const RenderOptions& options) {
  std::vector<SourcePlan> plans;
  for (const std::string& source : *options.sources) {
    SourcePlan plan{source, {}};
    for (const std::string& out : *options.outs) {
      for (const CameraChoice& camera : *options.view.camera) {
        Output output{out, OutputKind::kStill, camera.text};
        Replace(output.path, "{camera}", NameOfCamera(camera.text));
        Replace(output.path, "{source}", NameOfSource(source));
        output.kind = KindOf(output.path);
        CheckPlace(output.path);
        plan.outputs.push_back(std::move(output));
      }
    }
    plans.push_back(std::move(plan));
  }
  CheckNames(plans);
  CheckReplaced(options, plans);
  CheckUse(options, plans);
  return plans;
}

}  // namespace kinescope::app
