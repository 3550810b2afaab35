#include "tests/render/image/picture_mutations.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "render/canvas.h"
#include "render/font.h"

namespace kinescope::testing {
namespace {

using render::Image;

// What a mutation changes.
struct Furniture {
  std::string label = "1.28 Nm";
  Rgb red_disc = {200 / 255., 80 / 255., 80 / 255.};
  Rgb green_disc = {0, 158 / 255., 115 / 255.};
  double sphere_x = 0;  // px, from where it stands
  bool has_line = true;
};

Image With(const Image& picture, const Furniture& furniture) {
  Image image = picture;
  image.floor = nullptr;
  render::Canvas canvas(image);
  render::Font font("DejaVuSans.ttf");
  const double x = 0.6 * image.width, y = 0.3 * image.height;
  canvas.RoundedBox(x - 8, y - 18, 80, 26, 4, {{1, 1, 1}, 0.9});
  canvas.Text(x, y, furniture.label, font, 13, {{0.1, 0.1, 0.1}, 1});
  canvas.Disc(x, y + 30, 9, {furniture.red_disc, 1});
  canvas.Disc(x + 30, y + 30, 9, {furniture.green_disc, 1});
  constexpr int kRings = 12;
  for (int ring = 0; ring < kRings; ++ring) {
    const double shade = 0.35 + 0.6 * ring / kRings;
    canvas.Disc(x + 70 + furniture.sphere_x, y + 30, 12 - ring, {{shade, 0.6 * shade, 0.1}, 1});
  }
  const double below = y + 50, slope = 20;
  canvas.RoundedBox(x - 8, below, 80, slope + 8, 4, {{1, 1, 1}, 0.9});
  if (furniture.has_line) {
    canvas.Polyline({{x, below + 4}, {x + 60, below + 4 + slope}}, 1, {{0.7, 0.7, 0.7}, 1});
  }
  return image;
}

Image MapChannels(const Image& picture, const std::function<int(int)>& map) {
  Image image = picture;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    image.rgba[i] = static_cast<std::uint8_t>(std::clamp(map(image.rgba[i]), 0, 255));
  }
  return image;
}

// Each pixel is the mean of those up to `radius` px around `dx`, `dy`; the border is repeated.
Image Averaged(const Image& picture, int radius, int dx) {
  Image image = picture;
  const auto at = [&](int x, int y, int channel) {
    const int column = std::clamp(x, 0, picture.width - 1);
    const int row = std::clamp(y, 0, picture.height - 1);
    return picture.rgba[static_cast<std::size_t>(4 * (row * picture.width + column) + channel)];
  };
  const int count = (2 * radius + 1) * (2 * radius + 1);
  std::size_t out = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int channel = 0; channel < 4; ++channel) {
        int sum = count / 2;
        for (int j = -radius; j <= radius; ++j) {
          for (int i = -radius; i <= radius; ++i) sum += at(x - dx + i, y + j, channel);
        }
        image.rgba[out++] = static_cast<std::uint8_t>(sum / count);
      }
    }
  }
  return image;
}

}  // namespace

render::Image Furnished(const render::Image& picture) { return With(picture, {}); }

render::Image Scaled(const render::Image& picture, double factor) {
  return MapChannels(picture,
                     [&](int level) { return static_cast<int>(std::lround(level * factor)); });
}

std::vector<PictureMutation> MutationsOf(const render::Image& picture) {
  const Image base = Furnished(picture);
  Furniture digit, red, green, sphere, line;
  digit.label = "1.26 Nm";
  red.red_disc = {80 / 255., 141 / 255., 80 / 255.};
  green.green_disc = {107 / 255., 107 / 255., 107 / 255.};
  sphere.sphere_x = 3;
  line.has_line = false;
  std::mt19937 random(28);
  std::uniform_int_distribution<int> level(-1, 1);
  return {
      {"one digit of a label", With(picture, digit), "pixels"},
      {"red disc as green of equal grey", With(picture, red), "pixels"},
      {"green disc as equal grey", With(picture, green), "pixels"},
      {"sphere moved by 3 px", With(picture, sphere), "pixels"},
      {"thin grey line hidden", With(picture, line), "structure"},
      {"1 % darker", Scaled(base, 0.99), "light"},
      {"blur of 3 x 3 px", Averaged(base, 1, 0), "structure"},
      {"all moved by 1 px", Averaged(base, 0, 1), "structure"},
      {"each level + 1", MapChannels(base, [](int l) { return l + 1; }), ""},
      {"each level - 1", MapChannels(base, [](int l) { return l - 1; }), ""},
      {"each level + -1, 0 or 1", MapChannels(base, [&](int l) { return l + level(random); }), ""},
      {"each level + -1 or 1",
       MapChannels(base, [&](int l) { return l + (random() % 2 == 0 ? 1 : -1); }), ""},
  };
}

}  // namespace kinescope::testing
