#include "server/app/serve/camera_files.h"

#include <algorithm>

#include "render/image/camera_picture.h"
#include "render/image/png_file.h"

namespace kinescope::app {
namespace {

constexpr int kMostWidth = 640, kMostHeight = 480;  // px
constexpr int kQuality = 85;
constexpr std::size_t kSmallFile = 200'000;  // bytes

std::shared_ptr<const std::string> FileOf(const CameraImage& image) {
  if (image.encoding == "jpeg" && image.size <= kSmallFile) {
    const auto first = image.bytes->begin() + static_cast<std::ptrdiff_t>(image.begin);
    return std::make_shared<const std::string>(first,
                                               first + static_cast<std::ptrdiff_t>(image.size));
  }
  const int width = image.width > 0 ? std::min(image.width, kMostWidth) : kMostWidth;
  const int height = image.height > 0 ? std::min(image.height, kMostHeight) : kMostHeight;
  const auto pixels = render::DecodeCameraImage(image, width, height);
  if (!pixels) return nullptr;
  const std::vector<std::uint8_t> bytes = render::EncodeJpeg(*pixels, kQuality);
  return std::make_shared<const std::string>(bytes.begin(), bytes.end());
}

}  // namespace

std::shared_ptr<const std::string> CameraFiles::Of(
    std::size_t number, const std::shared_ptr<const CameraImage>& image) {
  if (made_.size() <= number) made_.resize(number + 1);
  Made& made = made_[number];
  if (made.of != image) made = {image, FileOf(*image)};
  return made.file;
}

}  // namespace kinescope::app
