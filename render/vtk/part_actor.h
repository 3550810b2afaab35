/// Renders a mesh whose parts move independently: a body of 23 segments, marks on the floor,
/// shadows.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "render/camera/picture_region.h"
#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

class PartActor {
 public:
  enum class Light {
    kLit,
    kLitAtVertices,  // as kLit where triangles are a few pixels wide, for a fraction of the time
    kFlat,
    kFlatBelow,  // as kFlat, but farther than it is: 2 cm at 10 m, 10 cm at 22 m, as RViz's maps
    kBelowThat,  // twice as much
    kSoft,       // unlit, fades out from the part's origin to radius 1 around its z axis
  };

  static constexpr std::size_t kMaxParts = 32;  // length of the array in the shader

  /// @pre 1 <= part_count <= kMaxParts
  PartActor(Pass pass, Light light, int part_count);

  /// With one part, the parts of the mesh do not matter: they may be numbers of anything.
  void SetMesh(const urdf::Mesh& mesh);
  void SetCulling(bool is_on) { shaded_.SetCulling(is_on); }

  /// world_from_part. Hidden parts have a zero matrix. Takes effect with Commit.
  void Place(int part, const Eigen::Affine3d& world_from_part);
  void Hide(int part);

  /// One colour that replaces those of the vertices; alpha is its weight. Takes effect with Commit.
  void SetOverride(const Eigen::Vector4f& color) { override_ = color; }
  /// Factor for the opacity of every vertex. Takes effect with Commit.
  void SetOpacity(float opacity) { opacity_ = opacity; }
  void Commit();

  vtkActor* actor() { return shaded_.actor(); }
  /// Around each part, in its frame; empty: the mesh has nothing of it.
  const std::vector<Eigen::AlignedBox3f>& boxes() const { return boxes_; }
  /// Of the parts as placed, if the actor is visible.
  void AddTo(PictureRegion& region) const;

 private:
  ShadedActor shaded_;
  std::vector<Eigen::Matrix4f> world_from_part_;
  std::vector<Eigen::AlignedBox3f> boxes_;  // by part, in its frame
  Eigen::Vector4f override_ = Eigen::Vector4f::Zero();
  float opacity_ = 1;
};

}  // namespace kinescope::render
