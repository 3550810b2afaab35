#include "render/camera/framing.h"

#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;

constexpr int kDirections = 240;  // of a hull: neighbours are 15 degrees apart

constexpr double kObject = 0.12;  // m, of a tracked object, whose shape is not known

std::vector<Ball> InAxes(const Eigen::Matrix3d& axes, std::vector<Ball> balls) {
  for (Ball& ball : balls) ball.center = axes * ball.center;
  return balls;
}

// A free area in the picture: x to the right, y up, -1..1 at its edges.
struct Window {
  double left = -1, right = 1, down = -1, up = 1;
};

Window WindowOf(const PictureRect& rect) {
  return {2 * rect.left - 1, 2 * rect.right - 1, 1 - 2 * rect.bottom, 1 - 2 * rect.top};
}

std::vector<Window> CornersOf(const FreeArea& area) {
  std::vector<Window> corners;
  for (const PictureRect& corner : area.corners) corners.push_back(WindowOf(corner));
  return corners;
}

// The middle part of it that is to be filled.
Window Filled(const Window& window, double share) {
  const double x = 0.5 * (1 - share) * (window.right - window.left);
  const double y = 0.5 * (1 - share) * (window.up - window.down);
  return {window.left + x, window.right - x, window.down + y, window.up - y};
}

// Where the eye is on one side's axis, and its depth, if all balls are between two planes through
// it with the slopes low (negative: to that side) and high.
struct Seat {
  double low_side, high_side;  // of the planes at depth 0
  double low, high;

  double depth() const { return -(high_side - low_side) / (high - low); }
  double At(double depth) const {
    return 0.5 * (high_side + high * depth + low_side + low * depth);
  }
};

// `balls`: in the camera's axes.
Seat SeatOf(const std::vector<Ball>& balls, int axis, double low, double high) {
  Seat seat{1e300, -1e300, low, high};
  const double above = std::hypot(1, high), below = std::hypot(1, low);
  for (const Ball& ball : balls) {
    const double side = ball.center[axis], depth = ball.center.z();
    seat.high_side = std::max(seat.high_side, side - high * depth + ball.radius * above);
    seat.low_side = std::min(seat.low_side, side - low * depth - ball.radius * below);
  }
  return seat;
}

// The camera in its own axes.
struct Place {
  Vector3d eye;
  double ortho_height = 0;  // m; 0: perspective
  double slope = 0;         // of half the picture's height

  // m, of the picture at this depth.
  double half_height(double depth) const {
    return ortho_height > 0 ? 0.5 * ortho_height : slope * std::max(depth - eye.z(), 1e-6);
  }
  // The larger, the smaller things are.
  double smallness(double depth) const { return ortho_height > 0 ? ortho_height : depth - eye.z(); }
};

Place PlaceOf(const Camera& camera, const std::vector<Ball>& balls, double aspect,
              const Window& window) {
  if (camera.is_orthographic()) {
    Vector3d low = Vector3d::Constant(1e300), high = -low;
    for (const Ball& ball : balls) {
      low = low.cwiseMin(ball.center - Vector3d::Constant(ball.radius));
      high = high.cwiseMax(ball.center + Vector3d::Constant(ball.radius));
    }
    const Vector3d size = high - low, middle = 0.5 * (low + high);
    Place place;
    place.ortho_height = std::max({2 * size.y() / (window.up - window.down),
                                   2 * size.x() / (aspect * (window.right - window.left)), 0.02});
    const double half = 0.5 * place.ortho_height;
    place.eye = {middle.x() - half * aspect * 0.5 * (window.left + window.right),
                 middle.y() - half * 0.5 * (window.down + window.up),
                 middle.z() - std::max(2 * place.ortho_height, size.z())};
    return place;
  }
  const double slope = std::tan(0.5 * camera.vertical_fov_rad);
  const Seat across = SeatOf(balls, 0, slope * aspect * window.left, slope * aspect * window.right);
  const Seat upright = SeatOf(balls, 1, slope * window.down, slope * window.up);
  const double depth = std::min(across.depth(), upright.depth());
  return {{across.At(depth), upright.At(depth), depth}, 0, slope};
}

