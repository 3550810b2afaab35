/// What a picture of a posed figure shows, pixel by pixel, without a renderer: which segment, which
/// side of its faces, and what lies directly behind. Parallel light of sight; metres, world frame.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "urdf/body_surface.h"
#include "urdf/kinematics.h"

namespace kinescope::urdf::testing {

/// A surface where the line of sight through a pixel meets it.
struct Hit {
  double depth = std::numeric_limits<double>::infinity();  // away from the eye
  int segment = -1;                                        // -1: none
  bool is_back = false;                                    // seen from within
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();        // as a viewer shades it
};

struct Pixel {
  Hit front;   // what one sees
  Hit behind;  // the nearest of any other segment
};

/// A window onto the world, seen along `-to_eye`, with `meters_per_pixel`; `center` is in its
/// middle.
class Pixels {
 public:
  Pixels(const Eigen::Vector3d& center, const Eigen::Vector3d& to_eye, const Eigen::Vector3d& up,
         int width, int height, double meters_per_pixel)
      : width_(width), height_(height), meters_(meters_per_pixel), center_(center) {
    const Eigen::Vector3d z = to_eye.normalized();
    const Eigen::Vector3d x = up.cross(z).normalized();
    eye_from_world_ << x.transpose(), z.cross(x).transpose(), z.transpose();
    pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }

  int width() const { return width_; }
  int height() const { return height_; }
  const Pixel& at(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }

  /// Pixels from the left and from the top; the depth as third.
  Eigen::Vector3d Project(const Eigen::Vector3d& point_in_world) const {
    const Eigen::Vector3d eye = eye_from_world_ * (point_in_world - center_);
    return {0.5 * width_ + eye.x() / meters_, 0.5 * height_ - eye.y() / meters_, -eye.z()};
  }

  void Draw(const TriangleMesh& mesh, const Pose& pose, int segment) {
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector3f> normals;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      points.push_back(Project(pose.position + pose.orientation * mesh.vertices[i].cast<double>()));
      normals.push_back(pose.orientation.cast<float>() * mesh.normals[i]);
    }
    for (const auto& triangle : mesh.triangles) {
      const auto& [a, b, c] = triangle;
      DrawTriangle({points[a], points[b], points[c]}, {normals[a], normals[b], normals[c]},
                   segment);
    }
  }

 private:
  // Twice the area that p, q and r span in the picture; positive clockwise, since y runs down.
  static double Span(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  }

  void DrawTriangle(const std::array<Eigen::Vector3d, 3>& at,
                    const std::array<Eigen::Vector3f, 3>& normals, int segment) {
    const double area = Span(at[0], at[1], at[2]);
    if (area == 0) return;
    const auto [left, right] = std::minmax({at[0].x(), at[1].x(), at[2].x()});
    const auto [top, bottom] = std::minmax({at[0].y(), at[1].y(), at[2].y()});
    const int first_x = std::max(0, static_cast<int>(std::ceil(left - 0.5)));
    const int last_x = std::min(width_ - 1, static_cast<int>(std::floor(right - 0.5)));
    const int first_y = std::max(0, static_cast<int>(std::ceil(top - 0.5)));
    const int last_y = std::min(height_ - 1, static_cast<int>(std::floor(bottom - 0.5)));
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) {
        const Eigen::Vector3d middle(x + 0.5, y + 0.5, 0);
        const double a = Span(at[1], at[2], middle) / area;
        const double b = Span(at[2], at[0], middle) / area;
        const double c = Span(at[0], at[1], middle) / area;
        if (a < 0 || b < 0 || c < 0) continue;
        Hit hit;
        hit.depth = a * at[0].z() + b * at[1].z() + c * at[2].z();
        hit.segment = segment;
        hit.is_back = area > 0;
        hit.normal = (static_cast<float>(a) * normals[0] + static_cast<float>(b) * normals[1] +
                      static_cast<float>(c) * normals[2])
                         .normalized();
        Add(hit, pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(x)]);
      }
    }
  }

  static void Add(const Hit& hit, Pixel& pixel) {
    if (hit.depth < pixel.front.depth) {
      if (hit.segment != pixel.front.segment) pixel.behind = pixel.front;
      pixel.front = hit;
    } else if (hit.segment != pixel.front.segment && hit.depth < pixel.behind.depth) {
      pixel.behind = hit;
    }
  }

  const int width_, height_;
  const double meters_;
  const Eigen::Vector3d center_;
  Eigen::Matrix3d eye_from_world_;
  std::vector<Pixel> pixels_;
};

}  // namespace kinescope::urdf::testing
