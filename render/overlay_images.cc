#include "render/overlay_images.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"
#include "core/system/utf8.h"
#include "render/image/camera_picture.h"

namespace kinescope::render {
namespace {

constexpr double kWidest = 0.22, kHighest = 0.3;            // of the picture
constexpr double kTopmost = 0.1, kTopmostBelowPlot = 0.55;  // of its height
constexpr double kLeastImageHeight = 24;                    // px

// "": new, or not known.
std::string AgeOf(const CameraImage& image, const SceneState& state) {
  if (!IsOld(image, state.made_nanos)) return "";
  return std::to_string((state.made_nanos - image.received_nanos) / kNanosPerSecond) + " s old";
}

// In the middle of its place.
void PaintPixels(OverlayPage& page, const ImagePlace& at, const CameraImage& image,
                 const Image& pixels, const OverlayImages::DrawScene& draw_scene) {
  const auto paint = [&](const Image& all) {
    page.canvas.Picture(at.left + (at.width - all.width) / 2, at.top + (at.height - all.height) / 2,
                        all);
  };
  if (!image.camera || draw_scene == nullptr || pixels.rgba.empty()) return paint(pixels);
  Image with_scene = pixels;
  draw_scene(*image.camera, with_scene);
  paint(with_scene);
}

}  // namespace

std::vector<ImagePlace> PlacesOfImages(const OverlaySizes& sizes,
                                       const std::vector<ImageSize>& images, bool has_plot) {
  std::vector<ImagePlace> places;
  if (sizes.is_small || images.empty()) return places;
  const double margin = sizes.Px(kMargin), gap = 0.5 * margin;
  double bottom =
      sizes.bottom - margin - sizes.Px(kTimeCodeLine) - 1.3 * sizes.FontPx(kTitleSize) - gap;
  const double top = (has_plot ? kTopmostBelowPlot : kTopmost) * sizes.height;
  const double share = (bottom - top) / static_cast<double>(images.size()) - gap;
  if (share < kLeastImageHeight) return places;
  for (const ImageSize& image : images) {
    const double highest = image.share > 0 ? share : kHighest * sizes.height;
    const double widest = image.share > 0 ? std::min(image.share * sizes.width, sizes.right())
                                          : kWidest * sizes.width;
    const double height = std::min({share, highest, widest / image.proportion});
    ImagePlace place;
    place.width = std::max(1, static_cast<int>(std::lround(height * image.proportion)));
    place.height = std::max(1, static_cast<int>(std::lround(height)));
    place.left = static_cast<int>(std::lround(sizes.right())) - place.width;
    place.top = static_cast<int>(std::lround(bottom)) - place.height;
    places.push_back(place);
    bottom -= place.height + gap;
  }
  return places;
}

const OverlayImages::Decoded& OverlayImages::Decode(std::size_t i,
                                                    const std::shared_ptr<const CameraImage>& image,
                                                    int width, int height) {
  if (decoded_.size() <= i) decoded_.resize(i + 1);
  Decoded& known = decoded_[i];
  // Its camera may have moved: the pixels are the same.
  const bool is_same = known.of != nullptr && known.of->bytes == image->bytes;
  if (is_same && known.width == width && known.height == height) return known;
  known = {image, width, height, {}, ""};
  auto pixels = DecodeCameraImage(*image, width, height);
  if (pixels) {
    known.pixels = *std::move(pixels);
  } else {
    known.problem = pixels.error();
  }
  return known;
}

void OverlayImages::Paint(OverlayPage& page, const SceneState& state, bool has_plot,
                          const DrawScene& draw_scene) {
  const std::vector<ImagePlace> places = PlacesOfImages(page, ImageSizesOf(state), has_plot);
  decoded_.resize(std::min(decoded_.size(), places.size()));
  Font& font = page.fonts.regular;
  const int size = page.FontPx(kSmallSize);
  const double rim = std::max(1.0, page.Px(1.5));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ImagePlace& at = places[i];
    const CameraImage& image = *state.images[i];
    const Decoded& decoded = Decode(i, state.images[i], at.width, at.height);
    page.canvas.RoundedBox(at.left - rim, at.top - rim, at.width + 2 * rim, at.height + 2 * rim,
                           rim, page.inks.separator);
    page.canvas.RoundedBox(at.left, at.top, at.width, at.height, 0, page.inks.notice);
    PaintPixels(page, at, image, decoded.pixels, draw_scene);
    const std::string age = AgeOf(image, state);
    const std::string name = PrintableLine(image.name);
    const std::string text = Shorten(!decoded.problem.empty() ? name + ": " + decoded.problem
                                     : age.empty()            ? name
                                                              : age + " – " + name,
                                     font, size, at.width - 1.2 * size);
    if (text.empty()) continue;
    const bool warns = !age.empty() || !decoded.problem.empty();
    page.canvas.RoundedBox(at.left, at.top + at.height - 1.6 * size,
                           font.Width(text, size) + 1.2 * size, 1.6 * size, 0.3 * size,
                           warns ? page.inks.banner : page.inks.panel);
    page.canvas.Text(at.left + 0.6 * size, at.top + at.height - 0.48 * size, text, font, size,
                     warns ? page.inks.on_banner : page.inks.text);
  }
}

}  // namespace kinescope::render
