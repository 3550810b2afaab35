/// How different two colours look: CIE L*a*b* (D65, 2 degrees) of sRGB, and CIEDE2000 between them.
/// Pure functions, any thread.
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

/// One channel of sRGB, 0..1, to what light adds up in, and back.
double ToLinear(double encoded);
double ToEncoded(double linear);

Lab ToLab(const Rgb& rgb);
/// Channels that a screen cannot show are clamped.
Rgb ToRgb(const Lab& lab);

/// CIEDE2000, all weights 1. 1 is just seen side by side; black and white are 100 apart.
double ColorDifference(const Lab& one, const Lab& other);
double ColorDifference(const Rgb& one, const Rgb& other);

}  // namespace kinescope
