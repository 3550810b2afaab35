#include "server/app/golden/golden_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/picture_limits.h"
#include "core/system/words.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostMasks = 64, kMostReason = 300;

// With semicolons between them, as in every option that may be given several times.
std::vector<std::string> EntriesOf(const std::string& text) {
  options::Texts texts;
  texts.Parse(text);
  return *texts;
}

// The first word, and the rest without blanks around it.
std::pair<std::string, std::string> SplitAtBlank(const std::string& text) {
  constexpr char kBlanks[] = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return {};
  const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
  const std::size_t rest = text.find_first_not_of(kBlanks, end);
  const std::size_t last = text.find_last_not_of(kBlanks);
  return {text.substr(begin, end - begin),
          rest == std::string::npos ? "" : text.substr(rest, last + 1 - rest)};
}

std::string CheckedReason(const std::string& entry, const std::string& reason) {
  if (reason.empty()) {
    throw options::BadValue(fmt::format("'{}' has no reason; write it after the value", entry));
  }
  if (reason.size() > kMostReason) {
    throw options::BadValue(
        fmt::format("the reason of '{:.40}…' has more than {} bytes", entry, kMostReason));
  }
  return reason;
}

// "160x40+20+300".
std::optional<render::Tile> BoxFrom(std::string_view text) {
  std::array<long, 4> numbers{};
  constexpr std::array<char, 4> kEnds = {'x', '+', '+', '\0'};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t end = kEnds[i] == '\0' ? text.size() : text.find(kEnds[i]);
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = options::ParseWhole(text.substr(0, end));
    if (!number || *number < 0 || *number > kMaxPictureSide) return std::nullopt;
    numbers[i] = *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const render::Tile box = {static_cast<int>(numbers[2]), static_cast<int>(numbers[3]),
                            static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
  if (render::IsEmpty(box)) return std::nullopt;
  return box;
}

// A layer, and the limits that may be set for it: beyond them it would find nothing.
struct Layer {
  std::string name, unit;
  double least, most;
  bool is_whole;
  std::function<void(GoldenLimits&, double)> set;
};

const std::vector<Layer>& Layers() {
  static const std::vector<Layer> kLayers = {
      {"place", " px", 0, 20, false, [](GoldenLimits& limits, double n) { limits.place_px = n; }},
      {"pixels", " changed pixels", 0, 100'000, true,
       [](GoldenLimits& limits, double n) {
         limits.picture.changed_pixels = static_cast<std::int64_t>(n);
       }},
      {"structure", " of SSIM", 0.5, 1, false,
       [](GoldenLimits& limits, double n) { limits.picture.structure = n; }},
      {"light", " levels", 0, 10, false,
       [](GoldenLimits& limits, double n) { limits.picture.light = n; }}};
  return kLayers;
}

const Layer& LayerNamed(const std::string& name) {
  std::vector<std::string> names;
  for (const Layer& layer : Layers()) {
    if (layer.name == name) return layer;
    names.push_back(layer.name);
  }
  options::RefuseWord(name, names);
}

template <class DoWithRow>
void ForRows(const render::Tile& box, int width, DoWithRow do_with_row) {
  for (int y = box.y; y < box.y + box.height; ++y) {
    do_with_row(4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(box.x)),
                4 * static_cast<std::size_t>(box.width));
  }
}

}  // namespace

void MasksValue::Parse(const std::string& text) { ParseAll(EntriesOf(text)); }

void MasksValue::ParseAll(const std::vector<std::string>& texts) {
  if (texts.size() > kMostMasks) {
    throw options::BadValue(fmt::format("expected at most {} masks", kMostMasks));
  }
  std::vector<Mask> masks;
  for (const std::string& text : texts) {
    const auto [word, reason] = SplitAtBlank(text);
    const auto box = BoxFrom(word);
    if (!box) RefuseText();
    masks.push_back({*box, CheckedReason(word, reason)});
  }
  value_ = std::move(masks);
}

std::vector<std::string> MasksValue::ToTexts() const {
  std::vector<std::string> texts;
  for (const Mask& mask : value_) texts.push_back(app::ToText(mask.box) + " " + mask.reason);
  return texts;
}

std::string MasksValue::ToText() const { return fmt::format("{}", fmt::join(ToTexts(), ";")); }

