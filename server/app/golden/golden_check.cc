#include "server/app/golden/golden_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/system/sha256.h"
#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "render/image/heat_map.h"
#include "render/image/picture_difference.h"
#include "render/image/png_file.h"
#include "server/app/golden/golden_composite.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// What Git LFS leaves in the place of a file that it has not fetched: the SHA-256 that the file
// has; nullopt: it is another kind of file.
std::optional<std::string> HashInLfsPointer(const fs::path& path) {
  constexpr char kBegin[] = "version https://git-lfs", kHash[] = "\noid sha256:";
  std::string text(256, '\0');
  std::ifstream(path, std::ios::binary).read(text.data(), 256);
  if (!StartsWith(text, kBegin)) return std::nullopt;
  const std::size_t at = text.find(kHash);
  return at == std::string::npos ? "" : text.substr(at + sizeof kHash - 1, 64);
}

class CaseCheck {
 public:
  CaseCheck(const GoldenSuite& suite, const FoundCase& found, const CheckSettings& settings,
            const std::map<std::string, std::string>& environment)
      : suite_(suite), found_(found), settings_(settings), environment_(environment) {
    verdict_.name = found.name;
    verdict_.file = suite.CaseFileOf(found);
    if (found.read) verdict_.why = *found.read->why;
  }

  /// @throws std::runtime_error if a picture cannot be written.
  CaseVerdict Run(render::Renderer& renderer) {
    try {
      if (!found_.read) throw std::runtime_error(found_.error);
      drawing_ = Draw(*found_.read, renderer);
      verdict_.now = Describe(*found_.read, drawing_, environment_);
    } catch (const std::exception& error) {
      return NotCompared((found_.read ? verdict_.file.string() + ": " : "") + error.what());
    }
    const AcceptedCase* const accepted = suite_.AcceptedOf(found_);
    if (accepted == nullptr) {
      WriteDrawing();
      return NotCompared(
          fmt::format("{}: not accepted yet; look at {}, then run `kinescope golden accept {} {}`",
                      verdict_.file.string(), NewPictureOf(settings_.out, found_.name).string(),
                      settings_.out.string(), found_.name));
    }
    Compare(*accepted);
    return std::move(verdict_);
  }

 private:
  CaseVerdict NotCompared(std::string reason) {
    verdict_.outcome = Outcome::kNotCompared;
    verdict_.reason = std::move(reason);
    return std::move(verdict_);
  }

  void Add(FindingKind kind, std::string text) {
    verdict_.findings.push_back({kind, kWholePicture, "", "", 0, std::move(text)});
  }

  void Compare(const AcceptedCase& accepted) {
    const AcceptedCase& now = *verdict_.now;
    verdict_.accepted_pixels = accepted.pixels_sha256;
    verdict_.changes = ChangesBetween(accepted, now);
    verdict_.is_byte_equal = accepted.pixels_sha256 == now.pixels_sha256;
    verdict_.findings = kinescope::app::Compare(accepted.facts, now.facts);
    AddObjectLayer(accepted);
    for (const std::string& change : verdict_.changes.inputs) {
      const std::string text = "input " + change;
      const std::string object = text.substr(0, text.find(':'));  // "input source"
      verdict_.findings.push_back({FindingKind::kInput, object, "", "", 0, text});
    }
    CheckDrawing();
    const std::optional<render::Image> picture = ReadAccepted(accepted);
    if (!verdict_.is_byte_equal) ComparePixels(accepted, picture);
    AddEnvironment();
    SortWorstFirst(verdict_.findings);
    if (verdict_.findings.empty()) return;
    verdict_.line = LineThatExplains();
    verdict_.outcome = Outcome::kDiffers;
    WriteDrawing();
    if (!picture || verdict_.is_byte_equal) return;
    if (difference_.actual_width == 0) {
      difference_ = render::FindDifference(*picture, drawing_.image);
    }
    const render::Image difference = render::HeatMap(*picture, difference_);
    render::WritePng(DifferenceOf(settings_.out, found_.name), difference);
    if (picture->width != now.width || picture->height != now.height) return;
    render::WritePng(CompositeOf(settings_.out, found_.name),
                     Composite(verdict_, *picture, drawing_.image, difference));
  }

