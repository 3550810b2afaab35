#include "server/app/render/render_verify.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/errors.h"
#include "core/json_text.h"
#include "core/scratch_folder.h"
#include "core/sha256.h"
#include "render/compare.h"
#include "render/png_file.h"
#include "server/app/render/provenance.h"
#include "server/app/render/render_job.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr int kClipTolerance = 24;         // levels: what two versions of an encoder may differ by
constexpr double kClipMostPixels = 0.001;  // of a picture

struct Verdict {
  bool same = true;
  bool same_bytes = false;
  long picture = 0;  // the first that differs
  std::string how;   // "123 pixels differ ..."
  render::Image diff;
};

// The pictures of a file or of a numbered sequence, one after the other.
class Pictures {
 public:
  explicit Pictures(std::string path) : path_(std::move(path)) {
    if (render::ClipFormatOf(path_)) video_ = render::OpenVideo(path_);
  }

  bool Next(render::Image& image) {
    if (video_ != nullptr) return video_->Next(image);
    const std::string path = PathOfPicture(path_, next_);
    const bool is_single = path == path_;
    if ((is_single && next_ > 0) || !fs::exists(path)) return false;
    image = render::ReadPng(path);
    ++next_;
    return true;
  }

 private:
  const std::string path_;
  std::unique_ptr<render::VideoReader> video_;
  long next_ = 0;
};

std::string BytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// `count`: of a sequence, whose folder may hold more of an older one.
Verdict Compare(const std::string& then, const std::string& now, int tolerance, double most_pixels,
                std::optional<long> count) {
  Verdict verdict;
  Pictures expected(then), actual(now);
  render::Image a, b;
  for (long k = 0; !count || k < *count; ++k) {
    const bool has_a = expected.Next(a), has_b = actual.Next(b);
    if (!has_a && !has_b) break;
    verdict.picture = k;
    if (has_a != has_b) {
      verdict.same = false;
      verdict.how = has_a ? fmt::format("it has more than {} pictures", k)
                          : fmt::format("it has only {} pictures", k);
      return verdict;
    }
    const render::Comparison comparison = render::Compare(a, b, tolerance);
    const auto most = static_cast<std::int64_t>(most_pixels * b.width * b.height);
    if (comparison.same_size && comparison.pixels <= most) continue;
    verdict.same = false;
    verdict.how = render::Describe(comparison, b);
    verdict.diff = render::DiffImage(a, b, tolerance);
    return verdict;
  }
  return verdict;
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

// By option and name. In schema 1 inputs were guessed from the texts of options, so that some were
// missed and some were listed that decide nothing: only those that both list are compared.
void CheckInputs(const Json& then, const Json& now, const std::string& file) {
  const auto inputs = [](const Json& provenance) {
    std::map<std::pair<std::string, std::string>, std::string> hashes;
    for (const Json& input : provenance.value("inputs", Json::array())) {
      hashes[{input.value("option", ""), input.value("name", "")}] = input.value("sha256", "");
    }
    return hashes;
  };
  const auto before = inputs(then), after = inputs(now);
  const bool is_guessed = then.value("schema", 0) < kProvenanceSchema;
  for (const auto& [key, hash] : before) {
    const auto found = after.find(key);
    if (found == after.end() ? is_guessed : found->second == hash) continue;
    throw SourceError(fmt::format(
        "{}: --{} read another {} when it was drawn: SHA-256 {}; {}", file, key.first, key.second,
        hash, found == after.end() ? "the file is missing now" : "now it is " + found->second));
  }
  for (const auto& [key, hash] : after) {
    if (is_guessed || before.count(key) > 0) continue;
    throw SourceError(fmt::format("{}: --{} reads {} now, which it did not when it was drawn", file,
                                  key.first, key.second));
  }
}

void NoteDifferences(const Json& then, const Json& now, const std::string& file) {
  CheckInputs(then, now, file);
  for (const char* name : {"kinescope", "renderer"}) {
    if (then.value(name, "") == now.value(name, "")) continue;
    spdlog::warn("{}: rendered with {} {}, compared with {}", file, name, then.value(name, ""),
                 now.value(name, ""));
  }
}

// Part of a file name, so nobody else's word is taken for it.
std::string FormatOf(const Json& provenance) {
  std::string format = provenance.value("format", "");
  if (format == "png" || render::ClipFormatOf("a." + format)) return format;
  throw std::runtime_error("unknown format '" + format + "'");
}

// Picture `k` of a clip, which is long enough for that and no longer.
void DrawOnly(long k, RenderOptions& options, JobSettings& settings) {
  constexpr long kMostPictures = 100'000'000;  // a day at 1000 a second
  if (k < 0 || k > kMostPictures)
    throw std::runtime_error(fmt::format("invalid picture number {}", k));
  const std::int64_t nanos = options.clip.fps->NanosOf(k);
  options.clip.seconds = static_cast<double>(nanos + 1'000) * 1e-9;
  settings.only_picture = k;
}

void Tell(const std::string& file, const Verdict& verdict, bool as_json) {
  std::string diff;
  if (!verdict.same && verdict.diff.width > 0) {
    diff = file + ".diff.png";
    render::WritePng(diff, verdict.diff);
  }
  if (as_json) {
    nlohmann::json line = {{"file", file}, {"same", verdict.same}};
    if (!verdict.same) {
      line.update({{"picture", verdict.picture}, {"how", verdict.how}, {"diff", diff}});
    }
    fmt::print("{}\n", JsonText(line));
  } else if (verdict.same) {
    fmt::print("{}: same{}\n", file, verdict.same_bytes ? ", byte for byte" : " pictures");
  } else {
    fmt::print("{}: DIFFERS, picture {}: {}{}\n", file, verdict.picture, verdict.how,
               diff.empty() ? "" : "; see " + diff);
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
  JobSettings settings;
  settings.jobs = *given.jobs > 0 ? static_cast<int>(*given.jobs) : DefaultJobs();
  if (is_one) DrawOnly(then.at("number").get<long>(), options, settings);
  const auto pool = MakeDrawPool(settings.jobs, ToView(options.view), options.backend);
  const auto results = RenderSource(options, plans.front(), settings, *pool);
  const Provenance now(options, options.sources->front(), pool->info());
  NoteDifferences(then, now.Of(plans.front().outputs.front()), file);

  const bool is_clip = then.value("kind", "") == "clip";
  const std::string drawn = is_one ? PathOfPicture(again, *settings.only_picture) : again;
  Verdict verdict;
  verdict.same_bytes = (is_clip || !is_numbered || is_one) && BytesOf(file) == BytesOf(drawn);
  if (!verdict.same_bytes) {
    const bool same_renderer = then.value("renderer", "") == pool->info().renderer;
    const int tolerance = is_clip ? kClipTolerance : same_renderer ? 0 : render::kChannelTolerance;
    verdict = Compare(
        file, drawn, tolerance, is_clip ? kClipMostPixels : 0,
        is_numbered && !is_one ? std::optional<long>(results.front().pictures) : std::nullopt);
    if (is_one) verdict.picture = *settings.only_picture;
  }
  Tell(file, verdict, *given.json);
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
