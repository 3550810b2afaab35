#include "server/ros/shown_messages.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "core/scene_marker.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

constexpr double kPointSize = 0.01;  // m

std_msgs::ColorRGBA Color(int red, int green, int blue) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red) / 255;
  color.g = static_cast<float>(green) / 255;
  color.b = static_cast<float>(blue) / 255;
  color.a = 1;
  return color;
}

// `color`, unless the style has another one.
std_msgs::ColorRGBA In(const ShownStyle& style, std_msgs::ColorRGBA color) {
  if (style.color) {
    color.r = static_cast<float>((*style.color)[0]);
    color.g = static_cast<float>((*style.color)[1]);
    color.b = static_cast<float>((*style.color)[2]);
  }
  if (style.alpha) color.a = static_cast<float>(*style.alpha);
  return color;
}

Marker MarkerOf(const std_msgs::Header& header, int id, int type,
                const std_msgs::ColorRGBA& color) {
  Marker marker;
  marker.header = header;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.color = color;
  return marker;
}

Marker Without(const std_msgs::Header& header, int id) {
  Marker marker;
  marker.header = header;
  marker.id = id;
  marker.action = Marker::DELETE;
  return marker;
}

geometry_msgs::Point PointAt(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

tl::unexpected<Refusal> TooLarge(const char* what, std::size_t count, std::size_t most) {
  return tl::unexpected(
      Refusal{"too large", fmt::format("{} {}: expected at most {}", count, what, most)});
}

// rviz/default_plugin/point_cloud_transformers.cpp: saturated hues through six stops; the smallest
// value is red and the largest magenta.
std_msgs::ColorRGBA Rainbow(double share) {
  static constexpr std::array<std::array<float, 3>, 6> kStops = {
      {{1, 0, 1}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}};
  const double at = 5 * std::clamp(1 - share, 0.0, 1.0);
  const auto first = std::min(static_cast<std::size_t>(at), std::size_t{4});
  const auto part = static_cast<float>(at - static_cast<double>(first));
  const auto channel = [&](std::size_t i) {
    return (1 - part) * kStops[first][i] + part * kStops[first + 1][i];
  };
  std_msgs::ColorRGBA color;
  color.r = channel(0);
  color.g = channel(1);
  color.b = channel(2);
  color.a = 1;
  return color;
}

// One colour for each value, between the smallest and the largest of them.
std::vector<std_msgs::ColorRGBA> RainbowOf(const std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  std::vector<std_msgs::ColorRGBA> colors;
  colors.reserve(values.size());
  for (const double value : values) {
    const bool is_known = std::isfinite(value) && most > least;
    colors.push_back(Rainbow(is_known ? (value - least) / (most - least) : 0));
  }
  return colors;
}

Marker PointsOf(const std_msgs::Header& header, const ShownStyle& style) {
  Marker marker = MarkerOf(header, 0, Marker::POINTS, In(style, Color(255, 255, 255)));
  marker.scale.x = marker.scale.y = marker.scale.z = style.size_m.value_or(kPointSize);
  return marker;
}

// What each point has, unless all have one colour.
void Colour(Marker& points, std::vector<std_msgs::ColorRGBA> colors, const ShownStyle& style) {
  if (style.color) return;
  for (std_msgs::ColorRGBA& color : colors) color = In(style, color);
  points.colors = std::move(colors);
}

ShownMarkers OneOrNone(Marker marker) {
  if (marker.points.empty()) return {Without(marker.header, marker.id)};
  return {std::move(marker)};
}

std::size_t StepOf(std::uint64_t points) {
  return static_cast<std::size_t>((points + kMostCloudPoints - 1) / kMostCloudPoints);
}

// A number in a point of a cloud.
class CloudField {
 public:
  // nullopt: there is none of that name, or it is not within a point.
  static std::optional<CloudField> Find(const sensor_msgs::PointCloud2& cloud,
                                        std::initializer_list<const char*> names) {
    for (const char* name : names) {
      for (const sensor_msgs::PointField& field : cloud.fields) {
        const std::size_t size = SizeOf(field.datatype);
        if (field.name != name || size == 0 || field.count == 0) continue;
        if (std::uint64_t{field.offset} + size > cloud.point_step) continue;
        return CloudField(field);
      }
    }
    return std::nullopt;
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
  // Of four bytes: 0xAARRGGBB.
  std_msgs::ColorRGBA Packed(const std::uint8_t* point) const {
    const auto bits = Read<std::uint32_t>(point + offset_);
    return Color(static_cast<int>(bits >> 16 & 255), static_cast<int>(bits >> 8 & 255),
                 static_cast<int>(bits & 255));
  }

 private:
  explicit CloudField(const sensor_msgs::PointField& field)
      : offset_(field.offset), type_(field.datatype) {}

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
};

// Why it cannot be read, or null.
const char* DefectOf(const sensor_msgs::PointCloud2& cloud) {
  if (cloud.is_bigendian != 0) return "its numbers are big-endian";
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (row > cloud.row_step || std::uint64_t{cloud.row_step} * cloud.height > cloud.data.size()) {
    return "it states more points than it has";
  }
  return nullptr;
}

template <class Message>
Taken<ShownMarkers> OfBytes(const std::vector<std::uint8_t>& bytes, const ShownStyle& style) {
  Message message;
  if (!ReadBounded(bytes.data(), bytes.size(), message)) {
    return tl::unexpected(
        Refusal{"unreadable", "a message that is truncated or has a wrong length field"});
  }
  return ToMarkers(message, style);
}

struct ShownType {
  const char* name;
  const char* md5sum;
  ToMarkersOfBytes to_markers;
};

template <class Message>
ShownType TypeOf() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(),
          OfBytes<Message>};
}