// What of the picture a ball covers.
Window ShownAt(const Place& place, const Ball& ball, double aspect) {
  const Vector3d from_eye = ball.center - place.eye;
  const double half = place.half_height(ball.center.z());
  const double x = from_eye.x() / (half * aspect), y = from_eye.y() / half;
  const double across = ball.radius / (half * aspect), upright = ball.radius / half;
  return {x - across, x + across, y - upright, y + upright};
}

bool Overlaps(const Window& a, const Window& b) {
  return a.left < b.right && b.left < a.right && a.down < b.up && b.down < a.up;
}

Window ShownAround(const Place& place, const std::vector<Ball>& balls, double aspect) {
  Window around{1e300, -1e300, 1e300, -1e300};
  for (const Ball& ball : balls) {
    const Window shown = ShownAt(place, ball, aspect);
    around = {std::min(around.left, shown.left), std::max(around.right, shown.right),
              std::min(around.down, shown.down), std::max(around.up, shown.up)};
  }
  return around;
}

bool Covers(const Place& place, const std::vector<Ball>& balls, double aspect, const Window& corner,
            bool is_box) {
  if (is_box) return Overlaps(ShownAround(place, balls, aspect), corner);
  return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return Overlaps(ShownAt(place, ball, aspect), corner);
  });
}

// `window` without a corner, along one axis: `low` and `high` are its ends.
Window Past(const Window& corner, double Window::*low, double Window::*high, Window window) {
  if (corner.*low + corner.*high < 0) {
    window.*low = std::max(window.*low, corner.*high);
  } else {
    window.*high = std::min(window.*high, corner.*low);
  }
  return window;
}
Window Beside(const Window& window, const Window& corner) {
  return Past(corner, &Window::left, &Window::right, window);
}
Window AboveOrBelow(const Window& window, const Window& corner) {
  return Past(corner, &Window::down, &Window::up, window);
}

// Beside or above each corner that is in the way: whichever shows things larger. `depth`: of their
// middle.
Place BestPlace(const Camera& camera, const std::vector<Ball>& balls, double aspect,
                const Window& whole, std::vector<Window> corners, const Filling& filling,
                double depth) {
  Place best = PlaceOf(camera, balls, aspect, Filled(whole, filling.share));
  std::vector<Window> hit;
  while (true) {
    const auto in_the_way = std::find_if(corners.begin(), corners.end(), [&](const Window& corner) {
      return Covers(best, balls, aspect, corner, filling.is_box);
    });
    if (in_the_way == corners.end()) return best;
    hit.push_back(*in_the_way);
    corners.erase(in_the_way);
    bool is_first = true;
    for (unsigned choice = 0; choice < 1U << hit.size(); ++choice) {
      Window window = whole;
      for (std::size_t i = 0; i < hit.size(); ++i) {
        const bool is_beside = (choice >> i & 1U) == 0;
        window = is_beside ? Beside(window, hit[i]) : AboveOrBelow(window, hit[i]);
      }
      if (window.right - window.left < 0.1 || window.up - window.down < 0.1) continue;
      const Place place = PlaceOf(camera, balls, aspect, Filled(window, filling.share));
      if (!is_first && place.smallness(depth) >= best.smallness(depth)) continue;
      best = place;
      is_first = false;
    }
  }
}

}  // namespace

Eigen::Matrix3d AxesOf(const Camera& camera) {
  const glm::dmat4 view = ViewFromWorld(camera);
  Eigen::Matrix3d axes;
  for (int axis = 0; axis < 3; ++axis) {
    axes(0, axis) = view[axis][0];
    axes(1, axis) = view[axis][1];
    axes(2, axis) = -view[axis][2];
  }
  return axes;
}

std::vector<Ball> BallsOf(const SceneState& state) {
  std::vector<Ball> balls;
  for (const PersonState* person : FramedPeople(state)) {
    const std::vector<Ball> of_person = BallsOf(*person);
    balls.insert(balls.end(), of_person.begin(), of_person.end());
  }
  for (const TrackedObject& object : state.objects)
    balls.push_back({object.pose.position, kObject});
  for (const RobotState& robot : state.robots) {
    if (robot.bounds.isEmpty()) {
      for (const Eigen::Isometry3d& link : robot.world_from_link) {
        balls.push_back({link.translation(), 0});
      }
      continue;
    }
    for (int i = 0; i < 8; ++i) {
      balls.push_back({robot.bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)), 0});
    }
  }
  balls.erase(std::remove_if(balls.begin(), balls.end(),
                             [](const Ball& ball) {
                               return !ball.center.allFinite() || !std::isfinite(ball.radius);
                             }),
              balls.end());
  return balls;
}

