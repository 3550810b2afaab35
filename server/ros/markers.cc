#include "server/ros/markers.h"

#include <algorithm>
#include <bitset>
#include <cstddef>

#include "core/hand_load_shape.h"
#include "core/palette.h"
#include "core/system/starts_with.h"
#include "server/ros/convert.h"
#include "server/ros/shown_parts.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

constexpr char kLoads[] = "loads";
constexpr char kCom[] = "com";
constexpr char kCop[] = "cop";
constexpr char kSupport[] = "support";
constexpr char kForces[] = "foot_forces";
constexpr char kHandLoads[] = "hand_loads";

void SetColor(const Rgb& rgb, Marker& marker) {
  marker.color.r = static_cast<float>(rgb[0]);
  marker.color.g = static_cast<float>(rgb[1]);
  marker.color.b = static_cast<float>(rgb[2]);
  marker.color.a = 1;
}

Eigen::Vector3d Cube(double size) { return Eigen::Vector3d::Constant(size); }

// Writes markers one after another into a message whose memory is reused.
class MarkerWriter {
 public:
  MarkerWriter(visualization_msgs::MarkerArray& message, const PersonState& person,
               const PersonNames& names, const std::string& reference_frame, MarkerFrames frames,
               double lifetime_secs)
      : message_(message),
        person_(person),
        names_(names),
        reference_frame_(reference_frame),
        frames_(frames),
        stamp_(StampOf(person.sample)),
        lifetime_(lifetime_secs) {}

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
    marker.lifetime = lifetime_;
    marker.text.clear();
    marker.points.clear();
    return marker;
  }

  // From points in the reference frame.
  Marker& AddShape(const char* ns, int id, int type, const Eigen::Vector3d& size,
                   const Rgb& color) {
    return Add(ns, id, type, Eigen::Vector3d::Zero(), size, color);
  }

  Marker& AddToLink(int segment, const char* ns, int id, const Eigen::Vector3d& position,
                    double radius, const Rgb& color) {
    Marker& marker = Add(ns, id, Marker::SPHERE, position, Cube(2 * radius), color);
    LockToLink(segment, {position, Eigen::Quaterniond::Identity()}, marker);
    return marker;
  }

  // `pose` is in the reference frame.
  void LockToLink(int segment, const urdf::Pose& pose, Marker& marker) const {
    Set(marker.pose.orientation, pose.orientation);
    if (frames_ == MarkerFrames::kReference) return;
    const urdf::Pose& link = person_.links[At(segment)];
    const Eigen::Quaterniond link_from_world = link.orientation.conjugate();
    marker.header.frame_id = names_.links[At(segment)];
    marker.frame_locked = true;
    Set(marker.pose.position, link_from_world * (pose.position - link.position));
    Set(marker.pose.orientation, link_from_world * pose.orientation);
  }

  void Remove(const char* ns, int id) {
    Add(ns, id, Marker::SPHERE, Eigen::Vector3d::Zero(), Cube(1), kComColor).action =
        Marker::DELETE;
  }

  void Finish() { message_.markers.resize(next_); }

 private:
  visualization_msgs::MarkerArray& message_;
  const PersonState& person_;
  const PersonNames& names_;
  const std::string& reference_frame_;
  const MarkerFrames frames_;
  const ros::Time stamp_;
  const ros::Duration lifetime_;
  std::size_t next_ = 0;
};

void AddSupport(const BodyForces& forces, double floor_z, MarkerWriter& out) {
  if (forces.support.size < 2) return;
  Marker& line =
      out.AddShape(kSupport, 0, Marker::LINE_STRIP, {kSupportWidth, 0, 0}, kSupportColor);
  for (std::size_t i = 0; i <= forces.support.size; ++i) {  // closed: ends at the first corner
    const Eigen::Vector2d& corner = forces.support.corners[i % forces.support.size];
    line.points.push_back(PointAt({corner.x(), corner.y(), floor_z}));
  }
}

void AddFootForces(const BodyForces& forces, MarkerWriter& out) {
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const FootForce& foot = forces.feet[side];
    if (!(foot.force.norm() > kMinForceShown) || !foot.cop.allFinite()) continue;
    Marker& arrow = out.AddShape(kForces, side, Marker::ARROW, {0.02, 0.04, 0}, kCopColor);
    arrow.points = {PointAt(foot.cop), PointAt(foot.cop + kMetresPerNewton * foot.force)};
  }
}