const std::array<ShownType, 7>& ShownTypes() {
  static const std::array<ShownType, 7> kTypes = {
      TypeOf<geometry_msgs::PointStamped>(),  TypeOf<geometry_msgs::PoseStamped>(),
      TypeOf<geometry_msgs::PoseArray>(),     TypeOf<nav_msgs::Path>(),
      TypeOf<geometry_msgs::WrenchStamped>(), TypeOf<sensor_msgs::LaserScan>(),
      TypeOf<sensor_msgs::PointCloud2>()};
  return kTypes;
}

Marker ArrowOf(const std_msgs::Header& header, int id, const std_msgs::ColorRGBA& color,
               const geometry_msgs::Vector3& vector, double metres_per_unit) {
  Marker arrow = MarkerOf(header, id, Marker::ARROW, color);
  const double x = metres_per_unit * vector.x, y = metres_per_unit * vector.y,
               z = metres_per_unit * vector.z;
  arrow.points = {PointAt(0, 0, 0), PointAt(x, y, z)};
  arrow.scale.x = 0.018;  // diameters, as arrows of ground reaction forces (force_arrows)
  arrow.scale.y = 0.048;
  arrow.scale.z = std::min(0.06, 0.6 * std::hypot(x, y, z));
  return arrow;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PointStamped& message, const ShownStyle& style) {
  Marker sphere = MarkerOf(message.header, 0, Marker::SPHERE, In(style, Color(204, 41, 204)));
  sphere.pose.position = message.point;
  sphere.scale.x = sphere.scale.y = sphere.scale.z = 2 * style.size_m.value_or(0.2);
  return ShownMarkers{sphere};
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseStamped& message, const ShownStyle& style) {
  constexpr double kLength = 1.3;
  const double length = style.size_m.value_or(kLength), share = length / kLength;
  Marker arrow = MarkerOf(message.header, 0, Marker::ARROW, In(style, Color(255, 25, 0)));
  arrow.pose = message.pose;
  arrow.points = {PointAt(0, 0, 0), PointAt(length, 0, 0)};
  arrow.scale.x = 0.05 * share;  // RViz's "radius" is a diameter
  arrow.scale.y = 0.1 * share;
  arrow.scale.z = 0.3 * share;
  return ShownMarkers{arrow};
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseArray& message, const ShownStyle& style) {
  const double length = style.size_m.value_or(0.3);
  constexpr std::size_t kCorners = 6;
  if (message.poses.size() > kMaxMarkerPoints / kCorners) {
    return TooLarge("poses", message.poses.size(), kMaxMarkerPoints / kCorners);
  }
  Marker lines = MarkerOf(message.header, 0, Marker::LINE_LIST, In(style, Color(255, 25, 0)));
  lines.scale.x = 0.006;
  for (const geometry_msgs::Pose& pose : message.poses) {
    const Eigen::Vector3d at(pose.position.x, pose.position.y, pose.position.z);
    Eigen::Quaterniond turn(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                            pose.orientation.z);
    if (turn.norm() == 0) turn.setIdentity();
    turn.normalize();
    const auto corner = [&](double x, double y) {
      const Eigen::Vector3d place = at + turn * Eigen::Vector3d(length * x, length * y, 0);
      lines.points.push_back(PointAt(place.x(), place.y(), place.z()));
    };
    corner(0, 0);
    corner(1, 0);
    for (const double side : {1.0, -1.0}) {
      corner(1, 0);
      corner(0.75, 0.2 * side);
    }
  }
  return OneOrNone(std::move(lines));
}