BallHull::BallHull() : farthest_(kDirections) {
  // Evenly spread on a sphere: Fibonacci's lattice.
  const double golden = M_PI * (3 - std::sqrt(5));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2.0 * i + 1) / kDirections, ring = std::sqrt(1 - z * z);
    directions_.emplace_back(ring * std::cos(golden * i), ring * std::sin(golden * i), z);
  }
}

void BallHull::Add(const Ball& ball) {
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    Ball& farthest = farthest_[i];
    if (is_empty_ ||
        directions_[i].dot(ball.center - farthest.center) + ball.radius > farthest.radius) {
      farthest = ball;
    }
  }
  is_empty_ = false;
}

std::vector<Ball> BallHull::balls() const { return is_empty_ ? std::vector<Ball>() : farthest_; }

Camera Framing(const Camera& camera, const std::vector<Ball>& balls, double aspect,
               const FreeArea& area, const Filling& filling) {
  KINESCOPE_CHECK(!balls.empty() && aspect > 0);
  const Eigen::Matrix3d axes = AxesOf(camera);
  const std::vector<Ball> seen = InAxes(axes, balls);
  double low = 1e300, high = -low;
  for (const Ball& ball : seen) {
    low = std::min(low, ball.center.z());
    high = std::max(high, ball.center.z());
  }
  const double middle = 0.5 * (low + high);
  const Place best =
      BestPlace(camera, seen, aspect, WindowOf(area.free), CornersOf(area), filling, middle);
  Camera framed = camera;
  if (best.ortho_height > 0) framed.ortho_height_m = best.ortho_height;
  const double distance = std::max(middle - best.eye.z(), 0.02);
  framed.position = axes.transpose() * best.eye;
  framed.target = framed.position + distance * axes.row(2).transpose();
  framed.near_m = std::min(camera.near_m, 0.02 * distance);
  framed.far_m = std::max(camera.far_m, 4 * distance);
  return framed;
}

bool AreWithin(const Camera& camera, const std::vector<Ball>& balls, double aspect,
               const FreeArea& area, double share) {
  const Eigen::Matrix3d axes = AxesOf(camera);
  const Place place{axes * camera.position, camera.ortho_height_m,
                    std::tan(0.5 * camera.vertical_fov_rad)};
  const Window window = Filled(WindowOf(area.free), share);
  const Window shown = ShownAround(place, InAxes(axes, balls), aspect);
  const std::vector<Window> corners = CornersOf(area);
  return shown.left >= window.left && shown.right <= window.right && shown.down >= window.down &&
         shown.up <= window.up &&
         std::none_of(corners.begin(), corners.end(),
                      [&](const Window& corner) { return Overlaps(shown, corner); });
}

double StepBesideCorners(const Camera& camera, const std::vector<Ball>& balls, double aspect,
                         const FreeArea& area) {
  const Eigen::Matrix3d axes = AxesOf(camera);
  const Place place{axes * camera.position, camera.ortho_height_m,
                    std::tan(0.5 * camera.vertical_fov_rad)};
  const std::vector<Ball> in_axes = InAxes(axes, balls);
  const Window shown = ShownAround(place, in_axes, aspect), whole = WindowOf(area.free);
  Window free = whole;
  for (const Window& corner : CornersOf(area)) {
    if (corner.down < shown.up && shown.down < corner.up) free = Beside(free, corner);
  }
  if (free.left == whole.left && free.right == whole.right) return 0;
  double to_right = -1e300, to_left = -1e300;  // m, that people must go at least
  for (const Ball& ball : in_axes) {
    const Window at = ShownAt(place, ball, aspect);
    const double metres = aspect * place.half_height(ball.center.z());
    to_right = std::max(to_right, metres * (free.left - at.left));
    to_left = std::max(to_left, metres * (at.right - free.right));
  }
  if (to_right + to_left > 0) return 0.5 * (to_right - to_left);
  return to_right > 0 ? to_right : std::min(-to_left, 0.0);
}

}  // namespace kinescope::render
