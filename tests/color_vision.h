/// Simulates colours as seen by people without red, green or blue cones.
/// Source: Machado, Oliveira, Fernandes (2009), A physiologically-based model for simulation of
/// color vision deficiency, IEEE Trans. Vis. Comput. Graph. 15(6), 1291-1298; severity 1, on linear
/// RGB.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "core/color_difference.h"

namespace kinescope::testing {

struct ColorVision {
  const char* name;
  Eigen::Matrix3d seen_from_linear;
};

inline const std::array<ColorVision, 4>& ColorVisions() {
  static const std::array<ColorVision, 4> visions = [] {
    std::array<ColorVision, 4> all{{{"normal", Eigen::Matrix3d::Identity()},
                                    {"protanopia", {}},
                                    {"deuteranopia", {}},
                                    {"tritanopia", {}}}};
    all[1].seen_from_linear << 0.152286, 1.052583, -0.204868,  //
        0.114503, 0.786281, 0.099216,                          //
        -0.003882, -0.048116, 1.051998;
    all[2].seen_from_linear << 0.367322, 0.860646, -0.227968,  //
        0.280085, 0.672501, 0.047413,                          //
        -0.011820, 0.042940, 0.968881;
    all[3].seen_from_linear << 1.255528, -0.076749, -0.178779,  //
        -0.078411, 0.930809, 0.147602,                          //
        0.004733, 0.691367, 0.303900;
    return all;
  }();
  return visions;
}

inline Rgb SeenBy(const ColorVision& vision, const Rgb& color) {
  const Eigen::Vector3d linear(ToLinear(color[0]), ToLinear(color[1]), ToLinear(color[2]));
  const Eigen::Vector3d seen = (vision.seen_from_linear * linear).cwiseMax(0).cwiseMin(1);
  return {ToEncoded(seen.x()), ToEncoded(seen.y()), ToEncoded(seen.z())};
}

}  // namespace kinescope::testing
