/// What a golden case allows to differ, always with the reason why: its keys `mask` and
/// `tolerance`. A class of a load is never allowed to differ. Pure; any thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "render/image/picture_difference.h"
#include "server/app/golden/finding.h"
#include "server/options/value.h"

namespace kinescope::app {

/// A part of the picture that may show anything, px.
struct Mask {
  render::Tile box;
  std::string reason;
};

/// "160x40+20+300 the clock of the lab", once per mask: width, height, left and top edge, reason.
class MasksValue : public options::ValueOf<std::vector<Mask>> {
 public:
  MasksValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  void ParseAll(const std::vector<std::string>& texts) override;
  bool is_repeatable() const override { return true; }
  std::vector<std::string> ToTexts() const override;
  std::string ToText() const override;
  std::string Expected() const override;
};

/// The limits of the layers.
struct GoldenLimits {
  double place_px = kPlaceLimitPx;
  render::DifferenceLimits picture;
  std::map<std::string, std::string> reasons;  // of what is not the default, by layer
};

/// "light 2 the other driver rounds so", once per layer: place, pixels, structure or light.
class LimitsValue : public options::ValueOf<GoldenLimits> {
 public:
  LimitsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  void ParseAll(const std::vector<std::string>& texts) override;
  bool is_repeatable() const override { return true; }
  std::vector<std::string> ToTexts() const override { return texts_; }
  std::string ToText() const override;
  std::string Expected() const override;

 private:
  std::vector<std::string> texts_;
};

/// The share of a picture that masks may cover.
inline constexpr double kMostMasked = 0.2;

/// "160x40+20+300".
std::string ToText(const render::Tile& box);

/// @throws std::runtime_error if a mask is not within the picture, or all of them cover more than
/// kMostMasked of it.
void CheckMasks(const std::vector<Mask>& masks, int width, int height);

/// Whether a place of a picture lies under a mask.
bool IsMasked(const std::vector<Mask>& masks, double x_px, double y_px);

/// `to` with the pixels of `from` under the masks. @pre pictures of equal size, checked masks
void CopyMasked(const std::vector<Mask>& masks, const render::Image& from, render::Image& to);

/// How many pixels under a mask differ. @pre as CopyMasked()
std::int64_t DifferentPixels(const Mask& mask, const render::Image& one,
                             const render::Image& other);

/// The picture with nothing under the masks. @pre checked masks
render::Image WithoutMasked(const std::vector<Mask>& masks, render::Image image);

}  // namespace kinescope::app
