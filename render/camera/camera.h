/// Defines the named cameras, and projects points of the world into the picture. A name gives the
/// same view in pictures, page and RViz. World: z up, metres. GLM computes the matrices but does
/// not appear here. Pure functions, any thread, except SmoothedGroundExtent.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::render {

struct Camera {
  Eigen::Vector3d position = {3, 3, 1.6};
  Eigen::Vector3d target = {0, 0, 0.95};
  Eigen::Vector3d up = {0, 0, 1};
  double vertical_fov_rad = 0.52;  // 30 deg
  double near_m = 0.05;
  double far_m = 60;
  /// Height of an orthographic picture at any depth, m; above 0 the field of view is ignored.
  double ortho_height_m = 0;

  bool is_orthographic() const { return ortho_height_m > 0; }
};

/// "front", "back", "left", "right", "top", "iso", "three_quarter": in display order.
const std::vector<std::string>& CameraNames();

/// The name for which `name` is another word: of "side", which papers call the sagittal view,
/// "right". Other names are their own.
const std::string& CameraMeantBy(const std::string& name);

/// Whether named cameras show SceneState::extent, for want of people.
bool ShowsExtent(const SceneState& state);

/// The named camera at a distance that shows all of `extent`. @throws as NamedCamera.
Camera NamedCameraAround(const std::string& name, const Eigen::AlignedBox3d& extent);

/// The named camera, aimed at the people in `state` (their pelvis projected on the floor; the
/// origin without people) at a distance that shows a standing adult with arms overhead.
/// Without people, and with something else: aimed at the middle of SceneState::extent, at a
/// distance that shows all of it. front: seen from +x, so that the person faces the camera.
/// @throws UsageError with the requested camera and those that exist.
Camera NamedCamera(const std::string& name, const SceneState& state);

/// Numbers by which the named cameras frame people. The page receives them in /api/v1/cameras.
struct GroupFraming {
  double min_width_m = 1.9;  // visible around the target in any picture: the arms of a T-pose and
                             // a little beside them
  double margin_m = 0.7;     // beside the outermost person of a group
  double narrowest_aspect = 4.0 / 3;  // width / height of a picture that a group must fit into
  double reach_m = 50;    // of a group, from the person nearest to the origin: farther people would
                          // make all too small to see, and may be out of the picture
  double height_m = 2.5;  // visible around the target: a standing adult with arms overhead
};
inline constexpr GroupFraming kGroupFraming;

/// Target of the named cameras: the middle of the people on the floor, and the distance of the
/// outermost person from it.
struct GroundExtent {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // world, m
  double radius = 0;                                 // m
};
GroundExtent GroundExtentOf(const SceneState& state);
/// The people whom cameras frame: those within GroupFraming::reach_m. They belong to `state`.
std::vector<const PersonState*> FramedPeople(const SceneState& state);

/// The named camera aimed at `about`, as if people stood there. @throws as NamedCamera.
Camera NamedCameraAt(const std::string& name, const GroundExtent& about);

/// Height of the visible area at the depth of the target, m.
double ShownHeight(const Camera& camera);

/// `camera` moved along its axis so that objects at the depth of the target keep their size with
/// another field of view, or with none. @pre 0 < fov < pi
[[nodiscard]] Camera WithFov(const Camera& camera, double vertical_fov_rad);
[[nodiscard]] Camera Orthographic(const Camera& camera);

/// `camera` moved back if a narrow picture (width / height = `aspect`) would cut off the arms of
/// the person in its middle (GroupFraming::min_width_m).
[[nodiscard]] Camera ForAspect(const Camera& camera, double aspect);

/// `camera` moved back if a narrow picture would cut off the sides of a scene's extent.
[[nodiscard]] Camera WithWholeExtent(const Camera& camera, double aspect);

/// Rotated about the vertical through its target, counter-clockwise seen from above.
[[nodiscard]] Camera Turned(const Camera& camera, double angle_rad);

/// GroundExtent with a dead zone: it does not move while the people stay near the picture centre,
/// and follows them smoothly when they leave it. A floor that stands still is more pleasant to
/// watch and far cheaper to render and encode. The same states give the same targets. One thread.
class SmoothedGroundExtent {
 public:
  /// Call it once per picture. The first people set the target at once; without people it does not
  /// move.
  const GroundExtent& Follow(const SceneState& state);

 private:
  bool has_people_ = false;
  GroundExtent about_;  // radius: of the group that fits into the view
};

struct Projected {
  double x_px = 0;      // from the left edge
  double y_px = 0;      // from the top edge
  double depth_m = 0;   // m, along the view axis; <= 0: behind the camera (perspective)
  double px_per_m = 0;  // size in the picture of 1 m at that depth, facing the camera
};

Projected Project(const Eigen::Vector3d& point_in_world, const Camera& camera, int width_px,
                  int height_px);

/// The point of the floor (z = 0, without end) that is seen at `x_px`, `y_px`; nullopt where the
/// camera sees none, or sees it from below.
std::optional<Eigen::Vector2d> FloorPointAt(double x_px, double y_px, const Camera& camera,
                                            int width_px, int height_px);

/// From a pixel (x, y, 1), from the upper left corner, to the point of the horizontal plane at the
/// height `z_m` that is seen there: (x, y, 1), world, m, times a factor that is positive in front
/// of the camera. nullopt where the plane is seen from below, or along it.
std::optional<Eigen::Matrix3d> PlaneFromPicture(const Camera& camera, int width_px, int height_px,
                                                double z_m);

}  // namespace kinescope::render
