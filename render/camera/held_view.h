/// The camera of a live picture: people fill most of what the picture has free, but it seldom
/// moves. World, metres. HeldView: one thread; the functions: any thread.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "core/person_outline.h"
#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/camera/framing.h"

namespace kinescope::render {

/// Around people, of one moment or of several: the balls that may touch a side of a picture. In the
/// axes of a camera (right, up, forward), from the people's middle on the floor.
class ViewHull {
 public:
  void Add(const Ball& ball);
  void Add(const ViewHull& other);

  bool is_empty() const { return balls_.empty(); }
  const std::vector<Ball>& balls() const { return balls_; }
  double half_width() const;  // m, of the wider side

 private:
  std::vector<Ball> balls_;  // the farthest, by direction; empty, or one for each
};

/// What a picture in the direction of `camera` must show. Without people: the height of a standing
/// adult with arms overhead. What is more than 3 m away from its person is left out.
ViewHull NeededHull(const SceneState& state, const Camera& camera);

/// The shape of a picture.
struct ViewShape {
  double aspect = 16.0 / 9;  // width / height
  FreeArea area = {};
};

/// Where a camera is, in its own axes, from the middle of the people on the floor.
struct ViewPlace {
  double right = 0, up = 0;  // m, of the middle of the picture
  double height = 0;         // m, of what the picture shows there
};

/// Shows the hull as large as a live picture has it. The shown height is at least 0.9 m.
/// @pre !hull.is_empty()
ViewPlace PlaceFor(const ViewHull& hull, const Camera& camera, const ViewShape& shape);

/// `camera` moved there, without rotation.
[[nodiscard]] Camera MovedTo(const ViewPlace& place, const Camera& camera,
                             const Eigen::Vector3d& middle);

/// `place`, so far to the side that people who have gone away from the middle are not covered.
/// @param away  from the middle to that of the people, m; world
ViewPlace BesideCorners(ViewPlace place, const ViewHull& people, const Eigen::Vector3d& away,
                        const Camera& camera, const ViewShape& shape);

/// Shows what was needed during the last two seconds. It goes over to more as soon as people would
/// fill more than 85 % of what is free, or be covered, and slowly to less where they fill less than
/// 65 %. If that was too soon, because they rise again, it waits twice as long the next time: who
/// lifts boxes is not zoomed in and out.
class HeldView {
 public:
  /// Call it once per picture. @param secs of the picture; if it goes back, what was before is
  /// forgotten
  const ViewPlace& Follow(const ViewHull& needed, const Camera& camera, const ViewShape& shape,
                          double secs);

  /// What it shows, for a picture of another shape.
  const ViewHull& shown() const { return shown_; }

 private:
  struct Seen {
    double secs;
    ViewHull needed;
  };

  ViewHull Recent(const ViewHull& needed, double secs);
  void LearnToWait(const ViewPlace& goal, bool is_too_much, double secs);
  void GlideTo(const ViewPlace& goal, double stiffness, double dt);

  std::deque<Seen> seen_;  // the oldest first
  ViewHull shown_;
  ViewPlace held_, speed_;  // speed_: m/s
  double at_secs_ = 0;
  double wait_ = 0;              // s, for which what was needed is shown
  double came_nearer_at_ = 0;    // s
  double came_nearer_from_ = 0;  // m
  bool may_regret_ = false;      // it came nearer, and has not gone back
  bool is_gliding_ = false;
};

}  // namespace kinescope::render
