#include "server/ros/depth_clouds.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace kinescope::ros_bridge {
namespace {

constexpr float kMetresPerMillimetre = 0.001f;
constexpr double kSmallestPoint = 0.001, kLargestPoint = 1;  // m

// As CloudField reads them: x, y, z, and 0xAARRGGBB.
struct DepthPoint {
  float x, y, z;
  std::uint32_t rgb;
};

std::uint32_t Swapped(std::uint32_t value, std::size_t bytes) {
  return bytes == 2 ? (value >> 8 & 0xff) | (value & 0xff) << 8 : __builtin_bswap32(value);
}

const std::uint8_t* PixelAt(const CameraImage& image, const PixelFormat& format, int x, int y) {
  return image.bytes->data() + image.begin + static_cast<std::size_t>(y) * image.row_bytes +
         static_cast<std::size_t>(x) * format.bytes;
}

// m; NaN or not positive: none.
class Depths {
 public:
  Depths(const CameraImage& image, const PixelFormat& format) : image_(image), format_(format) {}

  float At(int x, int y) const {
    const std::uint8_t* const pixel = PixelAt(image_, format_, x, y);
    std::uint32_t bits = 0;
    std::memcpy(&bits, pixel, format_.bytes);  // of a little-endian machine
    if (image_.is_bigendian) bits = Swapped(bits, format_.bytes);
    if (!format_.is_float) return kMetresPerMillimetre * static_cast<float>(bits);
    float metres = 0;
    std::memcpy(&metres, &bits, sizeof metres);
    return metres;
  }

 private:
  const CameraImage& image_;
  const PixelFormat format_;
};

std::uint32_t ColorAt(const CameraImage& image, const PixelFormat& format, int x, int y) {
  const std::uint8_t* const pixel = PixelAt(image, format, x, y);
  const auto part = [&](std::size_t i) {
    return std::uint32_t{pixel[format.kind == PixelFormat::Kind::kRgb ? format.rgb[i] : 0]};
  };
  return part(0) << 16 | part(1) << 8 | part(2);
}

sensor_msgs::PointField FieldAt(const char* name, std::size_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = static_cast<std::uint32_t>(offset);
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  return field;
}

tl::unexpected<Refusal> RefuseImage(const std::string& why) {
  return tl::unexpected(Refusal{"cannot be drawn", why});
}

// So that the points of `image` are no more than `most`.
int GridStep(const CameraImage& image, std::size_t most) {
  const double pixels = 1.0 * image.width * image.height;
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / static_cast<double>(most)))));
}

double MedianDepth(const std::vector<DepthPoint>& points) {
  std::vector<float> depths;
  depths.reserve(points.size());
  for (const DepthPoint& point : points) depths.push_back(point.z);
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

sensor_msgs::PointCloud2 CloudOf(const std::vector<DepthPoint>& points,
                                 const std_msgs::Header& header, bool has_colors) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.fields = {FieldAt("x", offsetof(DepthPoint, x)), FieldAt("y", offsetof(DepthPoint, y)),
                  FieldAt("z", offsetof(DepthPoint, z))};
  if (has_colors) cloud.fields.push_back(FieldAt("rgb", offsetof(DepthPoint, rgb)));
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.point_step = sizeof(DepthPoint);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(points.size() * sizeof(DepthPoint));
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  return cloud;
}

}  // namespace

void DepthClouds::PutCalibration(std::size_t topic, const Calibration& calibration) {
  topics_[topic].calibration = calibration;
}

std::optional<Refusal> DepthClouds::PutColors(std::size_t topic, CameraImage image) {
  const auto format = FormatOf(image.encoding);
  const bool is_known = format && (format->kind == PixelFormat::Kind::kRgb ||
                                   format->kind == PixelFormat::Kind::kGrey8);
  if (!is_known) {
    return Refusal{"colours that cannot be used",
                   "an image of colours: expected rgb8, bgr8, rgba8, bgra8 or mono8"};
  }
  topics_[topic].colors = std::move(image);
  return std::nullopt;
}

Taken<ShownMarkers> DepthClouds::ToMarkers(std::size_t topic, const CameraImage& depths,
                                           const std_msgs::Header& header,
                                           const ShownStyle& style) const {
  const auto format = FormatOf(depths.encoding);
  const bool is_depth = format && format->kind == PixelFormat::Kind::kNumber && !format->is_signed;
  if (!is_depth) return RefuseImage("an image of depths: expected 16UC1 or 32FC1");
  const auto known = topics_.find(topic);
  if (known == topics_.end() || !known->second.calibration) {
    Refusal refusal{"no calibration yet",
                    "an image of depths: no calibration on camera_info beside it"};
    refusal.may_come = true;
    return tl::unexpected(std::move(refusal));
  }
  const ImageCamera& camera = known->second.calibration->camera;
  const CameraImage* colors = known->second.colors ? &*known->second.colors : nullptr;
  if (colors != nullptr && (colors->width != depths.width || colors->height != depths.height)) {
    return RefuseImage("an image of depths: that of its colours has another size");
  }
  const auto color_format = colors != nullptr ? FormatOf(colors->encoding) : std::nullopt;
  // The calibration may be that of a larger image.
  const double scale_x = static_cast<double>(depths.width) / camera.width,
               scale_y = static_cast<double>(depths.height) / camera.height;
  const double focal_x = scale_x * camera.focal_px[0], focal_y = scale_y * camera.focal_px[1];
  const Depths metres(depths, *format);
  const int step = GridStep(depths, style.most_points);
  std::vector<DepthPoint> points;
  for (int y = 0; y < depths.height; y += step) {
    for (int x = 0; x < depths.width; x += step) {
      const float depth = metres.At(x, y);
      if (!(depth > 0) || !std::isfinite(depth)) continue;
      const auto along = static_cast<double>(depth);
      points.push_back({static_cast<float>((x - scale_x * camera.center_px[0]) / focal_x * along),
                        static_cast<float>((y - scale_y * camera.center_px[1]) / focal_y * along),
                        depth, color_format ? ColorAt(*colors, *color_format, x, y) : 0});
    }
  }
  ShownStyle sized = style;
  if (!sized.size_m && !points.empty()) {
    sized.size_m = std::clamp(step * MedianDepth(points) / focal_x, kSmallestPoint, kLargestPoint);
  }
  return ros_bridge::ToMarkers(CloudOf(points, header, color_format.has_value()), sized);
}

}  // namespace kinescope::ros_bridge
