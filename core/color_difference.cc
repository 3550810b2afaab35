#include "core/color_difference.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinescope {
namespace {

constexpr std::array<double, 3> kWhite = {0.95047, 1.0, 1.08883};  // D65, as X Y Z
constexpr double kEpsilon = 216.0 / 24389;
constexpr double kKappa = 24389.0 / 27;

// 0..2 pi
double HueOf(const Lab& lab) {
  const double hue = std::atan2(lab.b, lab.a);
  return hue < 0 ? hue + 2 * M_PI : hue;
}

}  // namespace

double ToLinear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double ToEncoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Lab ToLab(const Rgb& rgb) {
  const double r = ToLinear(rgb[0]);
  const double g = ToLinear(rgb[1]);
  const double b = ToLinear(rgb[2]);
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
    rgb[i] = ToEncoded(std::clamp(linear[i], 0.0, 1.0));
  }
  return rgb;
}

double ColorDifference(const Lab& one, const Lab& other) {
  Lab p = one;
  Lab q = other;
  const auto pow7 = [](double x) { return std::pow(x, 7); };
  const auto saturation = [&](double chroma) {
    return std::sqrt(pow7(chroma) / (pow7(chroma) + pow7(25)));
  };
  const double stretch = 1 + 0.5 * (1 - saturation(0.5 * (p.chroma() + q.chroma())));
  p.a *= stretch;
  q.a *= stretch;
  const double chroma = 0.5 * (p.chroma() + q.chroma());
  const double hue_p = HueOf(p);
  // From p to q the shorter way round; of two that are opposite, the way that does not pass 0.
  double turn = HueOf(q) - hue_p;
  if (std::abs(turn) > M_PI * (1 + 1e-12)) turn -= std::copysign(2 * M_PI, turn);
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

double ColorDifference(const Rgb& one, const Rgb& other) {
  return ColorDifference(ToLab(one), ToLab(other));
}

}  // namespace kinescope
