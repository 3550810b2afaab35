#include "urdf/skin/make/body_parts.h"

namespace kinescope::skin {
namespace {

// Below the shoulder, m: forward, back, outward, inward, and how far the section is forward.
struct ArmSection {
  double down, forward, back, outward, inward, center;
};
constexpr double kElbow = 0.300;
constexpr ArmSection kArmSections[] = {
    {0.045, 0.047, 0.047, 0.046, 0.046, 0},     {0.080, 0.049, 0.049, 0.046, 0.047, 0},
    {0.140, 0.048, 0.049, 0.041, 0.044, 0.001}, {0.190, 0.046, 0.048, 0.037, 0.041, 0.001},
    {0.240, 0.041, 0.043, 0.036, 0.039, 0},     {0.280, 0.037, 0.039, 0.038, 0.040, 0},
    {0.305, 0.036, 0.038, 0.040, 0.040, 0},     {0.340, 0.041, 0.038, 0.042, 0.039, 0.003},
    {0.380, 0.043, 0.038, 0.040, 0.036, 0.003}, {0.430, 0.038, 0.035, 0.034, 0.031, 0.001},
    {0.480, 0.031, 0.030, 0.026, 0.024, 0},     {0.525, 0.029, 0.029, 0.0205, 0.0205, 0},
    {0.555, 0.030, 0.030, 0.0200, 0.0200, 0},
};

Loft ArmLoft(const Build& build) {
  std::vector<CrossSection> sections;
  for (const ArmSection& s : kArmSections) {
    const double size =
        s.down < 0.47 ? Mix(1.07, 1.00, build.woman) : Mix(1.085, 1.03, build.woman);
    sections.push_back({s.down, size * s.forward, size * s.back, size * s.outward, size * s.inward,
                        s.center, 0, 0});
  }
  return Loft(std::move(sections), 0.062, 0.020);
}

}  // namespace

ArmSolid::ArmSolid(const Build& build) : build_(build), loft_(ArmLoft(build)) {}

double ArmSolid::operator()(const Point& q) const {
  const double size = 1 - 0.11 * build_.woman;  // of the muscles
  Joined arm(loft_(q.x(), q.y(), -q.z()));
  // Deltoid: middle, all around, front and back. Its end goes over into the arm without a step.
  arm.Add(RoundCone(q, {0, -0.001, -0.036}, {0.002, 0.006, -0.170}, 0.0465 * size, 0.0310 * size),
          0.018);
  arm.Add(Ellipsoid(q, {0, 0.010, -0.078}, {0.0490 * size, 0.0410 * size, 0.104}), 0.018);
  arm.Add(RoundCone(q, {0.022, 0.004, -0.042}, {0.014, 0.010, -0.135}, 0.0310 * size, 0.022 * size),
          0.026);
  arm.Add(
      RoundCone(q, {-0.024, 0.004, -0.044}, {-0.014, 0.010, -0.135}, 0.0320 * size, 0.022 * size),
      0.026);
  // Biceps and triceps.
  arm.Add(Ellipsoid(q, {0.021, -0.004, -0.178}, {0.0300 * size, 0.0310 * size, 0.074}), 0.022);
  arm.Add(Ellipsoid(q, {-0.023, 0.006, -0.150}, {0.0315 * size, 0.0330 * size, 0.088}), 0.022);
  // Point of the elbow, and the bones beside it.
  arm.Add(Ellipsoid(q, {-0.029, 0, -0.298}, {0.0130, 0.0150, 0.025}), 0.026);
  arm.Add(Ellipsoid(q, {-0.004, -0.034 * size, -0.293}, {0.013, 0.010, 0.016}), 0.022);
  // Muscles that move wrist and fingers: outer and inner.
  arm.Add(RoundCone(q, {0.012, 0.020 * size, -0.318}, {0.014, 0.010, -0.425}, 0.0215 * size,
                    0.0150 * size),
          0.036);
  arm.Add(RoundCone(q, {0, -0.021 * size, -0.330}, {0.002, -0.009, -0.430}, 0.0200 * size,
                    0.0145 * size),
          0.034);
  const double upper = Mix(0.011, 0.014, build_.woman), wrist = 0.003;
  const double growth = q.z() > -kElbow ? Mix(upper, 0.006, Ramp(-0.16, -kElbow, q.z()))
                                        : Mix(0.006, wrist, Ramp(-kElbow, -0.52, q.z()));
  return arm.value() - build_.heavy * growth;
}

}  // namespace kinescope::skin
