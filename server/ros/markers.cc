#include "server/ros/markers.h"

#include "server/core/palette.h"
#include "server/ros/convert.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

constexpr char kLoads[] = "loads";
constexpr char kCom[] = "com";
constexpr char kCop[] = "cop";

void SetColor(const Rgb& rgb, Marker& marker) {
  marker.color.r = static_cast<float>(rgb[0]);
  marker.color.g = static_cast<float>(rgb[1]);
  marker.color.b = static_cast<float>(rgb[2]);
  marker.color.a = 1;
}

Eigen::Vector3d Cube(double size) { return Eigen::Vector3d::Constant(size); }

// Writes markers one after another into a message that keeps its memory.
class Writer {
 public:
  Writer(visualization_msgs::MarkerArray& message, const PersonState& person,
         const PersonNames& names, const std::string& reference_frame, MarkerFrames frames)
      : message_(message),
        person_(person),
        names_(names),
        reference_frame_(reference_frame),
        frames_(frames),
        stamp_(StampOf(person.sample)) {}

  // `position` is in the reference frame.
  Marker& Add(const char* ns, int id, int type, const Eigen::Vector3d& position,
              const Eigen::Vector3d& size, const Rgb& color) {
    if (message_.markers.size() <= next_) message_.markers.emplace_back();
    Marker& marker = message_.markers[next_++];
    marker.header.stamp = stamp_;
    marker.header.frame_id = reference_frame_;
    marker.frame_locked = false;
    marker.ns = ns;
    marker.id = id;
    marker.type = type;
    marker.action = Marker::ADD;
    Set(marker.pose.position, position);
    Set(marker.pose.orientation, Eigen::Quaterniond::Identity());
    Set(marker.scale, size);
    SetColor(color, marker);
    marker.lifetime = ros::Duration(kMarkerLifetime);
    return marker;
  }

  void AddToLink(int segment, const char* ns, int id, const Eigen::Vector3d& position,
                 double radius, const Rgb& color) {
    Marker& marker = Add(ns, id, Marker::SPHERE, position, Cube(2 * radius), color);
    if (frames_ == MarkerFrames::kReference) return;
    const urdf::Pose& link = person_.links[At(segment)];
    marker.header.frame_id = names_.links[At(segment)];
    marker.frame_locked = true;
    Set(marker.pose.position, link.orientation.conjugate() * (position - link.position));
  }

  void Finish() { message_.markers.resize(next_); }

 private:
  visualization_msgs::MarkerArray& message_;
  const PersonState& person_;
  const PersonNames& names_;
  const std::string& reference_frame_;
  const MarkerFrames frames_;
  const ros::Time stamp_;
  std::size_t next_ = 0;
};

}  // namespace

void FillMarkers(const PersonState& person, const PersonNames& names,
                 const std::string& reference_frame, MarkerFrames frames,
                 visualization_msgs::MarkerArray& message) {
  Writer out(message, person, names, reference_frame, frames);
  const double stature = person.model->human.skeleton.height;
  for (const JointLoad& load : person.loads) {
    out.AddToLink(urdf::ChildOf(load.joint), kLoads, load.joint, load.position,
                  SphereRadius(load.joint, load.load_class, stature), ColorOf(load.load_class));
  }
  if (person.com) {
    out.AddToLink(urdf::kPelvis, kCom, 0, *person.com, kComRadius, kComColor);
  }
  if (person.cop) {
    out.Add(kCop, 0, Marker::CYLINDER, *person.cop, {2 * kCopRadius, 2 * kCopRadius, kCopThickness},
            kCopColor);
  }
  out.Finish();
}

void MakeStale(double stature, visualization_msgs::MarkerArray& message) {
  for (Marker& marker : message.markers) {
    SetColor(ColorOf(LoadClass::kUnknown), marker);
    marker.lifetime = ros::Duration(0);  // stays
    if (marker.ns == kLoads) {
      Set(marker.scale, Cube(2 * SphereRadius(marker.id, LoadClass::kUnknown, stature)));
    } else if (marker.ns == kCop) {
      marker.action = Marker::DELETE;
    }
  }
}

}  // namespace kinescope::ros_bridge
