// Laser scans and point clouds as markers.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/ros/point_colors.h"
#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

constexpr double kPointSize = 0.01;  // m

// The field by which points are coloured where they have no colours of their own, or by the style;
// "": by none, since all have one colour or that of their place.
std::string FieldOf(const ShownStyle& style) {
  if (style.color || AxisOf(style)) return "";
  return style.scale && !style.scale->by.empty() ? style.scale->by : "intensity";
}

// RViz takes the one for the other.
std::vector<std::string> NamesOf(const std::string& field) {
  if (field.empty()) return {};
  if (field == "intensity") return {field, "intensities"};
  return {field};
}

// Of many points in rows, about as many as the style allows: of each row as many, each row begins
// elsewhere, so that neither rings of a lidar nor columns of a camera are lost.
class Shares {
 public:
  Shares(std::uint64_t width, std::uint64_t height, const ShownStyle& style)
      : width_(width), height_(height), in_row_(width) {
    if (width * height <= style.most_points) return;
    if (height > style.most_points) {  // as one row
      width_ = width * height;
      height_ = 1;
    }
    in_row_ = style.most_points / height_;
  }
  std::size_t size() const { return static_cast<std::size_t>(in_row_ * height_); }
  std::size_t operator[](std::size_t i) const {
    if (in_row_ == width_) return i;
    constexpr double kGolden = 0.6180339887498949;
    const std::uint64_t row = i / in_row_, place = i % in_row_;
    const double turns = kGolden * static_cast<double>(row);
    const double begin = turns - std::floor(turns);
    const double column = (static_cast<double>(place) + begin) * static_cast<double>(width_) /
                          static_cast<double>(in_row_);
    return static_cast<std::size_t>(row * width_ +
                                    std::min(static_cast<std::uint64_t>(column), width_ - 1));
  }

 private:
  std::uint64_t width_, height_, in_row_;
};

// The axis by which the points are coloured in the frame of their message; nullopt: by none.
std::optional<int> OwnAxisOf(const ShownStyle& style) {
  return SceneAxisOf(style) ? std::nullopt : AxisOf(style);
}

double Coordinate(const geometry_msgs::Point& point, int axis) {
  return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
}

// 0xAARRGGBB; the first has no meaning here.
std_msgs::ColorRGBA ColorOfBits(std::uint32_t bits) {
  return Color(static_cast<int>(bits >> 16 & 255), static_cast<int>(bits >> 8 & 255),
               static_cast<int>(bits & 255));
}

