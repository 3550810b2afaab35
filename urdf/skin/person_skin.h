/// The skin of one person: the template of their build, fitted to their measured lengths, and posed
/// by linear blending of the frames (frames.h); folds press against each other (contact.h). Every
/// frame turns about a measured joint centre. World, metres. Immutable once made; Pose() may be
/// called by one thread at a time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "urdf/hand.h"
#include "urdf/kinematics.h"
#include "urdf/skeleton.h"
#include "urdf/skin/bind_pose.h"
#include "urdf/skin/contact.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

class PersonSkin {
 public:
  /// `gloves`: the hands whose fingers will be posed; null: fingers stay as in the bind pose.
  PersonSkin(const SkinTemplate& skin, const Build& build, const urdf::Skeleton& skeleton,
             const std::array<const urdf::HandSkeleton*, 2>& gloves = {});

  struct Surface {
    std::vector<Eigen::Vector3f> positions, normals;  // normals: unit, outwards
  };
  /// Writes to `surface`, whose memory is reused. `fingers`: by urdf::Side, of the gloves.
  void Pose(const urdf::LinkPoses& links, const std::array<const urdf::FingerPoses*, 2>& fingers,
            Surface& surface) const;

  const std::vector<Triangle>& triangles() const { return skin_.triangles; }
  /// In the person's own bind pose.
  const std::vector<Eigen::Vector3f>& rest() const { return rest_; }
  const BindPose& bind() const { return bind_; }
  /// The frames of the bind pose, in the order of Frames().
  const std::vector<urdf::Pose>& bind_frames() const { return bind_frames_; }

 private:
  const SkinTemplate& skin_;
  BindPose bind_;
  std::vector<urdf::Pose> bind_frames_;
  std::vector<Eigen::Vector3f> rest_;
  std::array<FoldShape, kFolds> folds_;
  std::array<std::vector<FoldVertex>, kFolds> fold_vertices_;
};

}  // namespace kinescope::skin
