#include "server/ros/image_messages.h"

#include <ros/message_traits.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>

#include "core/picture_limits.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

std::string Md5OfImage() { return ros::message_traits::md5sum<sensor_msgs::Image>(); }
std::string Md5OfFile() { return ros::message_traits::md5sum<sensor_msgs::CompressedImage>(); }

// The members before the pixels, and where those are, as the messages have them.
void ReadMembers(bool is_file, BoundedStream& stream, CameraImage& image) {
  std_msgs::Header header;
  stream.next(header);
  image.stamp_nanos = static_cast<std::int64_t>(header.stamp.toNSec());
  if (is_file) {
    stream.next(image.encoding);  // "16UC1; compressedDepth png", for one
  } else {
    std::uint32_t width = 0, height = 0, step = 0;
    std::uint8_t is_bigendian = 0;
    stream.next(height);
    stream.next(width);
    stream.next(image.encoding);
    stream.next(is_bigendian);
    stream.next(step);
    image.width = Side(width);
    image.height = Side(height);
    image.is_bigendian = is_bigendian != 0;
    image.row_bytes = step;
  }
  std::uint32_t count = 0;
  stream.next(count);
  image.begin = image.bytes->size() - stream.getLength();
  image.size = count;
  static_cast<void>(stream.advance(count));
}

bool BeginsWith(const CameraImage& image, std::initializer_list<std::uint8_t> begin) {
  return image.size > begin.size() &&
         std::equal(begin.begin(), begin.end(),
                    image.bytes->begin() + static_cast<std::ptrdiff_t>(image.begin));
}

// Of the size that a PNG begins with.
std::string WhyTooLarge(const CameraImage& png) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20, kSizeOfNumber = 4;
  if (png.size < kHeightAt + kSizeOfNumber) return "";
  const auto number_at = [&](std::size_t place) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < kSizeOfNumber; ++i) {
      number = number << 8U | (*png.bytes)[png.begin + place + i];
    }
    return number;
  };
  const std::uint64_t width = number_at(kWidthAt), height = number_at(kHeightAt);
  if (width * height <= kMostUnpackedPixels) return "";
  return fmt::format("a PNG of {} x {} px; at most {} px are unpacked", width, height,
                     kMostUnpackedPixels);
}

// Says what kind of file it is, by its first bytes; its `encoding` is the format that was stated.
// Or why it cannot be shown.
std::string TakeFile(CameraImage& image) {
  // compressed_depth_image_transport has three numbers before the picture; of floating-point
  // depths, a picture of their inverse.
  constexpr std::size_t kDepthHead = 12;
  const std::string format = std::exchange(image.encoding, "");
  if (format.find("compressedDepth") != std::string::npos) {
    if (format.compare(0, 5, "16UC1") != 0 || image.size < kDepthHead) {
      return "a compressed depth image that is not of 16UC1";
    }
    image.begin += kDepthHead;
    image.size -= kDepthHead;
  }
  if (BeginsWith(image, {0xff, 0xd8, 0xff})) image.encoding = "jpeg";
  if (BeginsWith(image, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'})) {
    image.encoding = "png";
    return WhyTooLarge(image);
  }
  return image.encoding.empty() ? "a compressed image that is neither JPEG nor PNG" : "";
}

}  // namespace

int Side(std::uint32_t px) {
  return static_cast<int>(
      std::min(px, static_cast<std::uint32_t>(std::numeric_limits<int>::max())));
}

bool IsImageType(const std::string& md5sum) {
  return md5sum == Md5OfImage() || md5sum == Md5OfFile();
}

Taken<CameraImage> ReadImage(const std::string& md5sum,
                             std::shared_ptr<const std::vector<std::uint8_t>> bytes) {
  CameraImage image;
  image.bytes = std::move(bytes);
  const bool is_file = md5sum == Md5OfFile();
  bool is_whole = image.bytes->size() <= kLargestMessage;
  if (is_whole) {
    try {
      BoundedStream stream(image.bytes->data(), static_cast<std::uint32_t>(image.bytes->size()));
      ReadMembers(is_file, stream, image);
    } catch (const ros::serialization::StreamOverrunException&) {
      is_whole = false;
    }
  }
  if (!is_whole) return tl::unexpected(Unreadable());
  if (is_file) {
    std::string defect = TakeFile(image);
    if (!defect.empty()) return tl::unexpected(Refusal{"cannot be drawn", std::move(defect)});
  }
  const std::string defect = FindDefect(image);
  if (!defect.empty()) return tl::unexpected(Refusal{"cannot be drawn", "an image: " + defect});
  return image;
}

}  // namespace kinescope::ros_bridge
