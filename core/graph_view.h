/// What is shown of a ROS graph, or of a bag, beside its people and its markers. No ROS type
/// appears here.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/robot_state.h"
#include "core/suit_colors.h"

namespace kinescope {

/// A robot whose links the transforms of a graph, or of a bag, move.
struct GraphRobot {
  std::string parameter;  // of the parameter server, with the URDF; "": it is in `robot`
  std::string tf_prefix;  // its frames are "<tf_prefix>/<link>"; "": as its links
  RobotState robot = {};  // without a parameter: model, meshes and name; else empty
  double opacity = 1;     // 0..1, of a robot with a parameter
};

/// Colours of points by a number that each of them has: RViz's Intensity and AxisColor.
struct PointScale {
  // x, y, z: of its place in the scene; else the name of a field; "": intensity, or what the
  // message measures.
  std::string by;
  bool is_in_message = false;      // x, y, z: of its place in the frame of its message
  std::optional<double> from, to;  // where the colours begin and end; unset: of the points
  std::optional<Rgb> low, high;    // unset, both: a rainbow from red to magenta
  bool is_inverted = false;        // the rainbow
};

/// Arrows of a wrench, a twist or an acceleration: force and torque, or linear and angular.
struct WrenchArrows {
  std::optional<double> force_m, torque_m;  // their lengths for 1 N and for 1 N·m; 0: none
  std::optional<Rgb> torque_color;
  bool hides_small = true;  // with a width: arrows whose shaft is shorter than that
};

/// The ellipsoid of a position's standard deviation.
struct CovarianceStyle {
  double scale = 0;  // 0: none
  std::optional<Rgb> color;
  double alpha = 0.3;
};

/// What a pose's standard deviation of the orientation does to the tips of its axes: an ellipse
/// about each; of a pose in the plane, as a wedge about x.
struct TurnCovarianceStyle {
  double scale = 0;  // 0: none
  std::optional<Rgb> color;
  bool has_axis_colors = false;  // red, green and blue, in place of `color`
  double alpha = 0.5;
  double offset_m = 1;  // length of the axes
};

/// Of arrows of poses, m; unset: in the usual proportions to their length.
struct ArrowStyle {
  std::optional<double> head_m, shaft_width_m, head_width_m;
};

/// Poses along a path, if they are shown.
struct PathPoses {
  std::optional<double> size_m;   // length of their axes or arrows
  std::optional<double> width_m;  // of axes
  std::optional<Rgb> color;       // of arrows
};

/// Every frame of TF: axes with the length `size_m`, a name in `color` and an arrow to its parent.
struct FramesStyle {
  bool has_axes = true, has_names = true, has_arrows = true;
  std::optional<double> name_m;  // height of the names
  double timeout_secs = 15;      // a frame that is not heard of for as long is not shown
  std::vector<std::string> hidden;
};

/// A grid of lines about the origin of a frame, as RViz's Grid display has it.
struct GridStyle {
  enum class Plane { kXy, kXz, kYz };
  Plane plane = Plane::kXy;
  int cells = 10;                            // along each side
  int layers = 0;                            // of cells across the plane
  std::array<double, 3> offset = {0, 0, 0};  // of its middle, in the frame, m
};
inline constexpr int kMostGridCells = 1000, kMostGridLayers = 20;
/// Of one with layers, whose lines are many more.
inline constexpr int kMostLayeredCells = 100;

/// Of a topic of images.
struct CameraStyle {
  double scene_opacity = 0;  // of the scene that is drawn over each, as its camera sees it; 0: none
  double pane_width = 0;     // of pictures, as a share of their width; 0: as usual
  bool is_cloud = false;     // depths, shown as a cloud of points in place of a picture
  std::string color_topic = {};  // of a cloud: images of the same size with its colours; "": none
};

inline constexpr std::size_t kMostKeptMessages = 1000;
inline constexpr double kLongestDecay = 600;  // s

/// The messages of a topic that are shown with its newest one.
struct EarlierMessages {
  std::size_t keep = 1;   // how many there are, with the newest
  double decay_secs = 0;  // not 0: those of the last seconds, in place of `keep`
  /// Messages of poses that are nearer to the one before than both are not shown.
  double step_m = 0, turn_rad = 0;
};

/// RViz's colour schemes of a map.
enum class MapColors { kMap, kCostmap, kRaw };

inline constexpr std::size_t kUsualCloudPoints = 20'000, kMostCloudPoints = 100'000;

/// How a message that is shown as a marker looks, where it is not as by default
/// (server/ros/shown_messages.h).
struct ShownStyle {
  std::optional<Rgb> color;       // of all of it, in place of colours of its own
  std::optional<double> alpha;    // 0..1
  std::optional<double> size_m;   // of a point, the width of a line, the length of an arrow, the
                                  // radius of a sphere
  std::optional<double> size_px;  // of points that are squares, in pixels of the picture, whatever
                                  // their distance; in place of `size_m`. Of paths, polygons and
                                  // flat arrows: their lines are one pixel wide
  /// Of axes, their diameter. Of a wrench RViz's "Arrow Width", of which a tenth is the diameter of
  /// the shaft; unset: as arrows of ground reaction forces.
  std::optional<double> width_m;
  std::optional<PointScale> scale;  // of points, unless they have a colour
  bool has_axes = false;            // of a pose: three axes, not an arrow
  bool has_arrows = false;          // of poses in an array or along a path: solid arrows
  // Of points, if they are few: spheres or cubes, not squares that face the viewer.
  bool has_spheres = false, has_cubes = false;
  std::size_t most_points = kUsualCloudPoints;  // of a cloud or scan with more, as many throughout
  MapColors map_colors = MapColors::kMap;
  bool has_updates = false;  // of a map: with those that come on "<topic>_updates"
  bool is_behind = false;    // of a map: below all others
  bool has_array = false;    // markers of "<topic>_array", too
  bool has_handles = true;   // of interactive markers: those of RViz's Interact tool alone
  WrenchArrows wrench = {};
  FramesStyle frames = {};
  CovarianceStyle covariance = {};
  TurnCovarianceStyle turn_covariance = {};
  PathPoses poses = {};
  ArrowStyle arrow = {};
  CameraStyle camera = {};
  EarlierMessages earlier = {};
  GridStyle grid = {};
  /// Of axes and grids whose frame is not known: they stand at the origin of the scene, and that is
  /// told, unless it was to be expected.
  bool stands_in_scene = false, is_told_missing = false;
};

inline constexpr char kEveryFrame[] = "*";

/// As many may be named.
inline constexpr std::size_t kMostShownTopics = 64;

struct ShownTopic {
  std::string name;
  ShownStyle style = {};
  bool is_frame = false;  // no topic: a frame of TF whose axes are shown; "": that of the scene
  bool is_grid = false;   // with is_frame: a grid in it, with cells of `size_m`, in place of axes
  bool leaves_out_others = false;  // no topic: of a bag, markers of topics that are not named are
                                   // not shown
  bool is_every_frame() const { return is_frame && name == kEveryFrame; }
};

/// The fixed frame of RViz's configurations unless told, whether or not there is one of that name:
/// a scene without it is no mistake of the user.
inline constexpr char kUsualFrameOfRviz[] = "map";

/// The frames of TF that a camera goes with.
struct CameraFrames {
  std::string at = {};    // where it is; "": the camera stands
  std::string axes = {};  // how it is turned; "": as `at`
};

struct GraphView {
  /// Of messages that are shown as markers: points, poses, paths, ...
  std::vector<ShownTopic> topics;
  std::vector<GraphRobot> robots;
  /// Of the transforms of a bag; "": /tf.
  std::string tf_topic = {};
  CameraFrames camera_frame = {};
  /// Of a graph: the people whose frames TF connects with it are placed in it. "": in the frame of
  /// the first of them.
  std::string reference_frame = {};
  /// Without it, a bag that has no person is shown if it has something else to show.
  bool needs_person = true;

  /// Whether a source that is neither a graph nor a bag can do without.
  bool is_empty() const { return tf_topic.empty() && topics.empty() && robots.empty(); }
};

}  // namespace kinescope