std::string MasksValue::Expected() const {
  return "WIDTHxHEIGHT+LEFT+TOP REASON (px), such as 160x40+20+300 the clock of the lab";
}

void LimitsValue::Parse(const std::string& text) { ParseAll(EntriesOf(text)); }

void LimitsValue::ParseAll(const std::vector<std::string>& texts) {
  GoldenLimits limits;
  for (const std::string& text : texts) {
    const auto [name, rest] = SplitAtBlank(text);
    const auto [word, reason] = SplitAtBlank(rest);
    const Layer& layer = LayerNamed(name);
    const auto number = options::ParseNumber(word);
    const bool is_good = number && *number >= layer.least && *number <= layer.most &&
                         (!layer.is_whole || *number == std::floor(*number));
    if (!is_good) {
      throw options::BadValue(fmt::format("{}: expected a number from {} to {}{}", layer.name,
                                          layer.least, layer.most, layer.unit));
    }
    layer.set(limits, *number);
    if (!limits.reasons.emplace(name, CheckedReason(name + " " + word, reason)).second) {
      throw options::BadValue(layer.name + " is given twice");
    }
  }
  value_ = std::move(limits);
  texts_ = texts;
}

std::string LimitsValue::ToText() const { return fmt::format("{}", fmt::join(texts_, ";")); }

std::string LimitsValue::Expected() const {
  return "LAYER LIMIT REASON, with the layer place (px), pixels, structure (SSIM) or light "
         "(levels), such as light 2 the new driver rounds otherwise";
}

std::string ToText(const render::Tile& box) {
  return fmt::format("{}x{}+{}+{}", box.width, box.height, box.x, box.y);
}

void CheckMasks(const std::vector<Mask>& masks, int width, int height) {
  std::vector<bool> covered(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const Mask& mask : masks) {
    const render::Tile& box = mask.box;
    if (box.x + box.width > width || box.y + box.height > height) {
      throw std::runtime_error(
          fmt::format("mask {}: is not within the picture of {}x{}", ToText(box), width, height));
    }
    ForRows(box, width, [&](std::size_t begin, std::size_t bytes) {
      const auto from = covered.begin() + static_cast<std::ptrdiff_t>(begin / 4);
      std::fill(from, from + static_cast<std::ptrdiff_t>(bytes / 4), true);
    });
  }
  const auto hidden = static_cast<double>(std::count(covered.begin(), covered.end(), true));
  const double share = hidden / static_cast<double>(covered.size());
  if (share <= kMostMasked) return;
  throw std::runtime_error(
      fmt::format("mask: {:.1f} % of the picture is masked; at most {:.0f} % may be, or the case "
                  "proves too little",
                  100 * share, 100 * kMostMasked));
}

bool IsMasked(const std::vector<Mask>& masks, double x_px, double y_px) {
  return std::any_of(masks.begin(), masks.end(), [&](const Mask& mask) {
    const render::Tile& box = mask.box;
    return x_px >= box.x && x_px < box.x + box.width && y_px >= box.y && y_px < box.y + box.height;
  });
}

void CopyMasked(const std::vector<Mask>& masks, const render::Image& from, render::Image& to) {
  for (const Mask& mask : masks) {
    ForRows(mask.box, to.width, [&](std::size_t begin, std::size_t bytes) {
      std::memcpy(to.rgba.data() + begin, from.rgba.data() + begin, bytes);
    });
  }
}

std::int64_t DifferentPixels(const Mask& mask, const render::Image& one,
                             const render::Image& other) {
  std::int64_t count = 0;
  ForRows(mask.box, one.width, [&](std::size_t begin, std::size_t bytes) {
    for (std::size_t at = begin; at < begin + bytes; at += 4) {
      count += std::memcmp(&one.rgba[at], &other.rgba[at], 4) == 0 ? 0 : 1;
    }
  });
  return count;
}

render::Image WithoutMasked(const std::vector<Mask>& masks, render::Image image) {
  for (const Mask& mask : masks) {
    ForRows(mask.box, image.width, [&](std::size_t begin, std::size_t bytes) {
      std::memset(image.rgba.data() + begin, 0, bytes);
    });
  }
  return image;
}

}  // namespace kinescope::app
