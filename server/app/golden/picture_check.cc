#include "server/app/golden/picture_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/system/sha256.h"
#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "render/image/heat_map.h"
#include "render/image/picture_difference.h"
#include "render/image/png_file.h"
#include "server/app/golden/golden_compare.h"
#include "server/app/golden/golden_composite.h"
#include "server/app/shell_word.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

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

std::vector<Mask> MasksOf(const GoldenCase& golden_case, const GoldenDrawing& drawing) {
  std::vector<Mask> masks = *golden_case.masks;
  masks.insert(masks.end(), drawing.masks.begin(), drawing.masks.end());
  return masks;
}

bool ShowsNothing(const render::Image& image) {
  const std::uint8_t* const first = image.rgba.data();
  for (std::size_t at = 0; at < image.rgba.size(); at += 4) {
    if (std::memcmp(first, first + at, 4) != 0) return false;
  }
  return true;
}

// All that golden.lock keeps of a drawing, but for the hash of its file.
AcceptedCase DescriptionOf(const GoldenCase& golden_case, const GoldenDrawing& drawing,
                           const std::map<std::string, std::string>& environment) {
  AcceptedCase described;
  described.pixels_sha256 = PixelsHash(drawing.image);
  const std::vector<Mask> masks = MasksOf(golden_case, drawing);
  if (!masks.empty()) {
    described.unmasked_sha256 = PixelsHash(WithoutMasked(masks, drawing.image));
  }
  described.width = drawing.image.width;
  described.height = drawing.image.height;
  described.options = golden_case.given;
  described.inputs = InputsOf(golden_case);
  described.environment = drawing.environment.empty() ? environment : drawing.environment;
  described.facts = drawing.facts;
  return described;
}

// Of one picture.
class PictureCheck {
 public:
  PictureCheck(const GoldenSuite& suite, const FoundCase& found, const CheckSettings& settings,
               const std::map<std::string, std::string>& environment, GoldenDrawing drawing)
      : suite_(suite),
        found_(found),
        settings_(settings),
        drawing_(std::move(drawing)),
        masks_(MasksOf(*found.read, drawing_)),
        verdict_(VerdictOf(suite, found, drawing_.frame)) {
    for (const Mask& mask : drawing_.masks) verdict_.masks.push_back(mask.box);
    verdict_.now = DescriptionOf(*found.read, drawing_, environment);
  }

