#include "urdf/skin/person_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "urdf/skin/frames.h"
#include "urdf/turn_between.h"

namespace kinescope::skin {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

// x -> linear * x + offset. Four floats a column, as the processor likes it.
struct Affine {
  Eigen::Matrix<float, 4, 3> linear = Eigen::Matrix<float, 4, 3>::Zero();
  Eigen::Vector4f offset = Eigen::Vector4f::Zero();
};

Affine ToAffine(const Matrix3d& linear, const Vector3d& offset) {
  Affine affine;
  affine.linear.topRows<3>() = linear.cast<float>();
  affine.offset.head<3>() = offset.cast<float>();
  return affine;
}

void Carry(const std::vector<VertexWeights>& weights, const std::vector<Affine>& frames,
           const std::vector<Vector3f>& from, std::vector<Vector3f>& to) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    const VertexWeights& vertex = weights[i];
    Affine blend;
    for (std::size_t k = 0; k < kInfluences && vertex.weights[k] > 0; ++k) {
      const float weight = static_cast<float>(vertex.weights[k]) * (1.0f / 255);
      const Affine& frame = frames[vertex.frames[k]];
      blend.linear += weight * frame.linear;
      blend.offset += weight * frame.offset;
    }
    const Vector3f& p = from[i];
    const Eigen::Vector4f at = blend.linear.col(0) * p.x() + blend.linear.col(1) * p.y() +
                               blend.linear.col(2) * p.z() + blend.offset;
    to[i] = at.head<3>();
  }
}

// How a segment's tissue changes from the template's person to another: along the bone by the
// bone's length, around it by `girth`.
Matrix3d Stretch(const Vector3d& bone, const Vector3d& other, double girth) {
  if (bone.norm() < 1e-6 || other.norm() < 1e-6) return girth * Matrix3d::Identity();
  const Vector3d along = bone.normalized();
  const Matrix3d project = along * along.transpose();
  const Matrix3d scale =
      girth * (Matrix3d::Identity() - project) + other.norm() / bone.norm() * project;
  return urdf::TurnBetween(bone, other).toRotationMatrix() * scale;
}

Matrix3d StretchOf(int segment, const urdf::Skeleton& from, const urdf::Skeleton& to,
                   double girth) {
  switch (segment) {
    case urdf::kPelvis: {  // up to L5, and out to the hips
      const Vector3d& hip = from.origin_in_parent[urdf::kLeftUpperLeg];
      const Vector3d& other_hip = to.origin_in_parent[urdf::kLeftUpperLeg];
      Matrix3d stretch = Stretch(urdf::EndOf(from, segment), urdf::EndOf(to, segment), girth);
      stretch.col(1) *= std::clamp(other_hip.y() / (girth * hip.y()), 0.7, 1.4);
      return stretch;
    }
    case urdf::kRightFoot:
    case urdf::kLeftFoot: {  // forward to the ball, down to the heel
      const int toe = segment + 1;
      const auto side = segment == urdf::kLeftFoot ? urdf::kLeft : urdf::kRight;
      const Vector3d& ball = from.origin_in_parent[At(toe)];
      const Vector3d& other_ball = to.origin_in_parent[At(toe)];
      const Vector3d scale(other_ball.x() / ball.x(), girth,
                           to.heel_in_foot[side].z() / from.heel_in_foot[side].z());
      return scale.cwiseMax(0.5 * girth).cwiseMin(2 * girth).asDiagonal();
    }
    case urdf::kRightToe:
    case urdf::kLeftToe: {
      const auto side = segment == urdf::kLeftToe ? urdf::kLeft : urdf::kRight;
      const double length = to.toe_tip_in_toe[side].x() / from.toe_tip_in_toe[side].x();
      return Vector3d(std::clamp(length, 0.5 * girth, 2 * girth), girth, girth).asDiagonal();
    }
    default: return Stretch(urdf::EndOf(from, segment), urdf::EndOf(to, segment), girth);
  }
}

// Takes a point from the template's bind pose to the other person's.
Affine Refit(const Matrix3d& stretch, const urdf::Pose& from, const urdf::Pose& to) {
  const Matrix3d linear =
      to.orientation.toRotationMatrix() * stretch * from.orientation.conjugate().toRotationMatrix();
  return ToAffine(linear, to.position - linear * from.position);
}

Affine Between(const Affine& a, const Affine& b, double share) {
  const auto t = static_cast<float>(share);
  Affine blend;
  blend.linear = (1 - t) * a.linear + t * b.linear;
  blend.offset = (1 - t) * a.offset + t * b.offset;
  return blend;
}

