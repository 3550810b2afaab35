#include "render/image/camera_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "render/image/png_file.h"

namespace kinescope::render {
namespace {

using Rgb8 = std::array<int, 3>;

std::uint8_t Byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

// The pixels of an image that has no defect.
class Pixels {
 public:
  explicit Pixels(const CameraImage& image)
      : image_(image),
        format_(*FormatOf(image.encoding)),
        first_(image.bytes->data() + image.begin) {
    if (format_.kind == PixelFormat::Kind::kNumber) FindRange();
  }

  Rgb8 At(int x, int y) const {
    const std::uint8_t* const row = first_ + static_cast<std::size_t>(y) * image_.row_bytes;
    const std::uint8_t* const at = row + static_cast<std::size_t>(x) * format_.bytes;
    switch (format_.kind) {
      case PixelFormat::Kind::kRgb:
        return {at[format_.rgb[0]], at[format_.rgb[1]], at[format_.rgb[2]]};
      case PixelFormat::Kind::kGrey8: return {at[0], at[0], at[0]};
      case PixelFormat::Kind::kUyvy: return OfYuv(row, x, 1);
      case PixelFormat::Kind::kYuyv: return OfYuv(row, x, 0);
      case PixelFormat::Kind::kNumber: break;
    }
    const double number = Number(at);
    if (std::isnan(number) || most_ < least_) return {0, 0, 0};
    // Infinite is farther than all else, as depth cameras mean it.
    const double share = most_ > least_   ? (number - least_) / (most_ - least_)
                         : number > most_ ? 1
                                          : 0;
    const int grey = Byte(255 * share);
    return {grey, grey, grey};
  }

 private:
  double Number(const std::uint8_t* at) const {
    std::array<std::uint8_t, 4> bytes = {};
    std::copy(at, at + format_.bytes, bytes.begin());
    if (image_.is_bigendian) std::reverse(bytes.begin(), bytes.begin() + format_.bytes);
    if (format_.is_float) {
      float value = 0;
      std::memcpy(&value, bytes.data(), sizeof value);
      return static_cast<double>(value);
    }
    const auto value = static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
    return format_.is_signed ? static_cast<std::int16_t>(value) : value;
  }

  // Of a large picture every n-th pixel each way: enough for a range.
  void FindRange() {
    constexpr int kAllUpTo = 1000;  // px
    const int step = 1 + std::max(image_.width, image_.height) / kAllUpTo;
    least_ = std::numeric_limits<double>::infinity();
    most_ = -least_;
    for (int y = 0; y < image_.height; y += step) {
      for (int x = 0; x < image_.width; x += step) {
        const double number = Number(first_ + static_cast<std::size_t>(y) * image_.row_bytes +
                                     static_cast<std::size_t>(x) * format_.bytes);
        if (!std::isfinite(number)) continue;
        least_ = std::min(least_, number);
        most_ = std::max(most_, number);
      }
    }
  }

  // Two pixels share their colour differences. ITU-R BT.601, full range as cameras send it.
  Rgb8 OfYuv(const std::uint8_t* row, int x, std::size_t luma) const {
    const std::uint8_t* const pair = row + 4 * static_cast<std::size_t>(x / 2);
    const double y = pair[luma + 2 * static_cast<std::size_t>(x % 2)];
    const double u = pair[1 - luma] - 128.0, v = pair[3 - luma] - 128.0;
    return {Byte(y + 1.402 * v), Byte(y - 0.344136 * u - 0.714136 * v), Byte(y + 1.772 * u)};
  }

  const CameraImage& image_;
  const PixelFormat format_;
  const std::uint8_t* const first_;
  double least_ = 0, most_ = 0;  // of kNumber
};

// As large as it may be.
Image SizedFor(int width, int height, int most_width, int most_height) {
  const double share =
      std::min(static_cast<double>(most_width) / width, static_cast<double>(most_height) / height);
  Image out;
  SetSize(out, std::max(1, static_cast<int>(std::lround(share * width))),
          std::max(1, static_cast<int>(std::lround(share * height))));
  out.is_opaque = true;
  return out;
}

// Averages up to 4 x 4 pixels for each one, or repeats pixels.
Image Resized(const CameraImage& image, int most_width, int most_height) {
  constexpr int kMostSamples = 4;
  const Pixels pixels(image);
  Image out = SizedFor(image.width, image.height, most_width, most_height);
  const auto begin = [](int at, int from, int to) {
    return static_cast<int>(std::int64_t{at} * from / to);
  };
  std::size_t next = 0;
  for (int y = 0; y < out.height; ++y) {
    const int top = begin(y, image.height, out.height);
    const int rows = std::max(1, begin(y + 1, image.height, out.height) - top);
    for (int x = 0; x < out.width; ++x) {
      const int left = begin(x, image.width, out.width);
      const int columns = std::max(1, begin(x + 1, image.width, out.width) - left);
      const int across = std::min(columns, kMostSamples), down = std::min(rows, kMostSamples);
      Rgb8 sum = {};
      for (int j = 0; j < down; ++j) {
        for (int i = 0; i < across; ++i) {
          const Rgb8 one = pixels.At(left + i * columns / across, top + j * rows / down);
          for (std::size_t k = 0; k < 3; ++k) sum[k] += one[k];
        }
      }
      const int count = across * down;
      for (const int channel : sum) {
        out.rgba[next++] = static_cast<std::uint8_t>((channel + count / 2) / count);
      }
      out.rgba[next++] = 255;
    }
  }
  return out;
}

CameraImage WholeOf(std::vector<std::uint8_t> pixels, int width, int height, const char* encoding) {
  CameraImage whole;
  whole.width = width;
  whole.height = height;
  whole.encoding = encoding;
  whole.size = pixels.size();
  whole.row_bytes = whole.size / static_cast<std::size_t>(height);
  whole.bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(pixels));
  return whole;
}

CameraImage OfJpeg(const CameraImage& file, int enough_px) {
  Image pixels = ReadJpeg(file.bytes->data() + file.begin, file.size, enough_px);
  return WholeOf(std::move(pixels.rgba), pixels.width, pixels.height, "rgba8");
}

CameraImage OfPng(const CameraImage& file) {
  PngPixels pixels = ReadPngPixels(file.bytes->data() + file.begin, file.size);
  return WholeOf(std::move(pixels.bytes), pixels.width, pixels.height,
                 pixels.is_grey16 ? "mono16" : "rgba8");
}

}  // namespace

tl::expected<Image, std::string> DecodeCameraImage(const CameraImage& image, int width,
                                                   int height) {
  const std::string defect = FindDefect(image);
  if (!defect.empty()) return tl::unexpected(defect);
  if (!IsFile(image)) return Resized(image, width, height);
  try {
    return Resized(image.encoding == "png" ? OfPng(image) : OfJpeg(image, std::max(width, height)),
                   width, height);
  } catch (const std::runtime_error& error) {
    return tl::unexpected(std::string(error.what()));
  }
}

}  // namespace kinescope::render
