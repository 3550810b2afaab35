#include "server/app/golden/golden_composite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "render/canvas.h"
#include "render/font.h"
#include "render/multi_view.h"

namespace kinescope::app {
namespace {

using render::Image;
using render::Tile;

constexpr int kMargin = 16, kGap = 10, kTitlePx = 20, kTextPx = 14, kLinePx = 21;
constexpr std::size_t kMostCaptionLines = 8;
constexpr double kPartShare = 0.3;  // of a picture's sides
const render::Ink kText{{0.10, 0.13, 0.17}, 1}, kQuiet{{0.36, 0.40, 0.46}, 1},
    kBad{{0.69, 0.14, 0.11}, 1};

// `part` of `from`, whose pixels become as large as fills `to`.
void Enlarge(const Image& from, const Tile& part, const Tile& to, Image& into) {
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const int from_x = part.x + x * part.width / to.width,
                from_y = part.y + y * part.height / to.height;
      const auto at = 4 * (static_cast<std::size_t>(from_y) * static_cast<std::size_t>(from.width) +
                           static_cast<std::size_t>(from_x));
      const auto put =
          4 * (static_cast<std::size_t>(to.y + y) * static_cast<std::size_t>(into.width) +
               static_cast<std::size_t>(to.x + x));
      std::copy_n(&from.rgba[at], 4, &into.rgba[put]);
    }
  }
}

// Of lines that are at most `most_px` wide, where a word is not wider.
std::vector<std::string> Wrapped(const std::vector<std::string>& lines, double most_px,
                                 render::Font& font) {
  std::vector<std::string> wrapped;
  for (const std::string& line : lines) {
    std::string row;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::string longer = row.empty() ? word : row + ' ' + word;
      if (!row.empty() && font.Width(longer, kTextPx) > most_px) {
        wrapped.push_back(row);
        row = "    " + word;
      } else {
        row = longer;
      }
    }
    wrapped.push_back(row);
  }
  return wrapped;
}

}  // namespace

std::optional<Tile> WorstPart(const CaseVerdict& verdict) {
  for (const GoldenFinding& finding : verdict.findings) {
    if (!finding.x_px || !finding.y_px || !verdict.now) continue;
    const int whole_width = verdict.now->width, whole_height = verdict.now->height;
    if (whole_width < 1 || whole_height < 1) return std::nullopt;
    const auto side = [](int whole) {
      return std::max(1, static_cast<int>(std::lround(kPartShare * whole)));
    };
    const int width = side(whole_width), height = side(whole_height);
    const auto first = [](double middle, int length, int whole) {
      const double begin = std::clamp(middle - length / 2.0, 0.0, 1.0 * (whole - length));
      return static_cast<int>(std::lround(begin));
    };
    return Tile{first(*finding.x_px, width, whole_width),
                first(*finding.y_px, height, whole_height), width, height};
  }
  return std::nullopt;
}

Image Composite(const CaseVerdict& verdict, const Image& accepted, const Image& now,
                const Image& difference) {
  const int width = accepted.width, height = accepted.height;
  const int inner_width = 3 * width + 2 * kGap;
  render::Font regular("DejaVuSans.ttf"), bold("DejaVuSans-Bold.ttf");
  std::vector<std::string> lines = Wrapped(Explain(verdict), inner_width, regular);
  if (lines.size() > kMostCaptionLines) {
    lines[kMostCaptionLines - 1] = fmt::format("and {} more", lines.size() - kMostCaptionLines + 1);
    lines.resize(kMostCaptionLines);
  }
  const auto part = WorstPart(verdict);
  const int top = 2 * kMargin + kTitlePx + static_cast<int>(lines.size()) * kLinePx + kLinePx;
  Image image;
  render::SetSize(image, 2 * kMargin + inner_width,
                  top + height + kMargin + (part ? kGap + height : 0));
  render::FillWith(image, {0, 0, image.width, image.height}, {1, 1, 1});
  render::Canvas canvas(image);
  canvas.Text(kMargin, kMargin + kTitlePx,
              fmt::format("{}: {}", verdict.name, Name(verdict.outcome)), bold, kTitlePx, kBad);
  double y = kMargin + kTitlePx + kLinePx;
  for (const std::string& line : lines) {
    canvas.Text(kMargin, y + 4, line, regular, kTextPx, kText);
    y += kLinePx;
  }
  constexpr const char* kCaptions[] = {"accepted", "this run", "difference"};
  const Image* const pictures[] = {&accepted, &now, &difference};
  for (int i = 0; i < 3; ++i) {
    const Tile tile{kMargin + i * (width + kGap), top, width, height};
    canvas.Text(tile.x, top - 6, kCaptions[i], regular, kTextPx, kQuiet);
    render::CopyInto(image, *pictures[i], tile);
    if (part) {
      Enlarge(*pictures[i], *part, {tile.x, top + height + kGap, width, height}, image);
    }
  }
  return image;
}

}  // namespace kinescope::app
