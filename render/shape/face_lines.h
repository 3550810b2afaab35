/// The lines of a face that are no outlines: brows, lids, nose and mouth of the built-in skin,
/// where urdf/skin/make shaped them. Pure functions of immutable data, any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/shape/line_chain.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::render {

class FaceLines {
 public:
  /// `skin`: the built-in one or a coarser one.
  FaceLines(const skin::SkinTemplate& skin, const skin::Build& build);

  /// @param positions of the posed skin's vertices, m
  std::vector<SurfaceLine> On(const std::vector<Eigen::Vector3f>& positions) const;

 private:
  struct PointOnTriangle {
    skin::Triangle triangle;
    Eigen::Vector3f shares;  // of its vertices
  };
  std::vector<std::vector<PointOnTriangle>> lines_;
};

}  // namespace kinescope::render
