#include "urdf/body_profiles.h"

#include <cmath>

namespace kinescope::urdf {
namespace {

// How much a bump centred at 0 with this half-width has left at x.
double Bump(double x, double width) { return std::exp(-(x * x) / (width * width)); }

}  // namespace

const Profile& TrunkProfile() {
  const auto oval = [](double at, double front, double back, double side, double power) {
    return Widths(at, front, back, side, side).Power(power, power);
  };
  static const Profile kProfile(
      {oval(0.00, .089, .106, .161, 2.2), oval(0.25, .093, .110, .165, 2.2),
       oval(0.55, .096, .109, .162, 2.2), oval(1.00, .095, .097, .149, 2.2),
       oval(1.50, .093, .086, .137, 2.2), oval(2.00, .093, .082, .131, 2.2),
       oval(2.50, .097, .085, .132, 2.2), oval(3.00, .104, .092, .139, 2.2),
       oval(3.50, .111, .100, .149, 2.2), oval(4.00, .115, .106, .158, 2.2),
       oval(4.30, .113, .108, .160, 2.2), oval(4.57, .102, .105, .148, 2.2),
       oval(4.80, .079, .090, .108, 2.1), oval(5.00, .061, .073, .073, 2.0),
       oval(5.25, .055, .061, .060, 2.0), oval(6.00, .052, .052, .052, 2.0)});
  return kProfile;
}

const Profile& LegProfile() {
  static const Profile kProfile(
      {Widths(0.10, .080, .096, .078, .082), Widths(0.22, .087, .092, .084, .086),
       Widths(0.40, .087, .081, .081, .080), Widths(0.70, .072, .064, .064, .064),
       Widths(0.90, .058, .054, .053, .056), Widths(1.00, .056, .050, .051, .053),
       Widths(1.10, .049, .053, .049, .051), Widths(1.26, .044, .068, .056, .055),
       Widths(1.42, .042, .064, .051, .051), Widths(1.62, .037, .047, .040, .040),
       Widths(1.82, .032, .035, .032, .032), Widths(2.00, .034, .036, .035, .034)});
  return kProfile;
}

const Profile& ArmProfile() {
  static const Profile kProfile(
      {Widths(0.12, .053, .053, .056, .050), Widths(0.22, .053, .051, .055, .047),
       Widths(0.36, .050, .047, .049, .044), Widths(0.56, .049, .046, .042, .041),
       Widths(0.80, .040, .040, .038, .039), Widths(1.00, .038, .040, .040, .039),
       Widths(1.14, .041, .039, .043, .040), Widths(1.32, .040, .037, .040, .037),
       Widths(1.56, .033, .032, .032, .030), Widths(1.82, .028, .027, .024, .024),
       Widths(2.00, .028, .028, .021, .021)});
  return kProfile;
}

const Profile& GirdleProfile() {
  static const Profile kProfile(
      {Widths(0.0, .076, .070, .062, .082), Widths(0.3, .064, .070, .064, .078),
       Widths(0.6, .053, .068, .060, .064), Widths(0.9, .046, .058, .047, .047)});
  return kProfile;
}

const Profile& PalmProfile() {
  const auto flat = [](double at, double thumb, double small, double thick) {
    return Widths(at, thumb, small, thick, thick).Power(2.5, 2.5);
  };
  static const Profile kProfile({flat(0.00, .028, .028, .021).Power(2, 2),
                                 flat(0.14, .031, .031, .0185), flat(0.30, .039, .038, .0175),
                                 flat(0.44, .042, .0405, .0125), flat(0.52, .0380, .0365, .0105)});
  return kProfile;
}

const std::array<Finger, 4> kDigits = {{{.0305, .47, .0350, .92, .0100},
                                        {.0102, .49, .0115, 1.00, .0104},
                                        {-.0102, .48, -.0125, .94, .0100},
                                        {-.0298, .45, -.0360, .80, .0089}}};

const Profile& FingerProfile() {
  const auto round = [](double at, double radius) {
    return Widths(at, radius, radius, radius, radius);
  };
  static const Profile kProfile({round(0, 1), round(1, .96), round(2, .78)});
  return kProfile;
}

const Profile& HeadProfile() {
  const auto egg = [](double at, double front, double back, double side, double center) {
    return Widths(at, front - center, back + center, side, side).Center(center, 0);
  };
  static const Profile kProfile(
      {egg(-0.31, .072, -.030, .020, .051), egg(-0.23, .086, -.022, .035, .054),
       egg(-0.13, .097, .024, .053, .040), egg(0.00, .099, .060, .064, .024),
       egg(0.20, .099, .083, .0730, .012), egg(0.33, .098, .0905, .0760, .006),
       egg(0.44, .097, .092, .0765, .002)});
  return kProfile;
}

const Profile& EarProfile() {
  static const Profile kProfile({Widths(0, .006, .006, .005, .006),
                                 Widths(1, .013, .012, .006, .008),
                                 Widths(2, .012, .016, .006, .008)});
  return kProfile;
}

const Profile& FootProfile() {
  const auto shoe = [](double at, double height, double side, double inward) {
    const double center = 0.36 * height;
    return Widths(at, height - center, center, side, side).Center(center, -inward).Power(2.0, 3.5);
  };
  static const Profile kProfile({shoe(0.14, .084, .033, 0), shoe(0.30, .094, .035, 0),
                                 shoe(0.48, .080, .036, 0), shoe(0.72, .060, .042, .002),
                                 shoe(1.00, .047, .0465, .003), shoe(1.25, .043, .047, .004)});
  return kProfile;
}

const Profile& ToeProfile() {
  const auto shoe = [](double at, double height, double side, double inward) {
    const double center = 0.38 * height;
    return Widths(at, height - center, center, side, side).Center(center, -inward).Power(2.0, 3.5);
  };
  static const Profile kProfile({shoe(-0.40, .051, .045, .002), shoe(0.00, .047, .0465, .003),
                                 shoe(0.55, .0385, .0445, .006), shoe(1.00, .029, .036, .009)});
  return kProfile;
}

double FaceRelief(double y, double z) {
  const double across = Bump(y, 0.075);
  const double nose = z < 0.21 ? Bump(z - 0.21, 0.05) : Bump(z - 0.21, 0.16);
  const double eyes = Bump(std::abs(y) - 0.17, 0.09) * Bump(z - 0.40, 0.06);
  const double brow = Bump(y, 0.30) * Bump(z - 0.50, 0.06);
  const double lips = Bump(y, 0.14) * Bump(z - 0.035, 0.05);
  const double chin = Bump(y, 0.14) * Bump(z + 0.16, 0.06);
  return 0.115 * nose * across - 0.040 * eyes + 0.018 * brow + 0.024 * lips + 0.030 * chin;
}

TrunkRelief TrunkReliefAt(double y, double at) {
  const double side = std::abs(y);
  // The chest ends in a fold below and runs out softly above.
  const double chest = Bump(side - 0.075, 0.062) * Bump(at - 3.55, at < 3.55 ? 0.45 : 0.85);
  const double breastbone = Bump(y, 0.020) * Bump(at - 3.7, 0.8);
  const double navel_line = Bump(y, 0.016) * Bump(at - 2.3, 1.2);
  const double spine = Bump(y, 0.024) * Bump(at - 2.6, 1.6);
  const double blades = Bump(side - 0.085, 0.050) * Bump(at - 3.7, 0.7);
  const double buttocks = Bump(side - 0.075, 0.062) * Bump(at - 0.15, 0.60);
  return {0.013 * chest - 0.004 * breastbone - 0.004 * navel_line,
          0.006 * blades - 0.008 * spine + 0.016 * buttocks};
}

}  // namespace kinescope::urdf
