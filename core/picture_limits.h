/// Size and rate of pictures, as renderer, options and page have them in common.
#pragma once

#include <array>

namespace kinescope {

inline constexpr int kMinPictureSide = 16, kMaxPictureSide = 8192;              // px
inline constexpr int kDefaultPictureWidth = 1280, kDefaultPictureHeight = 720;  // px
inline constexpr double kMinPictureRateHz = 0.1, kMaxPictureRateHz = 240;
inline constexpr double kDefaultPictureRateHz = 30;

/// Pixels that are drawn per pixel of the picture, in each direction.
inline constexpr std::array<int, 3> kSupersampleFactors = {1, 2, 4};

}  // namespace kinescope
