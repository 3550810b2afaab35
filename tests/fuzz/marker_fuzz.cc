// Any bytes as messages of the topics that Kinescope subscribes to: markers (first byte 0 or 1),
// transforms, link states, joint states, joint loads, what was told of people, and those that are
// shown as markers. They are rejected, or have no more in them than their bytes; markers that are
// accepted can be rendered.
#include <kinescope/JointLoadArray.h>
#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/system/check.h"
#include "render/camera/image_view.h"
#include "render/image/camera_picture.h"
#include "server/ros/calibration.h"
#include "server/ros/effort_rings.h"
#include "server/ros/image_messages.h"
#include "server/ros/interactive_markers.h"
#include "server/ros/marker_input.h"
#include "server/ros/raw_message.h"
#include "server/ros/shown_messages.h"
#include "server/ros/source/told_people.h"
#include "server/ros/topic_markers.h"

namespace marker_fuzz {
namespace {

using namespace kinescope;
using namespace kinescope::ros_bridge;

// A frame that turns: by a radian a second.
FramePlace PlaceAt(std::int64_t stamp_nanos) {
  const double radians = 1e-9 * static_cast<double>(stamp_nanos % 1'000'000'000);
  const Eigen::AngleAxisd turn(radians, Eigen::Vector3d::UnitZ());
  return FramePlace{{Eigen::Vector3d::Zero(), Eigen::Quaterniond(turn)}};
}

template <class Message>
void CheckMarkers(const std::vector<Message>& markers) {
  MarkerStore store;
  std::int64_t now = 0;
  for (const Message& marker : markers) {
    now += 200'000'000;
    if (const auto refusal = store.Apply(0, marker, now, {}, {}, SweepOf(marker))) {
      KINESCOPE_CHECK(*refusal->kind != '\0' && !refusal->text.empty());
    }
    // The pose of a frame is that of its message, as far as this knows; every other frame is lost.
    static_cast<void>(store.Update(now, [](const std::string& frame, std::int64_t stamp) {
      return frame.size() % 2 == 0 ? std::make_optional(PlaceAt(stamp)) : std::nullopt;
    }));
    for (const WithoutPlace& lost : store.TakeLost()) {
      KINESCOPE_CHECK(!lost.Text(TfTree(), "world").empty());
    }
  }
  KINESCOPE_CHECK(store.markers().size() <= kMaxMarkers);
  for (const std::shared_ptr<const SceneMarker>& marker : store.markers()) {
    KINESCOPE_CHECK(!FindDefect(*marker));
    KINESCOPE_CHECK(marker->points.size() <= kMaxMarkerPoints);
    KINESCOPE_CHECK(marker->text.size() <= kMaxMarkerText);
  }
}

template <class Message>
bool Read(const std::vector<std::uint8_t>& bytes, Message& message) {
  if (!ReadBounded(bytes.data(), bytes.size(), message)) return false;
  KINESCOPE_CHECK(ros::serialization::serializationLength(message) <= bytes.size());
  return true;
}

template <class Message>
void Read(const std::vector<std::uint8_t>& bytes) {
  Message message;
  Read(bytes, message);
}

// Rings of a robot that has every joint.
void CheckEfforts(const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::JointState joints;
  if (!Read(bytes, joints)) return;
  const auto joint = std::make_shared<urdf::RobotJoint>();
  joint->type = urdf::RobotJoint::Type::kRevolute;
  joint->axis = {1, 2, 3};
  const auto find = [&](const std::string& name) {
    return ShownJoint{static_cast<int>(name.size()), joint, "hand"};
  };
  const auto rings = ToMarkers(joints, find, ShownStyle{});
  if (!rings) return KINESCOPE_CHECK(!rings.error().text.empty());
  KINESCOPE_CHECK(rings->size() == 2 * joints.name.size());
  CheckMarkers(*rings);
}

template <class Message>
void CheckShown(const std::vector<std::uint8_t>& bytes) {
  const auto convert = FindShownMessage(ros::message_traits::md5sum<Message>());
  KINESCOPE_CHECK(convert != nullptr);
  ShownStyle scaled;
  scaled.scale = PointScale{};
  scaled.scale->by = "ring";
  scaled.has_spheres = true;
  ShownStyle of_rviz;
  of_rviz.width_m = 0.3;
  of_rviz.covariance.scale = of_rviz.turn_covariance.scale = 1;
  of_rviz.has_arrows = true;
  for (const ShownStyle& style : {ShownStyle{}, scaled, of_rviz}) {
    const auto markers = convert(bytes, style);
    if (markers) {
      CheckMarkers(*markers);
    } else {
      KINESCOPE_CHECK(!markers.error().text.empty());
    }
  }
}

// One message after the other, as servers send them: the same one again, then as of a server that
// was restarted.
template <class Message>
void CheckInteractive(const std::vector<std::uint8_t>& bytes) {
  Message message;
  if (!Read(bytes, message)) return;
  InteractiveMarkers markers;
  ShownMarkers all;
  ShownStyle with_axes;
  with_axes.has_axes = true;
  for (const ShownStyle& style : {ShownStyle{}, with_axes}) {
    const auto refusal = markers.Take(message, style, all);
    KINESCOPE_CHECK(!refusal || !refusal->text.empty());
    message.seq_num /= 2;
  }
  KINESCOPE_CHECK(all.size() <= 4 * kMostInteractiveMarkers);
  CheckMarkers(all);
}

template <class Message>
std::vector<std::uint8_t> Serialized(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

// Depths before and after a calibration, which may be the bytes.
template <class Message>
void CheckDepths(const std::vector<std::uint8_t>& bytes) {
  ShownStyle style;
  style.camera.is_cloud = true;
  sensor_msgs::CameraInfo info;
  info.width = info.height = 4;
  info.P[0] = info.P[5] = 4;
  TopicMarkers topics;
  ShownMarkers markers;
  const auto take = [&](const std::string& type, const std::vector<std::uint8_t>& message) {
    const auto refusal = topics.Take(0, "depth", style, type, message, markers);
    KINESCOPE_CHECK(!refusal || !refusal->text.empty());
  };
  const std::string type = ros::message_traits::md5sum<Message>();
  take(type, bytes);
  take(ros::message_traits::md5sum<sensor_msgs::CameraInfo>(), Serialized(info));
  if (type == ros::message_traits::md5sum<sensor_msgs::Image>()) {
    const auto refusal = topics.TakeColors(0, type, bytes);
    KINESCOPE_CHECK(!refusal || !refusal->text.empty());
  }
  take(type, bytes);
  CheckMarkers(markers);
}

// An update before and after a map of 4 x 3 cells.
void CheckMapUpdate(const std::vector<std::uint8_t>& bytes) {
  ShownStyle style;
  style.has_updates = true;
  nav_msgs::OccupancyGrid map;
  map.info.resolution = 0.5F;
  map.info.width = 4;
  map.info.height = 3;
  map.info.origin.orientation.w = 1;
  map.data.resize(12);
  TopicMarkers topics;
  ShownMarkers markers;
  const auto take = [&](const std::string& type, const std::vector<std::uint8_t>& message) {
    const auto refusal = topics.Take(0, "map", style, type, message, markers);
    KINESCOPE_CHECK(!refusal || !refusal->text.empty());
    return !refusal;
  };
  const std::string update = ros::message_traits::md5sum<map_msgs::OccupancyGridUpdate>();
  KINESCOPE_CHECK(!take(update, bytes));
  KINESCOPE_CHECK(take(ros::message_traits::md5sum<nav_msgs::OccupancyGrid>(), Serialized(map)));
  take(update, bytes);
  CheckMarkers(markers);
}

// A calibration that is taken is one of a camera that can be drawn with.
void CheckCalibration(const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::CameraInfo info;
  if (!Read(bytes, info)) return;
  const auto calibration = ToCalibration(info);
  if (!calibration) return KINESCOPE_CHECK(!calibration.error().text.empty());
  KINESCOPE_CHECK(FindDefect(calibration->camera).empty());
  const render::ImageView view = render::ViewOf(calibration->camera, 40, 30);
  KINESCOPE_CHECK(view.image.x >= 0 && view.image.x + view.image.width <= view.width);
  KINESCOPE_CHECK(view.image.y >= 0 && view.image.y + view.image.height <= view.height);
  KINESCOPE_CHECK(view.width <= 200 && view.height <= 200);
}

template <class Message>
void CheckImage(const std::vector<std::uint8_t>& bytes) {
  const auto image = ReadImage(ros::message_traits::md5sum<Message>(),
                               std::make_shared<const std::vector<std::uint8_t>>(bytes));
  if (!image) return KINESCOPE_CHECK(!image.error().text.empty());
  KINESCOPE_CHECK(image->begin + image->size <= bytes.size());
  const auto pixels = render::DecodeCameraImage(*image, 40, 30);
  KINESCOPE_CHECK(!pixels || (pixels->width <= 40 && pixels->height <= 30));
}

// Told of someone who is there.
void CheckTold(const std::vector<std::uint8_t>& bytes) {
  struct : SampleSink {
    void OnCharacter(const Character&) override { ++characters; }
    void OnSample(const BodySample&) override { ++samples; }
    int characters = 0, samples = 0;
  } sink;
  ToldPeople people([](int) { return ToldPeople::Key{"anna_pelvis", "/anna/"}; });
  people.SetSink(&sink);
  people.OnCharacter({});
  static_cast<void>(people.Take(bytes));
  people.OnSample({});
  people.OnSample({});
  KINESCOPE_CHECK(sink.samples == 2 && sink.characters >= 1 && sink.characters <= 2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::vector<std::uint8_t> bytes(data + 1, data + size);
  switch (data[0] % 35) {
    case 0: {
      visualization_msgs::Marker marker;
      if (Read(bytes, marker)) CheckMarkers(std::vector<visualization_msgs::Marker>{marker});
      break;
    }
    case 1: {
      visualization_msgs::MarkerArray array;
      if (Read(bytes, array)) CheckMarkers(array.markers);
      break;
    }
    case 2: Read<tf2_msgs::TFMessage>(bytes); break;
    case 3: Read<xsens_mvn_ros_msgs::LinkStateArray>(bytes); break;
    case 4: CheckEfforts(bytes); break;
    case 5: Read<kinescope_ros::JointLoadArray>(bytes); break;
    case 6: CheckShown<geometry_msgs::PointStamped>(bytes); break;
    case 7: CheckShown<geometry_msgs::PoseStamped>(bytes); break;
    case 8: CheckShown<geometry_msgs::PoseArray>(bytes); break;
    case 9: CheckShown<nav_msgs::Path>(bytes); break;
    case 10: CheckShown<geometry_msgs::WrenchStamped>(bytes); break;
    case 11: CheckShown<sensor_msgs::LaserScan>(bytes); break;
    case 12: CheckShown<sensor_msgs::PointCloud2>(bytes); break;
    case 13: CheckShown<geometry_msgs::PoseWithCovarianceStamped>(bytes); break;
    case 14: CheckShown<geometry_msgs::PolygonStamped>(bytes); break;
    case 15: CheckShown<nav_msgs::Odometry>(bytes); break;
    case 16: CheckShown<nav_msgs::GridCells>(bytes); break;
    case 17: CheckShown<nav_msgs::OccupancyGrid>(bytes); break;
    case 18: CheckShown<sensor_msgs::PointCloud>(bytes); break;
    case 19: CheckImage<sensor_msgs::Image>(bytes); break;
    case 20: CheckImage<sensor_msgs::CompressedImage>(bytes); break;
    case 21: CheckShown<sensor_msgs::Temperature>(bytes); break;
    case 22: CheckShown<sensor_msgs::Illuminance>(bytes); break;
    case 23: CheckShown<sensor_msgs::FluidPressure>(bytes); break;
    case 24: CheckShown<sensor_msgs::RelativeHumidity>(bytes); break;
    case 25: CheckShown<geometry_msgs::TwistStamped>(bytes); break;
    case 26: CheckShown<geometry_msgs::AccelStamped>(bytes); break;
    case 27: CheckShown<sensor_msgs::Range>(bytes); break;
    case 28: CheckInteractive<visualization_msgs::InteractiveMarkerInit>(bytes); break;
    case 29: CheckInteractive<visualization_msgs::InteractiveMarkerUpdate>(bytes); break;
    case 30: CheckDepths<sensor_msgs::Image>(bytes); break;
    case 31: CheckDepths<sensor_msgs::CameraInfo>(bytes); break;
    case 32: CheckCalibration(bytes); break;
    case 34: CheckTold(bytes); break;
    default: CheckMapUpdate(bytes); break;
  }
  return 0;
}

}  // namespace marker_fuzz