void AddHeld(const PersonState& person, MarkerWriter& out) {
  const HandLoadShape held = ShapeOfHandLoad(person);
  for (std::size_t i = 0; i < held.count; ++i) {
    const HandLoadSolid& solid = held.solids[i];
    const bool is_box = solid.kind == HandLoadSolid::Kind::kBox;
    const Eigen::Vector3d size =
        is_box ? solid.size
               : Eigen::Vector3d(2 * solid.size.x(), 2 * solid.size.y(), solid.size.z());
    Marker& marker =
        out.Add(kHandLoads, static_cast<int>(i), is_box ? Marker::CUBE : Marker::CYLINDER,
                solid.pose.position, size, kHandLoadColor);
    // What both hold follows one of them.
    out.LockToLink(urdf::HandSegmentOf(solid.hand.value_or(urdf::kRight)), solid.pose, marker);
  }
}

// What a person has, but not in every sample.
struct Passing {
  const char* ns;
  int count;  // ids from 0
};
constexpr Passing kPassing[] = {{kCom, 1},
                                {kCop, 1},
                                {kSupport, 1},
                                {kForces, 2},
                                {kHandLoads, static_cast<int>(kMaxHandLoadSolids)}};
using PassingSet = std::bitset<16>;  // in the order of kPassing and ids

PassingSet PassingOf(const visualization_msgs::MarkerArray& message) {
  PassingSet found;
  for (const Marker& marker : message.markers) {
    int first = 0;
    for (const Passing& each : kPassing) {
      if (marker.ns == each.ns && marker.action == Marker::ADD) {
        found.set(urdf::At(first + marker.id));
      }
      first += each.count;
    }
  }
  return found;
}

void RemovePassed(const PassingSet& passed, MarkerWriter& out) {
  int first = 0;
  for (const Passing& each : kPassing) {
    for (int id = 0; id < each.count; ++id) {
      if (passed.test(urdf::At(first + id))) out.Remove(each.ns, id);
    }
    first += each.count;
  }
}

}  // namespace

double MarkerLifetime(double period_secs) {
  return std::clamp(2.5 * period_secs, kMarkerLifetime, 60.0);
}

void FillMarkers(const PersonState& person, const PersonNames& names,
                 const std::string& reference_frame, MarkerFrames frames, double floor_z,
                 visualization_msgs::MarkerArray& message, double lifetime_secs) {
  const PassingSet before = PassingOf(message);
  MarkerWriter out(message, person, names, reference_frame, frames, lifetime_secs);
  for (const JointLoad& load : person.loads) {
    out.AddToLink(urdf::ChildOf(load.joint), kLoads, load.joint, load.position,
                  SphereRadius(load.joint, load.load_class, *person.model),
                  ColorOf(load.load_class));
  }
  const MarkSizes sizes = MarkSizesOf(person.model->human.skeleton.height);
  if (person.com) {
    out.AddToLink(urdf::kPelvis, kCom, 0, *person.com, sizes.com, kComColor);
  }
  if (person.cop) {
    out.Add(kCop, 0, Marker::CYLINDER, *person.cop,
            {2 * sizes.cop_edge, 2 * sizes.cop_edge, kCopThickness}, kCopColor);
  }
  AddSupport(person.forces, floor_z, out);
  AddFootForces(person.forces, out);
  AddHeld(person, out);
  out.Finish();
  RemovePassed(before & ~PassingOf(message), out);
}

void MakeStale(const PersonModel& model, visualization_msgs::MarkerArray& message) {
  for (Marker& marker : message.markers) {
    SetColor(ColorOf(LoadClass::kUnknown), marker);
    marker.lifetime = ros::Duration(0);  // no lifetime
    if (marker.ns == kLoads) {
      Set(marker.scale, Cube(2 * SphereRadius(marker.id, LoadClass::kUnknown, model)));
    } else if (marker.ns == kCop || marker.ns == kForces) {
      marker.action = Marker::DELETE;
    }
  }
}

void MakeDeleted(visualization_msgs::MarkerArray& message) {
  for (Marker& marker : message.markers) marker.action = Marker::DELETE;
}

bool IsOwnMarker(const std::string& topic, const std::string& ns) {
  if (!EndsWith(topic, "/markers")) return false;
  for (const char* const own : {kLoads, kCom, kCop, kSupport, kForces, kHandLoads}) {
    if (ns == own) return true;
  }
  return false;
}

}  // namespace kinescope::ros_bridge
