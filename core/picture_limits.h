/// Size and rate of pictures, as renderer, options and page have them in common.
#pragma once

#include <array>
#include <cstdint>

namespace kinescope {

inline constexpr int kMinPictureSide = 16, kMaxPictureSide = 8192;              // px
inline constexpr int kDefaultPictureWidth = 1280, kDefaultPictureHeight = 720;  // px
inline constexpr double kMinPictureRateHz = 0.1, kMaxPictureRateHz = 240;
inline constexpr double kDefaultPictureRateHz = 30;

/// Of a PNG from elsewhere, such as a camera's image or a texture: one with more is not unpacked.
/// 4096 x 4096
inline constexpr std::uint64_t kMostUnpackedPixels = 1U << 24U;

/// Pixels that are drawn per pixel of the picture, in each direction.
inline constexpr std::array<int, 3> kSupersampleFactors = {1, 2, 4};

}  // namespace kinescope
