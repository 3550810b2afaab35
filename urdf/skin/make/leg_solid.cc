#include "urdf/skin/make/body_parts.h"

namespace kinescope::skin {
namespace {

// Below the hip, m: forward, back, outward, inward, and how far the section is forward and outward.
struct LegSection {
  double down, forward, back, outward[2], inward[2], forward_by, outward_by;
};
constexpr double kKnee = 0.465, kAnkle = 0.910;
constexpr LegSection kLegSections[] = {
    {0.000, 0.076, 0.076, {0.073, 0.082}, {0.062, 0.062}, 0, 0.002},
    {0.060, 0.084, 0.090, {0.084, 0.093}, {0.076, 0.076}, 0, 0.001},
    {0.120, 0.091, 0.094, {0.087, 0.093}, {0.088, 0.092}, 0.001, 0},
    {0.200, 0.091, 0.088, {0.082, 0.084}, {0.084, 0.086}, 0.003, 0},
    {0.290, 0.083, 0.078, {0.073, 0.074}, {0.073, 0.075}, 0.004, 0},
    {0.370, 0.071, 0.066, {0.061, 0.062}, {0.062, 0.064}, 0.003, 0},
    {0.425, 0.063, 0.058, {0.055, 0.056}, {0.059, 0.060}, 0.001, 0},
    {0.465, 0.059, 0.055, {0.052, 0.052}, {0.056, 0.056}, 0, 0},
    {0.505, 0.054, 0.055, {0.052, 0.052}, {0.053, 0.053}, -0.002, 0},
    {0.550, 0.049, 0.062, {0.055, 0.055}, {0.055, 0.055}, -0.005, 0},
    {0.605, 0.046, 0.066, {0.055, 0.055}, {0.056, 0.056}, -0.008, 0},
    {0.665, 0.043, 0.060, {0.050, 0.050}, {0.050, 0.050}, -0.008, 0},
    {0.740, 0.036, 0.046, {0.038, 0.038}, {0.038, 0.038}, -0.006, 0},
    {0.810, 0.032, 0.038, {0.031, 0.031}, {0.031, 0.031}, -0.004, 0},
    {0.860, 0.033, 0.038, {0.030, 0.030}, {0.031, 0.031}, -0.002, 0},
    {0.895, 0.036, 0.040, {0.033, 0.033}, {0.034, 0.034}, 0, 0},
};

Loft LegLoft(const Build& build) {
  std::vector<CrossSection> sections;
  for (const LegSection& s : kLegSections) {
    const double size = s.down > 0.1 ? Mix(s.down > 0.5 ? 1.025 : 1, 1.065, build.woman) : 1;
    sections.push_back({s.down, size * s.forward, size * s.back,
                        size * Mix(s.outward[0], s.outward[1], build.woman),
                        size * Mix(s.inward[0], s.inward[1], build.woman), s.forward_by,
                        s.outward_by, 0.12 * Ramp(0.22, 0.06, s.down)});
  }
  return Loft(std::move(sections), 0.110, 0.035);
}

}  // namespace

LegSolid::LegSolid(const Build& build) : build_(build), loft_(LegLoft(build)) {}

double LegSolid::operator()(const Point& q) const {
  const double woman = build_.woman;
  Joined leg(loft_(q.x(), q.y(), -q.z()));
  // Quadriceps: outer sweep, and the drop above the inner knee. Hamstrings. Adductors.
  leg.Add(Ellipsoid(q, {0.030, 0.034, -0.230}, {0.040, 0.036, 0.150}), 0.030);
  leg.Add(Ellipsoid(q, {0.034, -0.028, -0.360}, {0.024, 0.024, 0.070}) + 0.003 * woman, 0.026);
  leg.Add(Ellipsoid(q, {-0.028, -0.022, -0.260}, {0.040, 0.036, 0.150}), 0.030);
  leg.Add(Ellipsoid(q, {0, -0.052, -0.085}, {0.052, 0.040, 0.110}), 0.035);
  // Kneecap, and its tendon to the shin.
  leg.Add(Ellipsoid(q, {0.036, 0, -0.450}, {0.0200, 0.0290, 0.0330}), 0.034);
  leg.Add(Ellipsoid(q, {0.032, 0.002, -0.522}, {0.0150, 0.0190, 0.0300}), 0.032);
  // Calf: two heads, the inner one lower; the Achilles tendon.
  const Point k = q + Point(0, 0, kKnee);
  leg.Add(Ellipsoid(k, {-0.033, -0.022, -0.145}, {0.034, 0.031, 0.090}), 0.024);
  leg.Add(Ellipsoid(k, {-0.034, 0.021, -0.130}, {0.033, 0.029, 0.082}), 0.024);
  leg.Add(RoundCone(k, {-0.030, 0, -0.260}, {-0.038, 0, -0.425}, 0.020, 0.0095), 0.022);
  // Thighs that grew inwards would become one below the crotch.
  const double inner = Ramp(0.02, -0.05, q.y()) * Ramp(-0.30, -0.16, q.z());
  const double thigh = Mix(0.024, 0.027, woman) * (1 - inner), knee = Mix(0.010, 0.014, woman);
  const double growth = q.z() > -kKnee ? Mix(thigh, knee, Ramp(-0.15, -0.42, q.z()))
                                       : Mix(knee, 0.003, Ramp(-0.60, -0.86, q.z()));
  return leg.value() - build_.heavy * growth;
}

double FootSolid(const Point& q, const Build& build) {
  // A woman's foot is as long, and a little narrower.
  const Point m(q.x(), q.y() * (1 + 0.04 * build.woman), q.z());
  Joined foot(Ellipsoid(m, {-0.018, 0, -0.046}, {0.036, 0.0325, 0.042}));                // heel
  foot.Add(RoundCone(m, {-0.004, 0, -0.012}, {-0.018, 0, -0.050}, 0.036, 0.031), 0.02);  // its top
  foot.Add(RoundCone(m, {0.020, -0.004, -0.022}, {0.120, -0.010, -0.060}, 0.0310, 0.0190),
           0.030);  // instep
  foot.Add(RoundCone(m, {-0.005, 0.008, -0.058}, {0.115, 0.020, -0.066}, 0.0240, 0.0200),
           0.028);                                                                 // outer edge
  foot.Add(Ellipsoid(m, {0.140, -0.019, -0.064}, {0.034, 0.027, 0.0195}), 0.025);  // ball
  foot.Add(Ellipsoid(m, {0.125, 0.024, -0.066}, {0.036, 0.025, 0.0170}), 0.025);
  // The front of a shoe-like sock: great toe to little toe.
  foot.Add(RoundCone(m, {0.150, -0.018, -0.064}, {0.198, -0.012, -0.066}, 0.0205, 0.0150), 0.026);
  foot.Add(RoundCone(m, {0.140, 0.006, -0.064}, {0.192, 0.006, -0.067}, 0.0195, 0.0138), 0.030);
  foot.Add(RoundCone(m, {0.130, 0.030, -0.066}, {0.174, 0.026, -0.068}, 0.0165, 0.0128), 0.030);
  // Ankle bones, the outer one lower and further back.
  foot.Add(RoundCone(m, {-0.004, 0.025, -0.002}, {-0.004, 0.026, -0.007}, 0.0125, 0.0125), 0.022);
  foot.Add(RoundCone(m, {0.006, -0.026, 0.006}, {0.006, -0.026, 0.002}, 0.0125, 0.0125), 0.022);
  foot.Cut(m.z() + 0.080, 0.010);  // the floor
  return foot.value();
}

}  // namespace kinescope::skin
