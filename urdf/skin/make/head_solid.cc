#include "urdf/skin/make/body_parts.h"

namespace kinescope::skin {

double NeckSolid(const Point& p, const Build& build) {
  const double woman = build.woman, heavy = build.heavy;
  const Point m(p.x(), std::abs(p.y()), p.z());
  // Leans forward, from the back of the collar to the skull.
  const double radius = Mix(0.0575, 0.0500, woman) + 0.009 * heavy;
  Joined neck(RoundCone(m, {-0.016, 0, 0.455}, {0.004, 0, 0.600}, radius + 0.006, radius - 0.004));
  // Muscle from behind the ear to the breastbone; larynx.
  neck.Add(RoundCone(m, {-0.008, 0.047 - 0.006 * woman, 0.590},
                     {0.048 - 0.005 * woman, 0.018, 0.455}, 0.013, 0.0095) +
               0.001 * woman + 0.004 * heavy,
           0.026);
  neck.Add(RoundCone(m, {0.047, 0, 0.528}, {0.046, 0, 0.495}, 0.0125, 0.0120) + 0.006 * woman +
               0.004 * heavy,
           0.026);
  return neck.value();
}

double HeadSolid(const Point& q, const Build& build) {
  const double woman = build.woman, man = 1 - woman, heavy = build.heavy;
  // Heads do not shrink with the stature: a woman's is larger for a body of this height.
  const double size = Mix(1, 1.045, woman);
  const Point m(q.x() / size, std::abs(q.y()) / size, q.z() / size);
  // Skull.
  Joined head(Ellipsoid(m, {-0.006, 0, 0.104}, {0.0985, 0.0765, 0.0870}));
  head.Add(Ellipsoid(m, {-0.045, 0, 0.085}, {0.058, 0.066, 0.070}), 0.03);
  // Face, jaw, cheeks, chin, cheekbones.
  head.Add(Ellipsoid(m, {0.034, 0, 0.046}, {0.0600, Mix(0.0545, 0.0525, woman), 0.080}), 0.030);
  head.Add(
      RoundCone(m, {0.012, Mix(0.0425, 0.0375, woman), 0.012},
                {Mix(0.072, 0.069, woman), Mix(0.013, 0.009, woman), Mix(-0.019, -0.014, woman)},
                Mix(0.0155, 0.0140, woman), Mix(0.0150, 0.0130, woman)),
      0.034);
  head.Add(Ellipsoid(m, {0.048, 0.034, 0.018}, {0.030, 0.024, 0.034}) - 0.004 * heavy, 0.030);
  head.Add(Ellipsoid(m, {0.080 - 0.003 * woman, 0, Mix(-0.019, -0.015, woman)},
                     {0.0155, Mix(0.0200, 0.0150, woman), 0.0150}),
           0.022);
  head.Add(Ellipsoid(m, {0.056, 0.043, 0.050}, {0.026, 0.021, 0.022}) + 0.001 * man, 0.034);
  // Brow.
  head.Add(RoundCone(m, {0.088, 0, 0.094}, {0.068, 0.046, 0.088}, 0.0105, 0.0080) + 0.0035 * woman,
           0.022);
  // Forehead, steeper on a woman.
  head.Add(Ellipsoid(m, {0.052, 0, 0.112}, {0.044, 0.052, 0.046}) + 0.004 * man, 0.030);
  // Eyes, closed: socket, then the lid.
  head.Cut(Ellipsoid(m, {0.1010, 0.0325, 0.0735}, {0.0150, 0.0200, 0.0120}), 0.020);
  head.Add(Ellipsoid(m, {0.0765, 0.0320, 0.0715},
                     {0.0122 + 0.0008 * woman, 0.0155, 0.0105 + 0.0007 * woman}),
           0.006);
  // Nose: bridge, tip, wings.
  head.Add(RoundCone(m, {0.0880, 0, 0.084}, {0.1075 - 0.003 * woman, 0, 0.0460 + 0.001 * woman},
                     0.0070 - 0.0008 * woman, 0.0085 - 0.0012 * woman),
           0.016);
  head.Add(Ellipsoid(m, {0.1060 - 0.002 * woman, 0, 0.0430 + 0.0015 * woman},
                     {0.0110, 0.0100 - 0.001 * woman, 0.0085}),
           0.011);
  head.Add(Ellipsoid(m, {0.0975, 0.0110 - 0.001 * woman, 0.0400}, {0.0100, 0.0070, 0.0068}), 0.009);
  // Mouth: mound, upper lip, lower lip.
  head.Add(Ellipsoid(m, {0.0800, 0, 0.0100}, {0.0180, 0.0320, 0.0280}), 0.026);
  head.Add(RoundCone(m, {0.0975, 0.003, 0.0168}, {0.0850, 0.0240, 0.0112}, 0.0048 + 0.0006 * woman,
                     0.0030),
           0.008);
  head.Add(
      RoundCone(m, {0.0960, 0, 0.0038}, {0.0850, 0.0210, 0.0084}, 0.0060 + 0.0008 * woman, 0.0034),
      0.008);
  // Lines: between the lips, below the lids.
  head.Cut(RoundCone(m, {0.1035, -0.004, 0.0107}, {0.0895, 0.0245, 0.0102}, 0.0026, 0.0016),
           0.0055);
  head.Cut(RoundCone(m, {0.0895, 0.0200, 0.0700}, {0.0912, 0.0310, 0.0690}, 0.0020, 0.0016),
           0.0050);
  head.Cut(RoundCone(m, {0.0912, 0.0310, 0.0690}, {0.0855, 0.0440, 0.0705}, 0.0020, 0.0016),
           0.0050);
  // Ear: shell with its rim, bowl, lobe.
  static const Eigen::Matrix3d kEar = AxesAlong({-0.20, 0.16, 1}, {1, -0.38, 0});
  Joined ear(Ellipsoid(m, {-0.010, 0.0765, 0.0640}, {0.0165, 0.0068, 0.0290}, kEar));
  ear.Cut(Ellipsoid(m, {-0.0065, 0.0845, 0.0670}, {0.0105, 0.0052, 0.0185}, kEar), 0.004);
  ear.Add(Ellipsoid(m, {-0.0010, 0.0735, 0.0410}, {0.0070, 0.0050, 0.0090}), 0.006);
  ear.Add(Ellipsoid(m, {0.0045, 0.0760, 0.0600}, {0.0040, 0.0038, 0.0070}), 0.005);
  head.Add(ear.value(), 0.008);
  return size * head.value();
}

}  // namespace kinescope::skin