  // The key that was changed, or that decides what has changed.
  int LineThatExplains() const {
    const auto line_of = [&](const std::string& key) {
      const auto line = found_.read->lines.find(key);
      return line == found_.read->lines.end() ? 1 : line->second;
    };
    if (!verdict_.changes.options.empty()) {
      const std::string& change = verdict_.changes.options.front();
      return line_of(change.substr(0, change.find(':')));
    }
    switch (verdict_.findings.front().kind) {
      case FindingKind::kCamera: return line_of("camera");
      case FindingKind::kFloor: return line_of("floor");
      case FindingKind::kInput: return line_of("source");
      case FindingKind::kPicture: return line_of("size");
      case FindingKind::kClass:
      case FindingKind::kLoad: return line_of("time");
      default: return 1;
    }
  }

  void AddObjectLayer(const AcceptedCase& accepted) {
    const std::size_t all =
        accepted.facts.objects.size() + accepted.facts.texts.size() + accepted.facts.cameras.size();
    std::size_t changed = verdict_.findings.size();
    verdict_.layers.push_back({"objects",
                               changed == 0
                                   ? fmt::format("all {} the same", all)
                                   : fmt::format("{} among {}", Counted(changed, "change"), all),
                               changed == 0});
  }

  // What the picture itself says against the state that it was drawn from.
  void CheckDrawing() {
    for (std::string& wrong : render::FindSphereMismatches(drawing_.image, drawing_.spheres)) {
      Add(FindingKind::kClass, std::move(wrong));
    }
    if (!drawing_.frame_code || render::ReadFrameCode(drawing_.image) == drawing_.frame_code) {
      return;
    }
    Add(FindingKind::kText,
        fmt::format("frame code: expected sample {}, {} ms", drawing_.frame_code->counter,
                    drawing_.frame_code->time_code_millis));
  }

  // nullopt: it is not there, or not what golden.lock says; then that is noted or found.
  std::optional<render::Image> ReadAccepted(const AcceptedCase& accepted) {
    const fs::path path = suite_.PictureOf(found_);
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
      verdict_.notes.push_back(path.string() + ": not here; compared by golden.lock alone");
      return std::nullopt;
    }
    if (const auto hash = HashInLfsPointer(path)) {
      if (*hash != accepted.file_sha256) {
        Add(FindingKind::kPicture,
            path.string() + ": is a pointer of Git LFS to another picture than golden.lock names");
      }
      verdict_.notes.push_back(path.string() +
                               ": a pointer of Git LFS, compared by golden.lock alone; `git lfs "
                               "pull` fetches the picture");
      return std::nullopt;
    }
    try {
      render::Image image = render::ReadPng(path);
      if (PixelsHash(image) == accepted.pixels_sha256) return image;
      Add(FindingKind::kPicture, path.string() +
                                     ": is not the picture that golden.lock names; restore it, or "
                                     "accept a new one");
      return image;
    } catch (const std::exception& error) {
      Add(FindingKind::kPicture, error.what());
      return std::nullopt;
    }
  }

  void ComparePixels(const AcceptedCase& accepted, const std::optional<render::Image>& picture) {
    const AcceptedCase& now = *verdict_.now;
    if (now.width != accepted.width || now.height != accepted.height) {
      return Add(FindingKind::kPicture,
                 fmt::format("size of the picture: expected {}x{}, found {}x{}", accepted.width,
                             accepted.height, now.width, now.height));
    }
    if (!picture) {
      return Add(FindingKind::kPixels,
                 "pixels differ from those of golden.lock; how many is not known without the "
                 "accepted picture");
    }
    difference_ = render::FindDifference(*picture, drawing_.image);
    for (const render::LayerVerdict& layer : JudgeLayers()) {
      verdict_.layers.push_back({layer.layer, layer.text, layer.passes});
      if (!layer.passes) AddOfLayer(layer);
    }
    if (settings_.is_strict) {
      Add(FindingKind::kPixels, fmt::format("not byte-equal: the largest difference is {} levels",
                                            difference_.levels.largest_difference));
    }
  }

  // In the accepted environment no pixel may differ by more than rounding does; in another one,
  // pictures need only be the same to the eye.
  std::vector<render::LayerVerdict> JudgeLayers() const {
    std::vector<render::LayerVerdict> layers = render::JudgeLayers(difference_);
    const render::Comparison& levels = difference_.levels;
    const bool is_accepted_environment = verdict_.changes.environment.empty();
    layers.erase(std::remove_if(layers.begin(), layers.end(),
                                [](const auto& layer) { return layer.layer == "size"; }),
                 layers.end());
    for (render::LayerVerdict& layer : layers) {
      if (layer.layer != "pixels" || !is_accepted_environment || levels.equal()) continue;
      layer.passes = false;
      layer.text = fmt::format("{}; {} by more than {} levels", layer.text,
                               Counted(static_cast<std::uint64_t>(levels.pixels), "pixel"),
                               render::kChannelTolerance);
    }
    return layers;
  }

  void AddOfLayer(const render::LayerVerdict& layer) {
    const bool is_light = layer.layer == "light", is_structure = layer.layer == "structure";
    GoldenFinding finding{is_light       ? FindingKind::kLight
                          : is_structure ? FindingKind::kStructure
                                         : FindingKind::kPixels,
                          kWholePicture,
                          "",
                          "",
                          0,
                          layer.layer + ": " + layer.text};
    render::Tile place = is_structure ? difference_.structure.worst_block : render::Tile();
    const auto& clusters = difference_.pixels.clusters;
    if (!is_light && !is_structure && !clusters.empty()) place = clusters.front().box;
    if (!render::IsEmpty(place)) {
      finding.x_px = place.x + place.width / 2.0;
      finding.y_px = place.y + place.height / 2.0;
    }
    verdict_.findings.push_back(std::move(finding));
  }

  void AddEnvironment() {
    for (const std::string& change : verdict_.changes.environment) {
      const std::string text = "weaker check, in another environment: " + change;
      verdict_.notes.push_back(text);
      if (settings_.is_strict) Add(FindingKind::kPicture, text);
    }
  }

  void WriteDrawing() {
    fs::create_directories(settings_.out);
    const fs::path path = NewPictureOf(settings_.out, found_.name);
    render::WritePng(path, drawing_.image);
    verdict_.now->file_sha256 = DigestOf(path).sha256;
  }

  const GoldenSuite& suite_;
  const FoundCase& found_;
  const CheckSettings& settings_;
  const std::map<std::string, std::string>& environment_;
  GoldenDrawing drawing_;
  render::PictureDifference difference_;
  CaseVerdict verdict_;
};

