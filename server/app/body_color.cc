#include "server/app/body_color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinescope::app {
namespace {

// CIE L*a*b*, D65.
struct Lab {
  double l, a, b;
  double chroma() const { return std::hypot(a, b); }
};

constexpr std::array<double, 3> kWhite = {0.95047, 1.0, 1.08883};  // D65, as X Y Z
constexpr double kEpsilon = 216.0 / 24389;
constexpr double kKappa = 24389.0 / 27;

double Linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
double Encoded(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

Lab ToLab(const Rgb& rgb) {
  const double r = Linear(rgb[0]);
  const double g = Linear(rgb[1]);
  const double b = Linear(rgb[2]);
  const std::array<double, 3> xyz = {0.4124564 * r + 0.3575761 * g + 0.1804375 * b,
                                     0.2126729 * r + 0.7151522 * g + 0.0721750 * b,
                                     0.0193339 * r + 0.1191920 * g + 0.9503041 * b};
  std::array<double, 3> f{};
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double t = xyz[i] / kWhite[i];
    f[i] = t > kEpsilon ? std::cbrt(t) : (kKappa * t + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

Rgb ToRgb(const Lab& lab) {
  const double fy = (lab.l + 16) / 116;
  const std::array<double, 3> f = {fy + lab.a / 500, fy, fy - lab.b / 200};
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double cube = f[i] * f[i] * f[i];
    xyz[i] = kWhite[i] * (cube > kEpsilon ? cube : (116 * f[i] - 16) / kKappa);
  }
  const auto& [x, y, z] = xyz;
  const Rgb linear = {3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
                      -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                      0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
  Rgb rgb{};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    rgb[i] = Encoded(std::clamp(linear[i], 0.0, 1.0));
  }
  return rgb;
}

// As light as the first person's, and so little coloured that no hue comes near a class.
constexpr double kLightness = 81;
constexpr double kMostChroma = 18;

Rgb Muted(double hue, double chroma) {
  return ToRgb({kLightness, chroma * std::cos(hue), chroma * std::sin(hue)});
}

}  // namespace

double ColorDifference(const Rgb& one, const Rgb& other) {
  Lab p = ToLab(one);
  Lab q = ToLab(other);
  const auto pow7 = [](double x) { return std::pow(x, 7); };
  const auto saturation = [&](double chroma) {
    return std::sqrt(pow7(chroma) / (pow7(chroma) + pow7(25)));
  };
  const double stretch = 1 + 0.5 * (1 - saturation(0.5 * (p.chroma() + q.chroma())));
  p.a *= stretch;
  q.a *= stretch;
  const double chroma = 0.5 * (p.chroma() + q.chroma());
  const double hue_p = std::atan2(p.b, p.a);
  // As the turn from p to q the shorter way round, whatever multiple of 2 pi lies between.
  const double turn = std::remainder(std::atan2(q.b, q.a) - hue_p, 2 * M_PI);
  const double hue = hue_p + 0.5 * turn;
  const double degree = M_PI / 180;

  const double dl = q.l - p.l;
  const double dc = q.chroma() - p.chroma();
  const double dh = 2 * std::sqrt(p.chroma() * q.chroma()) * std::sin(0.5 * turn);
  const double t = 1 - 0.17 * std::cos(hue - 30 * degree) + 0.24 * std::cos(2 * hue) +
                   0.32 * std::cos(3 * hue + 6 * degree) - 0.20 * std::cos(4 * hue - 63 * degree);
  const double from_50 = std::pow(0.5 * (p.l + q.l) - 50, 2);
  const double sl = 1 + 0.015 * from_50 / std::sqrt(20 + from_50);
  const double sc = 1 + 0.045 * chroma;
  const double sh = 1 + 0.015 * chroma * t;
  const double from_blue = std::remainder(hue - 275 * degree, 2 * M_PI) / (25 * degree);
  const double rotation =
      -2 * saturation(chroma) * std::sin(2 * 30 * degree * std::exp(-from_blue * from_blue));
  const double l = dl / sl;
  const double c = dc / sc;
  const double h = dh / sh;
  return std::sqrt(l * l + c * c + h * h + rotation * c * h);
}

Rgb BodyColor(std::optional<std::uint32_t> own_rgb, std::size_t index) {
  if (own_rgb) {
    const auto channel = [&](int shift) { return (*own_rgb >> shift & 0xFF) / 255.0; };
    const Lab own = ToLab({channel(16), channel(8), channel(0)});
    return Muted(std::atan2(own.b, own.a), std::min(own.chroma(), kMostChroma));
  }
  // Aqua, sand, mauve, sage, rose, sky: hues in degrees, neighbours in the list far apart.
  constexpr std::array<double, kBodyColors - 1> kHues = {200, 75, 320, 130, 20, 255};
  index %= kBodyColors;
  return index == 0 ? kBodyColor : Muted(kHues[index - 1] * M_PI / 180, kMostChroma);
}

}  // namespace kinescope::app