// A number in a point of a cloud.
class CloudField {
 public:
  // nullopt: there is none of that name, or it is not within a point.
  static std::optional<CloudField> Find(const sensor_msgs::PointCloud2& cloud,
                                        const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      for (const sensor_msgs::PointField& field : cloud.fields) {
        const std::size_t size = SizeOf(field.datatype);
        if (field.name != name || size == 0 || field.count == 0) continue;
        if (std::uint64_t{field.offset} + size > cloud.point_step) continue;
        return CloudField(field);
      }
    }
    return std::nullopt;
  }

  // Why it is no coordinate of the points; "": it is one.
  static std::string WhyNoCoordinate(const sensor_msgs::PointCloud2& cloud,
                                     const std::string& name) {
    if (const auto found = Find(cloud, {name})) {
      return found->is_float() ? "" : "its field " + name + " is not of type FLOAT32";
    }
    for (const sensor_msgs::PointField& field : cloud.fields) {
      if (field.name != name) continue;
      const std::size_t size = SizeOf(field.datatype);
      if (size == 0) return fmt::format("its field {} is of no type: {}", name, field.datatype);
      if (field.count == 0) return "its field " + name + " has no number";
      return fmt::format("its field {} ends at byte {} of points of {} bytes", name,
                         std::uint64_t{field.offset} + size, cloud.point_step);
    }
    return "it has no field " + name;
  }

  // Red, green and blue from 0 to 1; empty: it has not all of them.
  static std::vector<CloudField> FindColors(const sensor_msgs::PointCloud2& cloud) {
    std::vector<CloudField> all;
    for (const char* const name : {"r", "g", "b"}) {
      const auto found = Find(cloud, {name});
      if (!found || !found->is_float()) return {};
      all.push_back(*found);
    }
    return all;
  }

  bool is_float() const { return type_ == sensor_msgs::PointField::FLOAT32; }
  std::size_t size() const { return SizeOf(type_); }

  double Number(const std::uint8_t* point) const {
    const std::uint8_t* const at = point + offset_;
    switch (type_) {
      case sensor_msgs::PointField::INT8: return Read<std::int8_t>(at);
      case sensor_msgs::PointField::UINT8: return Read<std::uint8_t>(at);
      case sensor_msgs::PointField::INT16: return Read<std::int16_t>(at);
      case sensor_msgs::PointField::UINT16: return Read<std::uint16_t>(at);
      case sensor_msgs::PointField::INT32: return Read<std::int32_t>(at);
      case sensor_msgs::PointField::UINT32: return Read<std::uint32_t>(at);
      case sensor_msgs::PointField::FLOAT32: return static_cast<double>(Read<float>(at));
      default: return Read<double>(at);
    }
  }
  // Of four bytes.
  std_msgs::ColorRGBA Packed(const std::uint8_t* point) const {
    const auto bits = Read<std::uint32_t>(point + offset_);
    std_msgs::ColorRGBA color = ColorOfBits(bits);
    if (has_alpha_) color.a = static_cast<float>(bits >> 24) / 255.0F;
    return color;
  }

 private:
  explicit CloudField(const sensor_msgs::PointField& field)
      : offset_(field.offset), type_(field.datatype), has_alpha_(field.name == "rgba") {}

  template <class T>
  static T Read(const std::uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  static std::size_t SizeOf(std::uint8_t type) {
    constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return type < std::size(kSizes) ? kSizes[type] : 0;
  }

  std::size_t offset_;
  std::uint8_t type_;
  bool has_alpha_;
};

std_msgs::ColorRGBA ColorOfShares(const std::vector<CloudField>& rgb, const std::uint8_t* point) {
  const auto level = [&](std::size_t i) {
    const double share = rgb[i].Number(point);
    return std::isfinite(share) ? static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0)))
                                : 0;
  };
  return Color(level(0), level(1), level(2));
}

// Why it cannot be read, or null.
const char* CloudDefect(const sensor_msgs::PointCloud2& cloud) {
  if (cloud.is_bigendian != 0) return "its numbers are big-endian";
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (row > cloud.row_step || std::uint64_t{cloud.row_step} * cloud.height > cloud.data.size()) {
    return "it states more points than it has";
  }
  return nullptr;
}