void StopIfRequested(std::size_t finished, std::size_t all) {
  if (!StopRequested()) return;
  throw std::runtime_error(fmt::format("interrupted after {} of {} cases", finished, all));
}

CaseVerdict OfNoCase(const std::string& name, const fs::path& file, const std::string& way_out) {
  CaseVerdict verdict;
  verdict.name = name;
  verdict.file = file;
  verdict.outcome = Outcome::kDiffers;
  verdict.findings = {{FindingKind::kPicture, kWholePicture, "", "", 0,
                       "belongs to no case: there is no .yaml of this name; " + way_out}};
  return verdict;
}

}  // namespace

fs::path NewPictureOf(const fs::path& out, const std::string& name) {
  return out / (name + ".actual.png");
}

fs::path CompositeOf(const fs::path& out, const std::string& name) {
  return out / (name + ".compare.png");
}

fs::path DifferenceOf(const fs::path& out, const std::string& name) {
  return out / (name + ".diff.png");
}

AcceptedCase Describe(const GoldenCase& golden_case, const GoldenDrawing& drawing,
                      const std::map<std::string, std::string>& environment) {
  AcceptedCase described;
  described.pixels_sha256 = PixelsHash(drawing.image);
  described.width = drawing.image.width;
  described.height = drawing.image.height;
  described.options = golden_case.given;
  described.inputs = InputsOf(golden_case);
  described.environment = environment;
  described.facts = drawing.facts;
  return described;
}

void CheckSuite(const GoldenSuite& suite, const CheckSettings& settings, render::Renderer& renderer,
                const std::function<void(const CaseVerdict&)>& report) {
  const auto environment = EnvironmentOf(renderer.info());
  std::size_t finished = 0;
  for (const FoundCase& found : suite.cases) {
    StopIfRequested(finished++, suite.cases.size());
    const Clock::time_point begin = Clock::now();
    CaseVerdict verdict = CaseCheck(suite, found, settings, environment).Run(renderer);
    verdict.secs = std::chrono::duration<double>(Clock::now() - begin).count();
    report(verdict);
  }
  for (const fs::path& orphan : suite.orphans) {
    report(OfNoCase(orphan, suite.folder / orphan, "remove it, or write the case"));
  }
  for (const std::string& name : suite.unknown_locks) {
    report(OfNoCase("golden.lock: " + name, suite.lock_file(),
                    "run `kinescope golden update` to remove the entry, or write the case"));
  }
}

}  // namespace kinescope::app