  /// @throws std::runtime_error if a picture cannot be written.
  CaseVerdict Run() {
    if (settings_.keeps_all) WriteDrawing();
    CheckDrawing();
    const AcceptedCase* const accepted = suite_.AcceptedOf(verdict_.name);
    if (accepted == nullptr) {
      WriteDrawing();
      return NotCompared(
          fmt::format("{}: not accepted yet; look at {}, then run `kinescope golden accept {} {}`",
                      verdict_.file.string(), NewPictureOf(settings_.out, verdict_.name).string(),
                      ShellWord(settings_.out.string()), ShellWord(verdict_.name)));
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
    if (accepted.environment.empty()) {
      Add(FindingKind::kPicture,
          "golden.lock does not say in which environment the picture was drawn, so nothing can be "
          "compared with it; look at the picture and accept it again");
    }
    const std::size_t faults = verdict_.findings.size();
    CompareFacts(accepted.facts, now.facts);
    AddObjectLayer(accepted, verdict_.findings.size() - faults);
    for (const std::string& change : verdict_.changes.inputs) {
      const std::string text = "input " + change;
      const std::string object = text.substr(0, text.find(':'));  // "input source"
      verdict_.findings.push_back({FindingKind::kInput, object, "", "", 0, text});
    }
    const std::optional<render::Image> picture = ReadAccepted(accepted);
    if (!verdict_.is_byte_equal) ComparePixels(accepted, picture);
    AddEnvironment(accepted);
    SortWorstFirst(verdict_.findings);
    if (verdict_.findings.empty()) return;
    verdict_.line = LineThatExplains();
    verdict_.outcome = Outcome::kDiffers;
    WriteDrawing();
    if (!picture || verdict_.is_byte_equal) return;
    if (difference_.actual_width == 0) {  // another size
      difference_ = render::FindDifference(*picture, drawing_.image);
    }
    const render::Image difference = render::HeatMap(*picture, difference_);
    render::WritePng(DifferenceOf(settings_.out, verdict_.name), difference);
    if (picture->width != now.width || picture->height != now.height) return;
    render::WritePng(CompositeOf(settings_.out, verdict_.name),
                     Composite(verdict_, *picture, drawing_.image, difference));
  }

  // A mask hides what lies under it, but never a load: its class is what people look for.
  void CompareFacts(const PictureFacts& expected, const PictureFacts& actual) {
    const GoldenCase& read = *found_.read;
    const auto is_hidden = [&](const GoldenFinding& finding) {
      return finding.kind != FindingKind::kClass && finding.kind != FindingKind::kLoad &&
             finding.x_px && IsMasked(masks_, *finding.x_px, *finding.y_px);
    };
    const auto outside_masks = [&](std::vector<GoldenFinding> findings) {
      findings.erase(std::remove_if(findings.begin(), findings.end(), is_hidden), findings.end());
      return findings;
    };
    const auto findings =
        outside_masks(kinescope::app::Compare(expected, actual, read.limits->place_px));
    if (findings.empty() && read.limits->reasons.count("place") > 0 &&
        !outside_masks(kinescope::app::Compare(expected, actual)).empty()) {
      NoteTolerance("place");
    }
    verdict_.findings.insert(verdict_.findings.end(), findings.begin(), findings.end());
  }

  void NoteTolerance(const std::string& layer) {
    verdict_.notes.push_back(fmt::format("{}: passes by the tolerance of the case ({})", layer,
                                         found_.read->limits->reasons.at(layer)));
  }

  // The key that was changed, or that decides what has changed.
  int LineThatExplains() const {
    const auto line_of = [&](const std::string& key) { return LineOf(found_, key); };
    if (!verdict_.changes.options.empty()) {
      const std::string& change = verdict_.changes.options.front();
      return line_of(change.substr(0, change.find(':')));
    }
    switch (verdict_.findings.front().kind) {
      case FindingKind::kCamera: return line_of("camera");
      case FindingKind::kFloor: return line_of("floor");
      case FindingKind::kInput: {  // of "input source"
        const std::string& object = verdict_.findings.front().object;
        return line_of(object.substr(object.find(' ') + 1));
      }
      case FindingKind::kFault:
      case FindingKind::kClass:
      case FindingKind::kLoad: return line_of("time");
      default: return 1;
    }
  }

  void AddObjectLayer(const AcceptedCase& accepted, std::size_t changed) {
    const std::size_t all = accepted.facts.objects.size() + accepted.facts.joints.size() +
                            accepted.facts.texts.size() + accepted.facts.cameras.size();
    verdict_.layers.push_back({"objects",
                               changed == 0
                                   ? fmt::format("all {} the same", all)
                                   : fmt::format("{} among {}", Counted(changed, "change"), all),
                               changed == 0,
                               {{"changes", changed}, {"compared", all}}});
  }

  // What the picture itself says against the state that it was drawn from.
  void CheckDrawing() {
    if (ShowsNothing(drawing_.image)) {
      Add(FindingKind::kFault, "shows nothing: all pixels have one colour");
    } else if (verdict_.now->facts.objects.empty() && verdict_.now->facts.texts.empty()) {
      Add(FindingKind::kFault, "shows no object and no text; check camera and time");
    }
    for (std::string& wrong : render::FindSphereMismatches(drawing_.image, drawing_.spheres)) {
      Add(FindingKind::kFault, std::move(wrong));
    }
    if (!drawing_.frame_code || render::ReadFrameCode(drawing_.image) == drawing_.frame_code) {
      return;
    }
    Add(FindingKind::kFault,
        fmt::format("frame code: expected sample {}, {} ms", drawing_.frame_code->counter,
                    drawing_.frame_code->time_code_millis));
  }

  // nullopt: it is not there, or not what golden.lock says; then that is noted or found.
  std::optional<render::Image> ReadAccepted(const AcceptedCase& accepted) {
    const fs::path path = suite_.PictureOf(verdict_.name);
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
      Add(FindingKind::kPicture,
          fmt::format("{}: the accepted picture cannot be read; {}", error.what(),
                      verdict_.is_byte_equal
                          ? "what was drawn is what golden.lock names, so restore the file from "
                            "version control, or run `kinescope golden update`"
                          : "restore the file from version control, and check again"));
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
    const bool is_under_masks =
        !now.unmasked_sha256.empty() && now.unmasked_sha256 == accepted.unmasked_sha256;
    if (!picture && is_under_masks && !settings_.is_strict) {
      verdict_.notes.push_back("pixels differ under the masks alone");
      return;
    }
    if (!picture) {
      return Add(FindingKind::kPixels,
                 "pixels differ from those of golden.lock; how many is not known without the "
                 "accepted picture");
    }
    FindDifferenceFrom(*picture);
    for (const render::LayerVerdict& layer : JudgeLayers(found_.read->limits->picture)) {
      verdict_.layers.push_back(
          {layer.layer, layer.text, layer.passes, NumbersOf(layer.layer, difference_)});
      if (!layer.passes) AddOfLayer(layer);
    }
    NoteTolerances();
    if (settings_.is_strict) {
      const int levels = difference_.levels.largest_difference;
      Add(FindingKind::kPixels, fmt::format("not byte-equal: the largest difference is {}",
                                            Counted(static_cast<std::uint64_t>(levels), "level")));
    }
  }

  // In the accepted environment no pixel may differ by more than rounding does; in another one,
  // pictures need only be the same to the eye.
  std::vector<render::LayerVerdict> JudgeLayers(const render::DifferenceLimits& limits) const {
    render::PictureDifference judged = difference_;
    judged.limits = limits;
    std::vector<render::LayerVerdict> layers = render::JudgeLayers(judged);
    const render::Comparison& levels = difference_.levels;
    const bool is_accepted_environment = verdict_.changes.environment.empty();
    layers.erase(std::remove_if(layers.begin(), layers.end(),
                                [](const auto& layer) { return layer.layer == "size"; }),
                 layers.end());
    for (render::LayerVerdict& layer : layers) {
      const bool is_within = levels.pixels <= limits.changed_pixels;
      if (layer.layer != "pixels" || !is_accepted_environment || is_within) continue;
      layer.passes = false;
      layer.text = fmt::format("{} by more than {} levels, {}", levels.pixels,
                               render::kChannelTolerance, layer.text);
    }
    return layers;
  }

  void FindDifferenceFrom(const render::Image& picture) {
    render::Image unmasked = drawing_.image;
    CopyMasked(masks_, picture, unmasked);
    difference_ = render::FindDifference(picture, unmasked, found_.read->limits->picture);
    for (const Mask& mask : masks_) {
      const std::int64_t hidden = DifferentPixels(mask, picture, drawing_.image);
      if (hidden == 0) continue;
      verdict_.notes.push_back(fmt::format("mask {} hides {} that {} ({})", ToText(mask.box),
                                           Counted(static_cast<std::uint64_t>(hidden), "pixel"),
                                           hidden == 1 ? "differs" : "differ", mask.reason));
    }
  }

  // Of the layers that pass, but would not by the limits of other cases.
  void NoteTolerances() {
    for (const render::LayerVerdict& layer : JudgeLayers({})) {
      const auto judged = std::find_if(verdict_.layers.begin(), verdict_.layers.end(),
                                       [&](const auto& each) { return each.name == layer.layer; });
      if (!layer.passes && judged != verdict_.layers.end() && judged->passes) {
        NoteTolerance(layer.layer);
      }
    }
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
    if (!is_light && !is_structure && !clusters.empty()) {
      place = clusters.front().box;
      const bool is_nearly_all = 2LL * place.width * place.height >
                                 1LL * difference_.actual_width * difference_.actual_height;
      const auto names =
          is_nearly_all ? std::vector<std::string>() : ObjectsIn(place, drawing_.places);
      if (!names.empty()) finding.text += fmt::format(", in it {}", fmt::join(names, ", "));
    }
    if (!render::IsEmpty(place)) {
      finding.x_px = place.x + place.width / 2.0;
      finding.y_px = place.y + place.height / 2.0;
    }
    verdict_.findings.push_back(std::move(finding));
  }

  void AddEnvironment(const AcceptedCase& accepted) {
    if (accepted.environment.empty()) return;
    for (const std::string& change : verdict_.changes.environment) {
      const std::string text = "weaker check, in another environment: " + change;
      if (settings_.is_strict) {
        Add(FindingKind::kPicture, text + " (--strict accepts none)");
      } else {
        verdict_.notes.push_back(text);
      }
    }
  }

  void WriteDrawing() {
    if (!verdict_.now->file_sha256.empty()) return;  // it is written
    fs::create_directories(settings_.out);
    const fs::path path = NewPictureOf(settings_.out, verdict_.name);
    render::WritePng(path, drawing_.image);
    verdict_.now->file_sha256 = DigestOf(path).sha256;
  }

  const GoldenSuite& suite_;
  const FoundCase& found_;
  const CheckSettings& settings_;
  const GoldenDrawing drawing_;
  const std::vector<Mask> masks_;
  render::PictureDifference difference_;
  CaseVerdict verdict_;
};

}  // namespace

CaseVerdict VerdictOf(const GoldenSuite& suite, const FoundCase& found,
                      const std::optional<GoldenFrame>& frame) {
  CaseVerdict verdict;
  verdict.name = PictureName(found.name, frame);
  verdict.frame = frame;
  verdict.file = suite.CaseFileOf(found);
  if (!found.read) return verdict;
  verdict.why = *found.read->why;
  for (const Mask& mask : *found.read->masks) verdict.masks.push_back(mask.box);
  return verdict;
}

int LineOf(const FoundCase& found, const std::string& key) {
  if (!found.read) return 1;
  const auto line = found.read->lines.find(key);
  return line == found.read->lines.end() ? 1 : line->second;
}

void CheckMasksOf(const FoundCase& found, const GoldenDrawing& drawing) {
  CheckMasks(MasksOf(*found.read, drawing), drawing.image.width, drawing.image.height);
}

CaseVerdict CheckPicture(const GoldenSuite& suite, const FoundCase& found,
                         const CheckSettings& settings,
                         const std::map<std::string, std::string>& environment,
                         GoldenDrawing drawing) {
  return PictureCheck(suite, found, settings, environment, std::move(drawing)).Run();
}

}  // namespace kinescope::app