// For each frame. A frame between two segments stretches by its share of both.
std::vector<Affine> RefitFrames(const BindPose& from, const BindPose& to,
                                const urdf::Skeleton& from_skeleton,
                                const urdf::Skeleton& to_skeleton,
                                const std::array<const urdf::HandSkeleton*, 2>& gloves) {
  const double stature = to_skeleton.height > 0 ? to_skeleton.height : from_skeleton.height;
  const double girth = stature / from_skeleton.height;
  std::array<Affine, urdf::kSegmentCount> segments;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    segments[At(segment)] = Refit(StretchOf(segment, from_skeleton, to_skeleton, girth),
                                  from.links[At(segment)], to.links[At(segment)]);
  }
  const auto finger_refit = [&](urdf::Side side, int finger) {
    const int hand = urdf::HandSegmentOf(side);
    const auto length = [&](const urdf::Skeleton& of) { return urdf::EndOf(of, hand).norm(); };
    const urdf::HandSkeleton own =
        gloves[side] != nullptr ? *gloves[side] : urdf::DefaultHand(side, length(to_skeleton));
    const urdf::HandSkeleton average = urdf::DefaultHand(side, length(from_skeleton));
    return Refit(Stretch(urdf::EndOf(average, finger), urdf::EndOf(own, finger), girth),
                 from.fingers[side][At(finger)], to.fingers[side][At(finger)]);
  };
  std::vector<Affine> all;
  all.reserve(Frames().size());
  for (const Frame& frame : Frames()) {
    const Affine& own = segments[At(frame.segment)];
    const auto side = frame.segment == urdf::kLeftHand ? urdf::kLeft : urdf::kRight;
    switch (frame.kind) {
      case FrameKind::kSegment:
      case FrameKind::kTwist: all.push_back(own); break;
      case FrameKind::kSwing: {
        const int parent = urdf::kSegments[At(frame.segment)].parent;
        all.push_back(Between(segments[At(parent)], own, frame.share));
        break;
      }
      case FrameKind::kFinger: all.push_back(finger_refit(side, frame.finger)); break;
      case FrameKind::kHalfFinger: {
        const int before = urdf::kFingerParents[At(frame.finger)];
        all.push_back(Between(HasFrames(before) ? finger_refit(side, before) : own,
                              finger_refit(side, frame.finger), 0.5));
        break;
      }
    }
  }
  return all;
}

// The cosine of the bend of a joint.
double BendOf(const urdf::LinkPoses& links, int segment) {
  const urdf::Pose& parent = links[At(urdf::kSegments[At(segment)].parent)];
  const Vector3d z = Vector3d::UnitZ();
  return (parent.orientation * z).dot(links[At(segment)].orientation * z);
}

// Presses flesh that is past the plane of a fold back to it, and widens flesh that is near it.
void Press(const FoldShape& fold, const std::vector<FoldVertex>& vertices, const Affine& frame,
           double bend, std::vector<Vector3f>& positions) {
  const auto contact = static_cast<float>(kContact.At(bend));
  const auto bulges = static_cast<float>(fold.bulges.At(bend));
  if (contact == 0 && bulges == 0) return;
  const Eigen::Matrix3f turn = frame.linear.topRows<3>();
  const Vector3f normal = turn * fold.normal.cast<float>(),
                 across = turn * fold.across.cast<float>(),
                 center = turn * fold.center.cast<float>() + frame.offset.head<3>();
  const auto softness = static_cast<float>(fold.softness);
  for (const FoldVertex& of : vertices) {
    Vector3f& p = positions[of.vertex];
    const Vector3f from_center = p - center;
    const float before = normal.dot(from_center);
    const float above = (of.side > 0 ? before : -before) - of.floor;
    const float past = std::max(-above, 0.0f);
    const float press = past * past / (softness + past);  // all but what stays past the plane
    const float wider = of.bulge * kBulgeReach / (kBulgeReach + std::max(above, 0.0f));
    p += contact * of.side * press * normal + bulges * wider * across.dot(from_center) * across;
  }
}

// The mean of the triangles of each vertex, by area.
void SetNormals(const std::vector<Vector3f>& positions, const std::vector<Triangle>& triangles,
                std::vector<Vector3f>& normals) {
  normals.assign(positions.size(), Vector3f::Zero());
  for (const Triangle& t : triangles) {
    const Vector3f& a = positions[t[0]];
    const Vector3f normal = (positions[t[1]] - a).cross(positions[t[2]] - a);
    for (const std::uint16_t corner : t) normals[corner] += normal;
  }
  for (Vector3f& normal : normals) {
    const float length = normal.norm();
    normal = length > 0 ? Vector3f(normal / length) : Vector3f::UnitZ();
  }
}

}  // namespace

PersonSkin::PersonSkin(const SkinTemplate& skin, const Build& build, const urdf::Skeleton& skeleton,
                       const std::array<const urdf::HandSkeleton*, 2>& gloves)
    : skin_(skin), bind_(BindPoseOf(skeleton, gloves)) {
  const urdf::Skeleton reference = urdf::DefaultSkeleton();
  const BindPose reference_bind = BindPoseOf(reference);
  Carry(skin_.weights, RefitFrames(reference_bind, bind_, reference, skeleton, gloves),
        skin_.Blend(build), rest_);
  bind_frames_ = FramePoses(bind_.links, {&bind_.fingers[0], &bind_.fingers[1]}, bind_);
  folds_ = FoldsOf(bind_, skeleton.height);
  for (std::size_t i = 0; i < kFolds; ++i) {
    fold_vertices_[i] = VerticesOf(folds_[i], rest_, skin_.weights);
  }
}

void PersonSkin::Pose(const urdf::LinkPoses& links,
                      const std::array<const urdf::FingerPoses*, 2>& fingers,
                      Surface& surface) const {
  const std::vector<urdf::Pose> now = FramePoses(links, fingers, bind_);
  std::vector<Affine> frames;
  frames.reserve(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Matrix3d turn =
        (now[i].orientation * bind_frames_[i].orientation.conjugate()).toRotationMatrix();
    frames.push_back(ToAffine(turn, now[i].position - turn * bind_frames_[i].position));
  }
  Carry(skin_.weights, frames, rest_, surface.positions);
  for (std::size_t i = 0; i < kFolds; ++i) {
    Press(folds_[i], fold_vertices_[i], frames[At(folds_[i].frame)],
          BendOf(links, folds_[i].segment), surface.positions);
  }
  SetNormals(surface.positions, skin_.triangles, surface.normals);
}

}  // namespace kinescope::skin
