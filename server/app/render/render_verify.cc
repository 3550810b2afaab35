#include "server/app/render/render_verify.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/scratch_folder.h"
#include "core/system/sha256.h"
#include "render/image/compare.h"
#include "render/image/png_file.h"
#include "server/app/print.h"
#include "server/app/render/draw_pools.h"
#include "server/app/render/picture_comparison.h"
#include "server/app/render/provenance.h"
#include "server/app/render/provenance_comparison.h"
#include "server/app/render/provenance_files.h"
#include "server/app/render/render_run.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

// What two versions of an encoder may differ by.
constexpr Tolerance kClipTolerance = {24, 0.001};

std::string BytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Where the source is now. @throws SourceError when it is nowhere or another one.
std::string FindSource(const Json& provenance, const std::string& file,
                       const RenderOptions& given) {
  const Json& source = provenance.at("source");
  std::string name = source.at("name");
  if (IsSubjectUrl(name)) return name;
  if (!source.contains("sha256")) {
    throw SourceError(
        fmt::format("{}: cannot be verified, because it was rendered from {}", file,
                    name == "-" ? "standard input" : name + ", which is not a regular file"));
  }
  const std::vector<std::string> places =
      given.sources->empty() ? std::vector<std::string>{provenance.value("path", name), name,
                                                        fs::path(file).parent_path() / name}
                             : *given.sources;
  std::error_code ignored;
  for (const std::string& path : places) {
    if (!fs::is_regular_file(path, ignored)) continue;
    if (DigestOf(path).sha256 == source.value("sha256", "")) return path;
    throw SourceError(
        fmt::format("{}: source {} does not match; {} differs from the original (SHA-256 {}); give "
                    "the original file",
                    file, name, path, source.value("sha256", "unknown")));
  }
  if (!given.sources->empty()) {
    throw SourceError(fmt::format("source '{}': file not found; give the path of {}",
                                  given.sources->front(), name));
  }
  throw SourceError(
      fmt::format("{}: its source {} was not found; give the path of the source", file, name));
}

Json FindProvenance(const std::string& file) {
  if (auto sidecar = ReadSidecar(file)) return *std::move(sidecar);
  if (auto embedded = ReadEmbedded(file)) return *std::move(embedded);
  std::error_code ignored;
  if (!fs::exists(file, ignored) && PathOfPicture(file, 0) == file) {
    throw UsageError(fmt::format("--verify={}: file not found", file));
  }
  throw UsageError(fmt::format("--verify={}: contains no provenance, and {} does not exist", file,
                               SidecarOf(file)));
}

void NoteDifferences(const Json& then, const Json& now, const std::string& file) {
  const std::string difference = DifferenceOfInputs(then, now);
  if (!difference.empty()) throw SourceError(file + ": " + difference);
  for (const std::string& option : UnknownOptionsOf(then)) {
    spdlog::warn("{}: unknown option --{} in its provenance; it is ignored", file, option);
  }
  for (const char* name : {"kinescope", "renderer"}) {
    if (then.value(name, "") == now.value(name, "")) continue;
    spdlog::warn("{}: rendered with {} {}, compared with {}", file, name, then.value(name, ""),
                 now.value(name, ""));
  }
}

// Becomes part of a file name, so only known words are accepted.
std::string FormatOf(const Json& provenance) {
  std::string format = provenance.value("format", "");
  if (format == "png" || render::ClipFormatOf("a." + format)) return format;
  throw std::runtime_error("unknown format '" + format + "'");
}

// Picture `k` of a clip, which is long enough for that and no longer, unless its length matters.
void DrawOnly(long k, RenderOptions& options, RunSettings& settings) {
  constexpr long kMaxPictures = 100'000'000;  // a day at 1000 a second
  if (k < 0 || k > kMaxPictures)
    throw std::runtime_error(fmt::format("invalid picture number {}", k));
  settings.only_picture = k;
  if (DependsOnWholeClip(options.view)) return;
  const std::int64_t nanos = options.clip.fps->NanosOf(k);
  options.clip.seconds = static_cast<double>(nanos + 1'000) * 1e-9;
}

// `corrections`: why an earlier version drew other pixels.
void PrintVerdict(const std::string& file, const Verdict& verdict,
                  const std::vector<std::string>& corrections, bool as_json) {
  std::string diff;
  if (!verdict.same && verdict.diff.width > 0) {
    diff = file + ".diff.png";
    render::WritePng(diff, verdict.diff);
  }
  if (as_json) {
    nlohmann::json line = {{"file", file}, {"same", verdict.same}};
    if (!verdict.same) {
      line.update({{"picture", verdict.picture}, {"how", verdict.how}, {"diff", diff}});
      if (!corrections.empty()) line["corrected_since"] = corrections;
    }
    Print("{}\n", JsonText(line));
  } else if (verdict.same) {
    Print("{}: same{}\n", file, verdict.same_bytes ? ", byte for byte" : " pictures");
  } else {
    Print("{}: DIFFERS, picture {}: {}{}{}{}\n", file, verdict.picture, verdict.how,
          corrections.empty() ? "" : "; rendered by an earlier version, in which ",
          fmt::join(corrections, ", and "), diff.empty() ? "" : "; see " + diff);
  }
}

int VerifyAgainst(const Json& then, const std::string& file, const RenderOptions& given) {
  const ScratchFolder scratch;
  // Of one picture of a sequence, only that is drawn; the camera has followed all those before.
  const bool is_numbered = then.value("kind", "") == "sequence";
  const bool is_one = is_numbered && then.contains("number");
  const std::string again = scratch / (is_numbered ? "%d.png" : "again." + FormatOf(then));
  RenderOptions options = OptionsOf(then, again);
  options.sources = std::vector<std::string>{FindSource(then, file, given)};
  options.backend = given.backend;
  const std::vector<SourcePlan> plans = PlanOutputs(options);
  RunSettings settings;
  const render::PictureSpec spec = ToPictureSpec(options.view);
  settings.jobs = JobsFor(*given.jobs, spec);
  if (is_one) DrawOnly(then.at("number").get<long>(), options, settings);
  DrawPools pools;
  DrawPool& pool = pools.PoolFor(settings.jobs, spec, options.backend);
  const auto results = RenderSource(options, plans.front(), settings, pool);
  const Provenance now(options, options.sources->front(), pool.info());
  NoteDifferences(then, now.Of(plans.front().outputs.front()), file);

  const bool is_clip = then.value("kind", "") == "clip";
  const std::string drawn = is_one ? PathOfPicture(again, *settings.only_picture) : again;
  Verdict verdict;
  verdict.same_bytes = (is_clip || !is_numbered || is_one) && BytesOf(file) == BytesOf(drawn);
  if (!verdict.same_bytes) {
    const bool same_renderer = then.value("renderer", "") == pool.info().renderer;
    const Tolerance rounding = {same_renderer ? 0 : render::kChannelTolerance, 0};
    verdict = ComparePictures(
        file, drawn, is_clip ? kClipTolerance : rounding,
        is_numbered && !is_one ? std::optional<long>(results.front().pictures) : std::nullopt);
    if (is_one) verdict.picture = *settings.only_picture;
  }
  PrintVerdict(file, verdict, CorrectionsSince(then), *given.json);
  return verdict.same ? 0 : 1;
}

}  // namespace

int Verify(const std::string& file, const RenderOptions& given) {
  const Json then = FindProvenance(file);
  try {
    return VerifyAgainst(then, file, given);
  } catch (const Json::exception& error) {
    throw std::runtime_error(
        fmt::format("{}: its provenance cannot be read: {}", file, error.what()));
  }
}

}  // namespace kinescope::app
