#include "server/ros/image_messages.h"

#include <ros/message_traits.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

std::string Md5OfImage() { return ros::message_traits::md5sum<sensor_msgs::Image>(); }
std::string Md5OfFile() { return ros::message_traits::md5sum<sensor_msgs::CompressedImage>(); }

int Side(std::uint32_t px) {
  return static_cast<int>(
      std::min(px, static_cast<std::uint32_t>(std::numeric_limits<int>::max())));
}

// The members before the pixels, and where those are, as the messages have them.
void ReadMembers(bool is_file, BoundedStream& stream, CameraImage& image) {
  std_msgs::Header header;
  stream.next(header);
  if (is_file) {
    std::string format;
    stream.next(format);
    image.encoding = "jpeg";
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

bool IsJpeg(const CameraImage& image) {
  const std::uint8_t* const at = image.bytes->data() + image.begin;
  return image.size > 3 && at[0] == 0xff && at[1] == 0xd8 && at[2] == 0xff;
}

}  // namespace

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
  if (is_file && !IsJpeg(image)) {
    return tl::unexpected(Refusal{"cannot be drawn", "a compressed image that is no JPEG"});
  }
  const std::string defect = FindDefect(image);
  if (!defect.empty()) return tl::unexpected(Refusal{"cannot be drawn", "an image: " + defect});
  return image;
}

}  // namespace kinescope::ros_bridge
