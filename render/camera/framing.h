/// What a picture must show, and the camera that shows it as large as the picture allows. World,
/// metres. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/person_outline.h"
#include "core/scene_state.h"
#include "render/camera/camera.h"

namespace kinescope::render {

/// Balls whose common hull is around all visible people, what they hold, objects and robots; empty
/// without any. People who are not framed (GroupFraming::reach_m) are left out.
std::vector<Ball> BallsOf(const SceneState& state);

/// The balls of many moments, but only those that may touch a side of a picture.
class BallHull {
 public:
  BallHull();
  void Add(const Ball& ball);
  /// Empty if none was added.
  std::vector<Ball> balls() const;

 private:
  std::vector<Eigen::Vector3d> directions_;
  std::vector<Ball> farthest_;  // by direction
  bool is_empty_ = true;
};

/// Axes of the camera in the world: right, up, forward; the rows.
Eigen::Matrix3d AxesOf(const Camera& camera);

/// A rectangle in a picture, as shares of its width and height; from the left and from the top.
struct PictureRect {
  double left = 0, top = 0, right = 1, bottom = 1;
};

/// Where a picture has room for people.
struct FreeArea {
  PictureRect free;                  // between what goes from side to side
  std::vector<PictureRect> corners;  // covered parts of it: a legend, a time code
};

/// Share of the free height or width that Framing() fills.
inline constexpr double kFilled = 0.85;

/// How Framing() fills it.
struct Filling {
  double share = kFilled;
  bool is_box = false;  // the rectangle around all balls is kept out of covered corners, not each
                        // ball: for balls of a hull, which leaves out what is between them
};

/// `camera` moved, without rotation, so that the balls fill the free area, and none of them is in a
/// covered corner. @pre !balls.empty(), aspect > 0 (width / height)
[[nodiscard]] Camera Framing(const Camera& camera, const std::vector<Ball>& balls, double aspect,
                             const FreeArea& area = {}, const Filling& filling = {});

/// Whether the rectangle around all balls is within that share of the free area, and in no covered
/// corner, as `camera` shows them.
bool AreWithin(const Camera& camera, const std::vector<Ball>& balls, double aspect,
               const FreeArea& area, double share);

/// How far `camera` must go to its left so that the rectangle around all balls is beside the
/// covered corners that are at its height, m; negative: to its right. Without room between them, it
/// comes into their middle.
double StepBesideCorners(const Camera& camera, const std::vector<Ball>& balls, double aspect,
                         const FreeArea& area);

}  // namespace kinescope::render
