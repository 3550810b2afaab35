#include "urdf/rig/skin_glb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

#include "urdf/rig/frame_names.h"
#include "urdf/rig/glb_writer.h"
#include "urdf/segments.h"
#include "urdf/skin/frames.h"

namespace kinescope::rig {
namespace {

using Eigen::Affine3d;
using nlohmann::json;
using urdf::At;

// The segment that a frame's bone hangs on; -1: none.
int ParentOf(int frame) {
  const skin::Frame& of = skin::Frames()[At(frame)];
  switch (of.kind) {
    case skin::FrameKind::kSegment:
    case skin::FrameKind::kSwing: return urdf::kSegments[At(of.segment)].parent;
    default: return of.segment;
  }
}

double ToLinear(std::uint8_t channel) {
  const double srgb = channel / 255.0;
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

class SkinWriter {
 public:
  SkinWriter(const skin::PersonSkin& person, const skin::SkinTemplate& of,
             const std::vector<skin::SkinTemplate::Color>& colors, const SkinGlbOptions& options)
      : person_(person), of_(of), colors_(colors), options_(options) {
    if (options.posture) {
      bind_place_ = options.posture->links[urdf::kPelvis].position;
      return;
    }
    float lowest = 0;
    for (const Eigen::Vector3f& p : person.rest()) lowest = std::min(lowest, p.z());
    bind_place_.z() = -static_cast<double>(lowest);
  }

  std::string Write() {
    if (options_.has_skeleton) {
      AddBones();
    } else {
      document_["nodes"] = {{{"name", "Person"}, {"mesh", 0}}};
      document_["scenes"] = {{{"nodes", {0}}}};
    }
    AddSurface();
    return glb_.Write();
  }

 private:
  static Affine3d InFile(const urdf::Pose& pose, const Eigen::Vector3d& place) {
    Affine3d world = Affine3d::Identity();
    world.linear() = GlbAxes() * pose.orientation.toRotationMatrix();
    world.translation() = GlbAxes() * (pose.position + place);
    return world;
  }
  Affine3d BindOf(int frame) const { return InFile(person_.bind_frames()[At(frame)], bind_place_); }

  void AddBones() {
    json nodes = json::array(), bones = json::array();
    std::vector<float> binds;
    const int frames = static_cast<int>(skin::Frames().size());
    std::vector<Affine3d> shown;
    if (options_.posture) {
      for (const urdf::Pose& pose :
           skin::FramePoses(options_.posture->links, options_.posture->fingers, person_.bind())) {
        shown.push_back(InFile(pose, Eigen::Vector3d::Zero()));
      }
    } else {
      for (int frame = 0; frame < frames; ++frame) shown.push_back(BindOf(frame));
    }
    for (int frame = 0; frame < frames; ++frame) {
      const int parent = ParentOf(frame);
      const Affine3d& world = shown[At(frame)];
      const Affine3d local = parent < 0 ? world : shown[At(parent)].inverse() * world;
      const Eigen::Quaterniond turn(local.linear());
      nodes.push_back({{"name", NameOfFrame(frame)},
                       {"translation", std::vector<double>(local.translation().begin(),
                                                           local.translation().end())},
                       {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}});
      bones.push_back(frame);
      const Eigen::Matrix4d bind = BindOf(frame).inverse().matrix();
      for (int k = 0; k < 16; ++k) binds.push_back(static_cast<float>(bind(k % 4, k / 4)));
    }
    for (int frame = 1; frame < frames; ++frame) {
      nodes[At(ParentOf(frame))]["children"].push_back(frame);
    }
    nodes.push_back({{"name", "Person"}, {"mesh", 0}, {"skin", 0}});
    document_["nodes"] = std::move(nodes);
    document_["scenes"] = {{{"nodes", {0, frames}}}};
    document_["skins"] = {
        {{"joints", std::move(bones)},
         {"skeleton", 0},
         {"inverseBindMatrices", glb_.Add(binds, {GlbWriter::kFloat, "MAT4", 16})}}};
  }

  void AddSurface() {
    const bool is_posed = options_.posture && !options_.has_skeleton;
    const skin::BindPose& bind = person_.bind();
    skin::PersonSkin::Surface surface;
    if (is_posed) {
      person_.Pose(options_.posture->links, options_.posture->fingers, surface);
    } else {
      person_.Pose(bind.links, {&bind.fingers[0], &bind.fingers[1]}, surface);
      surface.positions = person_.rest();
    }
    std::vector<float> positions, normals;
    const Eigen::Vector3d place = is_posed ? Eigen::Vector3d(0, 0, 0) : bind_place_;
    for (const Eigen::Vector3f& p : surface.positions) {
      const Eigen::Vector3f at = (GlbAxes() * (p.cast<double>() + place)).cast<float>();
      positions.insert(positions.end(), at.begin(), at.end());
    }
    for (const Eigen::Vector3f& n : surface.normals) {
      const Eigen::Vector3f turned = GlbAxes().cast<float>() * n;
      normals.insert(normals.end(), turned.begin(), turned.end());
    }
    json attributes = {
        {"POSITION", glb_.AddPositions(positions)},
        {"NORMAL", glb_.Add(normals, {GlbWriter::kFloat, "VEC3", 3, GlbWriter::kOfVertices})}};
    if (options_.has_skeleton) AddWeights(attributes);
    // A part for each colour.
    std::map<skin::SkinTemplate::Color, std::vector<std::uint16_t>> parts;
    for (std::size_t i = 0; i < of_.triangles.size(); ++i) {
      std::vector<std::uint16_t>& part = parts[colors_[i]];
      part.insert(part.end(), of_.triangles[i].begin(), of_.triangles[i].end());
    }
    json primitives = json::array();
    for (const auto& [color, corners] : parts) {
      document_["materials"].push_back(
          {{"pbrMetallicRoughness",
            {{"baseColorFactor", {ToLinear(color[0]), ToLinear(color[1]), ToLinear(color[2]), 1}},
             {"metallicFactor", 0},
             {"roughnessFactor", 0.8}}}});
      primitives.push_back({{"attributes", attributes},
                            {"indices", glb_.Add(corners, {GlbWriter::kUnsignedShort, "SCALAR", 1,
                                                           GlbWriter::kOfIndices})},
                            {"material", document_["materials"].size() - 1}});
    }
    document_["meshes"] = {{{"name", "Person"}, {"primitives", std::move(primitives)}}};
  }

  void AddWeights(json& attributes) {
    std::vector<std::uint8_t> joints, weights;
    for (const skin::VertexWeights& vertex : of_.weights) {
      for (std::size_t k = 0; k < skin::kInfluences;
           ++k) {  // unused ones are bone 0, as glTF wants
        joints.push_back(vertex.weights[k] > 0 ? vertex.frames[k] : std::uint8_t{0});
        weights.push_back(vertex.weights[k]);
      }
    }
    attributes["JOINTS_0"] =
        glb_.Add(joints, {GlbWriter::kUnsignedByte, "VEC4", 4, GlbWriter::kOfVertices});
    attributes["WEIGHTS_0"] =
        glb_.Add(weights, {GlbWriter::kUnsignedByte, "VEC4", 4, GlbWriter::kOfVertices});
    document_["accessors"][attributes["WEIGHTS_0"].get<std::size_t>()]["normalized"] = true;
  }

  const skin::PersonSkin& person_;
  const skin::SkinTemplate& of_;
  const std::vector<skin::SkinTemplate::Color>& colors_;
  const SkinGlbOptions& options_;
  /// Of the bind pose's pelvis, world, m: without a posture, so that the soles are on the floor.
  Eigen::Vector3d bind_place_ = Eigen::Vector3d::Zero();
  GlbWriter glb_;
  json& document_ = glb_.document();
};

}  // namespace

std::string WriteSkinGlb(const skin::PersonSkin& person, const skin::SkinTemplate& of,
                         const std::vector<skin::SkinTemplate::Color>& colors,
                         const SkinGlbOptions& options) {
  return SkinWriter(person, of, colors, options).Write();
}

}  // namespace kinescope::rig
