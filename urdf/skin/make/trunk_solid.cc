#include <iterator>

#include "urdf/skin/make/body_parts.h"

namespace kinescope::skin {
namespace {

// Half depth to the front and back and half width, man and woman, at a height above the hips, m.
struct TrunkSection {
  double z;
  double front[2], back[2], side[2];
  double center_x, fullness;
};
constexpr TrunkSection kTrunkSections[] = {
    {-0.024, {0.092, 0.098}, {0.103, 0.113}, {0.152, 0.172}, -0.006, 0.14},
    {0.030, {0.105, 0.110}, {0.121, 0.128}, {0.161, 0.177}, -0.006, 0.17},
    {0.075, {0.112, 0.116}, {0.110, 0.117}, {0.157, 0.168}, -0.002, 0.15},
    {0.120, {0.116, 0.122}, {0.100, 0.106}, {0.160, 0.166}, 0.004, 0.13},
    {0.170, {0.119, 0.124}, {0.095, 0.103}, {0.160, 0.159}, 0.010, 0.13},
    {0.215, {0.119, 0.119}, {0.097, 0.102}, {0.161, 0.156}, 0.010, 0.13},
    {0.260, {0.120, 0.114}, {0.105, 0.102}, {0.167, 0.153}, 0.006, 0.16},
    {0.310, {0.125, 0.113}, {0.119, 0.110}, {0.178, 0.163}, 0.004, 0.16},
    {0.360, {0.118, 0.106}, {0.121, 0.111}, {0.172, 0.160}, 0.000, 0.16},
    {0.400, {0.100, 0.086}, {0.110, 0.097}, {0.158, 0.138}, -0.004, 0.16},
    {0.432, {0.080, 0.070}, {0.098, 0.087}, {0.132, 0.118}, -0.010, 0.10},
};

Loft TrunkLoft(const Build& build) {
  std::vector<CrossSection> sections;
  for (const TrunkSection& s : kTrunkSections) {
    const auto of = [&](const double(&both)[2]) { return Mix(both[0], both[1], build.woman); };
    sections.push_back({s.z, of(s.front) - s.center_x, of(s.back) + s.center_x, of(s.side),
                        of(s.side), s.center_x, 0, s.fullness});
  }
  return Loft(std::move(sections), 0.075, 0.040);
}

}  // namespace

TrunkSolid::TrunkSolid(const Build& build) : build_(build), loft_(TrunkLoft(build)) {}

// A belly grows to the front; hips and chest less.
double TrunkSolid::Growth(const Point& p) const {
  struct Place {
    double z, front, around;
  };
  static constexpr Place kPlaces[] = {
      {-0.08, 0.014, 0.014}, {0.00, 0.024, 0.024}, {0.07, 0.042, 0.029}, {0.14, 0.053, 0.034},
      {0.21, 0.048, 0.032},  {0.28, 0.031, 0.022}, {0.36, 0.019, 0.016}, {0.46, 0.008, 0.008}};
  // Cubic Hermite curves; the ends are level.
  const double z = std::clamp(p.z(), std::begin(kPlaces)->z, std::prev(std::end(kPlaces))->z);
  const Place* above = std::begin(kPlaces) + 1;
  while (above->z < z) ++above;
  const Place& below = above[-1];
  const double length = above->z - below.z, t = (z - below.z) / length, t2 = t * t, t3 = t2 * t;
  const auto at = [&](double Place::*of) {
    const auto slope = [&](const Place* place) {
      if (place == std::begin(kPlaces) || place + 1 == std::end(kPlaces)) return 0.0;
      return (place[1].*of - place[-1].*of) / (place[1].z - place[-1].z);
    };
    return (2 * t3 - 3 * t2 + 1) * (below.*of) + (t3 - 2 * t2 + t) * length * slope(&below) +
           (3 * t2 - 2 * t3) * (above->*of) + (t3 - t2) * length * slope(above);
  };
  const double front = Ramp(-0.06, 0.10, p.x());
  const double man = Mix(at(&Place::around), at(&Place::front), front);
  return man * (1 + 0.20 * build_.woman);
}

double TrunkSolid::operator()(const Point& p) const {
  const double woman = build_.woman, lean = std::max(1 - 0.8 * build_.heavy, 0.0);
  const double z = p.z(), side = std::abs(p.y());
  // Relief: how far the surface stands out of its loft.
  const double front = Ramp(0.02, 0.09, p.x()), back = Ramp(-0.02, -0.085, p.x());
  const double midline = Bump(side, 0.022) * Ramp(0.06, 0.14, z) * (1 - Ramp(0.37, 0.44, z));
  const double straight_muscle = Bump(side - 0.045, 0.034) * Bump(z - 0.19, 0.13);
  const double ribs = Bump(side - 0.085, 0.055) * Bump(z - 0.235, 0.026);
  const double spine = Bump(side, 0.022) * Ramp(0.02, 0.10, z) * (1 - Ramp(0.40, 0.47, z));
  const double back_muscle = Bump(side - 0.040, 0.030) * Bump(z - 0.15, 0.12);
  const double relief = front * lean *
                            (0.004 * (1 - 0.6 * woman) * straight_muscle - 0.004 * midline -
                             0.003 * (1 - woman) * ribs) +
                        back * lean * (0.007 * back_muscle - 0.010 * spine);
  Joined trunk(loft_(p.x(), p.y(), z) - relief);

  for (const double sign : {1.0, -1.0}) {
    if (sign * p.y() < -0.08) continue;  // nothing of the other half is so far across
    const Point m(p.x(), sign * p.y(), z);
    static const Eigen::Matrix3d kChest = AxesAlong({0.25, -0.30, 0.9}, {0.86, 0.45, 0});
    static const Eigen::Matrix3d kBlade = AxesAlong({0.15, 0.25, 1}, {1, 0.35, 0});
    static const Eigen::Matrix3d kSeat = AxesAlong({0.10, 0.28, 1}, {1, 0.15, 0});
    // Pectoral muscle; a breast in its place on a woman.
    trunk.Add(
        Ellipsoid(m, {0.056, 0.082, 0.374}, {0.056, 0.090, 0.056}, kChest) + 0.004 + 0.006 * woman,
        0.040);
    trunk.Add(Ellipsoid(m, {0.074, 0.073, 0.316}, {0.058, 0.061, 0.060}) + 0.030 * (1 - woman),
              0.054);
    // Latissimus: from the armpit to the waist.
    trunk.Add(RoundCone(m, {-0.036, 0.100 + 0.006 * woman, 0.384}, {-0.020, 0.062, 0.190},
                        0.060 - 0.002 * woman, 0.034),
              0.060);
    // Shoulder blade.
    trunk.Add(
        Ellipsoid(m, {-0.078, 0.086, 0.388}, {0.034, 0.062, 0.080}, kBlade) + 0.007 + 0.002 * woman,
        0.060);
    // Seat.
    trunk.Add(
        Ellipsoid(m, {-0.062 - 0.010 * woman, 0.080 + 0.006 * woman, -0.024},
                  {0.070 + 0.007 * woman, 0.075 + 0.006 * woman, 0.086 + 0.006 * woman}, kSeat) -
            0.002 * woman,
        0.035);
    // Flank and hip bone.
    trunk.Add(Ellipsoid(m, {0.012, 0.108, 0.095}, {0.072, 0.050, 0.060}) + 0.005, 0.07);
  }
  return trunk.value() - build_.heavy * Growth(p);
}

double TrunkSolid::Girdle(const Point& p) const {
  const double woman = build_.woman, heavy = build_.heavy;
  const Point sternum(0, 0.030, 0.426), shoulder(0, 0.180, 0.426);  // the clavicle's two joints
  Joined girdle(RoundCone(p, sternum + Point(-0.020, 0.005, -0.020),
                          shoulder + Point(-0.008, -0.026 - 0.006 * woman, -0.022 - 0.004 * woman),
                          0.074 - 0.004 * woman, 0.048 - 0.006 * woman));
  // Trapezius, upper and middle.
  const Point middle(-0.032, 0.090, 0.478 - 0.004 * woman);
  const double upper = 0.031 - 0.004 * woman + 0.003 * heavy;
  Joined trapezius(
      RoundCone(p, {-0.034, 0.020, 0.530}, middle, 0.027 - 0.004 * woman + 0.006 * heavy, upper));
  trapezius.Add(
      RoundCone(p, middle, {-0.014, 0.172, 0.441 - 0.003 * woman}, upper, 0.028 - 0.003 * woman),
      0.040);
  girdle.Add(trapezius.value(), 0.055);
  girdle.Add(RoundCone(p, {-0.052, 0.020, 0.500}, {-0.070, 0.085, 0.425}, 0.034 - 0.003 * woman,
                       0.034 - 0.003 * woman),
             0.050);
  // Collar bone.
  girdle.Add(
      RoundCone(p, {0.056 - 0.003 * woman, 0.026, 0.437}, {0.018, 0.140, 0.456}, 0.0105, 0.0105) +
          0.003 * woman + 0.004 * heavy,
      0.036);
  // Breastbone and first ribs, flush with the collar bones.
  girdle.Add(Ellipsoid(p, {0.036 - 0.004 * woman, 0.034, 0.400}, {0.050, 0.078, 0.050}), 0.040);
  return girdle.value() - 0.008 * heavy;
}

}  // namespace kinescope::skin
