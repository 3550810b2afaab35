/// Measures how different two colours look: converts sRGB to CIE L*a*b* (D65, 2 degrees) and
/// computes the CIEDE2000 difference. Pure functions, any thread.
/// Sources: IEC 61966-2-1 (sRGB), CIE 15:2004 (L*a*b*), and Sharma, Wu, Dalal (2005), The CIEDE2000
/// color-difference formula: implementation notes, Color Res. Appl. 30(1), 21-30.
#pragma once

#include <cmath>

#include "core/palette.h"

namespace kinescope {

struct Lab {
  double l = 0, a = 0, b = 0;  // l: 0 black to 100 white
  double chroma() const { return std::hypot(a, b); }
};

/// Converts one sRGB channel, 0..1, to linear light and back.
double ToLinear(double encoded);
double ToEncoded(double linear);

Lab ToLab(const Rgb& rgb);
/// Clamps channels that are outside the sRGB gamut.
Rgb ToRgb(const Lab& lab);

/// CIEDE2000 with all weights 1. 1 is about the just noticeable difference for adjacent colours;
/// black and white differ by 100.
double ColorDifference(const Lab& one, const Lab& other);
double ColorDifference(const Rgb& one, const Rgb& other);

}  // namespace kinescope