// 0 if its rays were measured at once, or if it does not say.
double SweepSecsOf(const sensor_msgs::LaserScan& scan) {
  constexpr double kLongest = 10;  // s; TF keeps no more
  if (scan.ranges.size() < 2) return 0;
  const double secs =
      static_cast<double>(scan.ranges.size() - 1) * static_cast<double>(scan.time_increment);
  return std::abs(secs) <= kLongest ? secs : 0;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const sensor_msgs::LaserScan& message, const ShownStyle& style) {
  Sweep sweep{SweepSecsOf(message)};
  Marker points = PointsOf(message.header, style, kPointSize);
  const bool has_intensities =
      FieldOf(style) == "intensity" && message.intensities.size() == message.ranges.size();
  const std::optional<int> axis = OwnAxisOf(style);
  const Shares shares(message.ranges.size(), 1, style);
  std::vector<double> values;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const std::size_t i = shares[k];
    const float range = message.ranges[i];
    if (!(range >= message.range_min && range <= message.range_max)) continue;
    const double angle = static_cast<double>(message.angle_min) +
                         static_cast<double>(i) * static_cast<double>(message.angle_increment);
    const auto metres = static_cast<double>(range);
    points.points.push_back(PointAt(metres * std::cos(angle), metres * std::sin(angle), 0));
    if (sweep.secs != 0) {
      sweep.shares.push_back(static_cast<float>(i) / static_cast<float>(message.ranges.size() - 1));
    }
    if (has_intensities) values.push_back(static_cast<double>(message.intensities[i]));
    if (axis) values.push_back(Coordinate(points.points.back(), *axis));
  }
  points.colors = ColorsOf(values, style);
  ShownMarkers markers = PointsOrNone(std::move(points));
  if (sweep.secs != 0) markers.front().sweep = std::make_shared<const Sweep>(std::move(sweep));
  return markers;
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::PointCloud2& message, const ShownStyle& style) {
  const auto refuse = [](const std::string& why) {
    return tl::unexpected(Refusal{"cannot be drawn", "a point cloud: " + why});
  };
  if (const char* const defect = CloudDefect(message)) return refuse(defect);
  const auto x = CloudField::Find(message, {"x"}), y = CloudField::Find(message, {"y"}),
             z = CloudField::Find(message, {"z"});
  for (const char* const name : {"x", "y", "z"}) {
    const std::string why = CloudField::WhyNoCoordinate(message, name);
    if (!why.empty()) return refuse(why);
  }
  const auto packed = CloudField::Find(message, {"rgb", "rgba"});
  const bool wants_colors = !style.color && !style.scale;
  const bool is_packed = packed && packed->size() == 4 && wants_colors;
  const std::vector<CloudField> rgb =
      is_packed || !wants_colors ? std::vector<CloudField>() : CloudField::FindColors(message);
  const bool has_colors = is_packed || !rgb.empty();
  const auto field = has_colors ? std::nullopt : CloudField::Find(message, NamesOf(FieldOf(style)));
  const std::optional<int> axis = OwnAxisOf(style);
  Marker points = PointsOf(message.header, style, kPointSize);
  std::vector<double> values;
  std::vector<std_msgs::ColorRGBA> colors;
  const Shares shares(message.width, message.height, style);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const std::uint64_t i = shares[k];
    const std::uint8_t* const point = message.data.data() + i / message.width * message.row_step +
                                      i % message.width * message.point_step;
    const geometry_msgs::Point place =
        PointAt(x->Number(point), y->Number(point), z->Number(point));
    if (!std::isfinite(place.x + place.y + place.z)) continue;  // depth cameras send many
    points.points.push_back(place);
    if (has_colors) {
      std_msgs::ColorRGBA color = is_packed ? packed->Packed(point) : ColorOfShares(rgb, point);
      const float alpha = color.a;
      color = In(style, color);
      if (style.alpha) color.a *= alpha;
      colors.push_back(color);
    }
    if (field) values.push_back(field->Number(point));
    if (axis) values.push_back(Coordinate(place, *axis));
  }
  points.colors = has_colors ? std::move(colors) : ColorsOf(values, style);
  return PointsOrNone(std::move(points));
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::PointCloud& message, const ShownStyle& style) {
  Marker points = PointsOf(message.header, style, kPointSize);
  const auto find = [&](const std::vector<std::string>& names) {
    const auto found =
        std::find_if(message.channels.begin(), message.channels.end(), [&](const auto& each) {
          return std::find(names.begin(), names.end(), each.name) != names.end() &&
                 each.values.size() == message.points.size();
        });
    return found == message.channels.end() ? nullptr : &found->values;
  };
  // A number whose bits are the colour, as in PointCloud2.
  const std::vector<float>* const packed = style.color || style.scale ? nullptr : find({"rgb"});
  const std::vector<float>* const channel =
      packed != nullptr ? nullptr : find(NamesOf(FieldOf(style)));
  std::vector<double> values;
  std::vector<std_msgs::ColorRGBA> colors;
  const std::optional<int> axis = OwnAxisOf(style);
  const Shares shares(message.points.size(), 1, style);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const std::size_t i = shares[k];
    const geometry_msgs::Point32& point = message.points[i];
    const geometry_msgs::Point place = PointAt(
        static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z));
    if (!std::isfinite(place.x + place.y + place.z)) continue;
    points.points.push_back(place);
    if (channel != nullptr) values.push_back(static_cast<double>((*channel)[i]));
    if (axis) values.push_back(Coordinate(place, *axis));
    if (packed == nullptr) continue;
    std::uint32_t bits = 0;
    std::memcpy(&bits, &(*packed)[i], sizeof bits);
    colors.push_back(In(style, ColorOfBits(bits)));
  }
  points.colors = packed != nullptr ? std::move(colors) : ColorsOf(values, style);
  return PointsOrNone(std::move(points));
}

}  // namespace kinescope::ros_bridge