Taken<ShownMarkers> ToMarkers(const nav_msgs::Path& message, const ShownStyle& style) {
  if (message.poses.size() > kMaxMarkerPoints) {
    return TooLarge("poses", message.poses.size(), kMaxMarkerPoints);
  }
  Marker line = MarkerOf(message.header, 0, Marker::LINE_STRIP, In(style, Color(25, 255, 0)));
  line.scale.x = style.size_m.value_or(0.02);
  for (const geometry_msgs::PoseStamped& each : message.poses) {
    line.points.push_back(each.pose.position);
  }
  if (line.points.size() == 1) line.points.clear();  // no line
  return OneOrNone(std::move(line));
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::WrenchStamped& message,
                              const ShownStyle& style) {
  constexpr double kLeastForce = 5, kLeastTorque = 0.5;  // N, N·m
  constexpr double kMetresPerNewton = 1e-3, kMetresPerNewtonMetre = 1e-2;
  const auto shown = [&](int id, const geometry_msgs::Vector3& vector, double least, double metres,
                         const std_msgs::ColorRGBA& color) {
    const double length = std::hypot(vector.x, vector.y, vector.z);
    // What is not finite goes on, so that it is named as for other markers.
    if (length < least) return Without(message.header, id);
    return ArrowOf(message.header, id, In(style, color), vector, metres);
  };
  return ShownMarkers{
      shown(0, message.wrench.force, kLeastForce, kMetresPerNewton, Color(204, 51, 51)),
      shown(1, message.wrench.torque, kLeastTorque, kMetresPerNewtonMetre, Color(204, 204, 51))};
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::LaserScan& message, const ShownStyle& style) {
  Marker points = PointsOf(message.header, style);
  const bool has_intensities = message.intensities.size() == message.ranges.size();
  const std::size_t step = StepOf(message.ranges.size());
  std::vector<double> intensities;
  for (std::size_t i = 0; i < message.ranges.size(); i += step) {
    const float range = message.ranges[i];
    if (!(range >= message.range_min && range <= message.range_max)) continue;
    const double angle = static_cast<double>(message.angle_min) +
                         static_cast<double>(i) * static_cast<double>(message.angle_increment);
    const auto metres = static_cast<double>(range);
    points.points.push_back(PointAt(metres * std::cos(angle), metres * std::sin(angle), 0));
    if (has_intensities) intensities.push_back(static_cast<double>(message.intensities[i]));
  }
  Colour(points, RainbowOf(intensities), style);
  return OneOrNone(std::move(points));
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::PointCloud2& message, const ShownStyle& style) {
  const auto refuse = [](const std::string& why) {
    return tl::unexpected(Refusal{"cannot be drawn", "a point cloud: " + why});
  };
  if (const char* const defect = DefectOf(message)) return refuse(defect);
  const auto x = CloudField::Find(message, {"x"}), y = CloudField::Find(message, {"y"}),
             z = CloudField::Find(message, {"z"});
  if (!x || !y || !z || !x->is_float() || !y->is_float() || !z->is_float()) {
    return refuse("no fields x, y and z of type FLOAT32");
  }
  const auto packed = CloudField::Find(message, {"rgb", "rgba"});
  const bool has_colors = packed && packed->size() == 4;
  const auto intensity =
      has_colors ? std::nullopt : CloudField::Find(message, {"intensity", "intensities"});
  Marker points = PointsOf(message.header, style);
  std::vector<double> intensities;
  std::vector<std_msgs::ColorRGBA> colors;
  const std::uint64_t count = std::uint64_t{message.width} * message.height;
  const std::size_t step = StepOf(count);
  for (std::uint64_t i = 0; i < count; i += step) {
    const std::uint8_t* const point = message.data.data() + i / message.width * message.row_step +
                                      i % message.width * message.point_step;
    const geometry_msgs::Point place =
        PointAt(x->Number(point), y->Number(point), z->Number(point));
    if (!std::isfinite(place.x + place.y + place.z)) continue;  // depth cameras send many
    points.points.push_back(place);
    if (has_colors) colors.push_back(packed->Packed(point));
    if (intensity) intensities.push_back(intensity->Number(point));
  }
  Colour(points, has_colors ? std::move(colors) : RainbowOf(intensities), style);
  return OneOrNone(std::move(points));
}

ToMarkersOfBytes FindShownMessage(const std::string& md5sum) {
  for (const ShownType& type : ShownTypes()) {
    if (md5sum == type.md5sum) return type.to_markers;
  }
  return nullptr;
}

void NameByTopic(ShownMarkers& markers, const std::string& topic) {
  for (Marker& marker : markers) marker.ns = topic.substr(topic.find_first_not_of('/'));
}

std::string NamesOfShownMessages() {
  std::string names;
  for (const ShownType& type : ShownTypes())
    names += (names.empty() ? "" : ", ") + std::string(type.name);
  return names;
}

}  // namespace kinescope::ros_bridge
