#include "core/camera_image.h"

#include <algorithm>
#include <cmath>

#include "core/system/starts_with.h"
#include "core/system/utf8.h"

namespace kinescope {
namespace {

constexpr int kMostSide = 16'384;         // px
constexpr std::size_t kLongestName = 40;  // bytes of an encoding in a message

// Of the larger side of the image: fields of view of about 157 and 0.6 degrees.
constexpr double kLeastFocal = 0.1, kMostFocal = 100;
constexpr double kMostAnamorphic = 0.1;  // a difference, of the focal length

}  // namespace

std::optional<PixelFormat> FormatOf(const std::string& encoding) {
  using Kind = PixelFormat::Kind;
  if (encoding == "rgb8") return PixelFormat{Kind::kRgb, 3, {0, 1, 2}};
  if (encoding == "bgr8" || encoding == "8UC3") return PixelFormat{Kind::kRgb, 3, {2, 1, 0}};
  if (encoding == "rgba8") return PixelFormat{Kind::kRgb, 4, {0, 1, 2}};
  if (encoding == "bgra8" || encoding == "8UC4") return PixelFormat{Kind::kRgb, 4, {2, 1, 0}};
  const bool is_bayer = StartsWith(encoding, "bayer_") && EndsWith(encoding, "8");
  if (encoding == "mono8" || encoding == "8UC1" || is_bayer) return PixelFormat{Kind::kGrey8, 1};
  if (encoding == "mono16" || encoding == "16UC1") return PixelFormat{Kind::kNumber, 2};
  if (encoding == "16SC1") return PixelFormat{Kind::kNumber, 2, {}, false, true};
  if (encoding == "32FC1") return PixelFormat{Kind::kNumber, 4, {}, true};
  if (encoding == "yuv422") return PixelFormat{Kind::kUyvy, 2};
  if (encoding == "yuv422_yuy2") return PixelFormat{Kind::kYuyv, 2};
  return std::nullopt;
}

bool IsFile(const CameraImage& image) {
  return image.encoding == "jpeg" || image.encoding == "png";
}

std::string FindDefect(const ImageCamera& camera) {
  const auto [focal_x, focal_y] = camera.focal_px;
  const auto [center_x, center_y] = camera.center_px;
  const auto is_side = [](int px) { return px > 0 && px <= kMostSide; };
  if (!is_side(camera.width) || !is_side(camera.height)) {
    return "it was calibrated for " + std::to_string(camera.width) + " x " +
           std::to_string(camera.height) + " px";
  }
  if (!(std::isfinite(focal_x) && std::isfinite(focal_y) && focal_x > 0 && focal_y > 0)) {
    return "its focal lengths are not positive";
  }
  if (std::abs(focal_x - focal_y) > kMostAnamorphic * focal_y) {
    return "its focal lengths differ by more than a tenth";
  }
  const double largest_side = std::max(camera.width, camera.height);
  if (focal_y < kLeastFocal * largest_side || focal_y > kMostFocal * largest_side) {
    return "its focal length is not that of a pinhole camera";
  }
  const auto is_near = [](double center, int side) {
    return center >= -0.5 * side && center <= 1.5 * side;  // not NaN
  };
  if (!is_near(center_x, camera.width) || !is_near(center_y, camera.height)) {
    return "its axis is far from its image";
  }
  const urdf::Pose& pose = camera.world_from_optical;
  if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) {
    return "its place is not finite";
  }
  return "";
}

std::string FindDefect(const CameraImage& image) {
  if (image.bytes == nullptr || image.size == 0) return "no pixels";
  if (image.begin > image.bytes->size() || image.size > image.bytes->size() - image.begin) {
    return "it states more bytes than it has";
  }
  if (IsFile(image)) return "";
  const auto format = FormatOf(image.encoding);
  if (!format) {
    return "encoding '" + PrintableLine(image.encoding.substr(0, kLongestName)) +
           "': expected rgb8, bgr8, rgba8, bgra8, bayer_..8, mono8, mono16, 8UC1, 8UC3, 8UC4, "
           "16UC1, 32FC1, yuv422, JPEG or PNG";
  }
  if (image.width <= 0 || image.height <= 0 || image.width > kMostSide ||
      image.height > kMostSide) {
    return std::to_string(image.width) + " x " + std::to_string(image.height) +
           " px: expected 1 to " + std::to_string(kMostSide) + " each";
  }
  const bool is_in_pairs =
      format->kind == PixelFormat::Kind::kUyvy || format->kind == PixelFormat::Kind::kYuyv;
  const auto columns = static_cast<std::size_t>(image.width) + (is_in_pairs ? image.width % 2 : 0);
  const std::size_t row = columns * format->bytes;
  const auto rows = static_cast<std::size_t>(image.height);
  if (image.row_bytes < row || image.row_bytes > image.size ||
      (rows - 1) * image.row_bytes + row > image.size) {
    return "it states more pixels than it has";
  }
  return "";
}

double ProportionsOf(const CameraImage& image) {
  constexpr double kOfFiles = 4.0 / 3, kMost = 4;
  if (image.width <= 0 || image.height <= 0) return kOfFiles;
  return std::clamp(static_cast<double>(image.width) / image.height, 1 / kMost, kMost);
}

bool IsOld(const CameraImage& image, std::int64_t now_nanos) {
  constexpr std::int64_t kOldNanos = 1'500'000'000;
  return image.received_nanos != 0 && now_nanos - image.received_nanos > kOldNanos;
}

}  // namespace kinescope
