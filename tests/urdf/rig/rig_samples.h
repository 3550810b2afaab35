/// Rigged people for tests, made from tubes and boxes: of any size, unit, axes and names.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kinescope::testing {

enum class BoneNames { kVrm1, kVrm0, kMixamo, kMvn };

struct RigSample {
  BoneNames names = BoneNames::kMixamo;
  double height = 1.75;        // m
  double units_per_metre = 1;  // 100: a rig in centimetres
  double arms_down_deg = 0;    // 0: T-pose, 45: A-pose
  double arm_stretch = 1;      // of the arms' lengths
  /// file_from_body; body: x forward, y left, z up. As glTF wants it: y up, z forward.
  Eigen::Matrix3d axes = (Eigen::Matrix3d() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished();
  int rings = 24;              // of a tube
  std::set<int> missing = {};  // bones, by their index in kRigBones
  /// Changes the document and the binary part before they are written.
  std::function<void(nlohmann::json& document, std::string& binary)> edit;
};

struct RigBone {
  const char *vrm, *mixamo, *mvn;
  int parent;
  double x, y, z;  // of the joint in the T-pose, body axes, m, of a person of 1.75 m
};

// The names of the right side are those of the left one.
inline constexpr std::array kRigBones = {
    RigBone{"hips", "Hips", "Pelvis", -1, 0, 0, 0.95},
    RigBone{"spine", "Spine", "L5", 0, 0, 0, 1.05},
    RigBone{"chest", "Spine1", "L3", 1, 0, 0, 1.15},
    RigBone{"upperChest", "Spine2", "T8", 2, 0, 0, 1.28},
    RigBone{"neck", "Neck", "Neck", 3, 0, 0, 1.47},
    RigBone{"head", "Head", "Head", 4, 0, 0, 1.56},
    RigBone{"leftShoulder", "LeftShoulder", "LeftShoulder", 3, 0, 0.05, 1.42},
    RigBone{"leftUpperArm", "LeftArm", "LeftUpperArm", 6, 0, 0.18, 1.42},
    RigBone{"leftLowerArm", "LeftForeArm", "LeftForeArm", 7, 0, 0.46, 1.42},
    RigBone{"leftHand", "LeftHand", "LeftHand", 8, 0, 0.71, 1.42},
    RigBone{"leftUpperLeg", "LeftUpLeg", "LeftUpperLeg", 0, 0, 0.09, 0.92},
    RigBone{"leftLowerLeg", "LeftLeg", "LeftLowerLeg", 10, 0, 0.09, 0.50},
    RigBone{"leftFoot", "LeftFoot", "LeftFoot", 11, 0, 0.09, 0.09},
    RigBone{"leftToes", "LeftToeBase", "LeftToe", 12, 0.14, 0.09, 0.02},
    RigBone{"rightShoulder", "RightShoulder", "RightShoulder", 3, 0, -0.05, 1.42},
    RigBone{"rightUpperArm", "RightArm", "RightUpperArm", 14, 0, -0.18, 1.42},
    RigBone{"rightLowerArm", "RightForeArm", "RightForeArm", 15, 0, -0.46, 1.42},
    RigBone{"rightHand", "RightHand", "RightHand", 16, 0, -0.71, 1.42},
    RigBone{"rightUpperLeg", "RightUpLeg", "RightUpperLeg", 0, 0, -0.09, 0.92},
    RigBone{"rightLowerLeg", "RightLeg", "RightLowerLeg", 18, 0, -0.09, 0.50},
    RigBone{"rightFoot", "RightFoot", "RightFoot", 19, 0, -0.09, 0.09},
    RigBone{"rightToes", "RightToeBase", "RightToe", 20, 0.14, -0.09, 0.02}};

class RigWriter {
 public:
  explicit RigWriter(const RigSample& sample) : sample_(sample) {}

  std::string Glb() {
    AddParts();
    nlohmann::json document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
    document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.3, 0.6, 1}}}}}};
    AddNodes(document);
    AddMesh(document);
    if (sample_.edit) sample_.edit(document, binary_);
    return Pack(document, binary_);
  }

  static std::string Pack(const nlohmann::json& document, const std::string& binary) {
    std::string json = document.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string glb = "glTF";
    const auto word = [&](std::size_t value) {
      const auto bits = static_cast<std::uint32_t>(value);
      glb.append(reinterpret_cast<const char*>(&bits), 4);
    };
    word(2);
    word(12 + 8 + json.size() + 8 + binary.size());
    word(json.size());
    word(0x4E4F534A);
    glb += json;
    word(binary.size());
    word(0x004E4942);
    return glb + binary;
  }

 private:
  using Vector3d = Eigen::Vector3d;

  // Of the bone in the pose of the file, body axes, m.
  Vector3d JointOf(std::size_t bone) const {
    const RigBone& of = kRigBones[bone];
    Vector3d at(of.x, of.y, of.z);
    const double side = at.y() < 0 ? -1 : 1;
    if (IsArm(bone)) at = Lowered(at, side);
    return sample_.height / 1.75 * at;
  }
  static bool IsArm(std::size_t bone) {
    return (bone > 6 && bone < 10) || (bone > 14 && bone < 18);
  }
  Vector3d Lowered(const Vector3d& at, double side) const {
    const Vector3d shoulder(0, side * 0.18, 1.42);
    const double down = sample_.arms_down_deg * M_PI / 180;
    return shoulder + Eigen::AngleAxisd(-side * down, Vector3d::UnitX()) *
                          (sample_.arm_stretch * (at - shoulder));
  }
  Vector3d ToFile(const Vector3d& body) const {
    return sample_.units_per_metre * (sample_.axes * body);
  }

  struct Corner {
    Vector3d position;
    std::array<std::uint16_t, 4> bones{};
    std::array<float, 4> weights{1, 0, 0, 0};
  };

  // Around the line through `joints`; each bone carries from its joint on, mixed near the joints.
  void AddTube(const std::vector<std::size_t>& bones, const std::vector<Vector3d>& line,
               double radius) {
    constexpr int kAround = 8;
    constexpr double kMixed = 0.04;
    std::vector<double> at = {0};
    for (std::size_t i = 1; i < line.size(); ++i) {
      at.push_back(at.back() + (line[i] - line[i - 1]).norm());
    }
    const auto first = static_cast<std::uint32_t>(corners_.size());
    const int rings = sample_.rings;
    for (int ring = 0; ring <= rings; ++ring) {
      const double along = at.back() * ring / rings;
      std::size_t piece = 0;
      while (piece + 2 < line.size() && along > at[piece + 1]) ++piece;
      const double t = (along - at[piece]) / (at[piece + 1] - at[piece]);
      const Vector3d middle = (1 - t) * line[piece] + t * line[piece + 1];
      const Vector3d ahead = (line[piece + 1] - line[piece]).normalized();
      const Vector3d up = std::abs(ahead.z()) > 0.9 ? Vector3d::UnitX() : Vector3d::UnitZ();
      const Vector3d side = ahead.cross(up).normalized(), out = side.cross(ahead);
      Corner corner;
      corner.bones[0] = static_cast<std::uint16_t>(bones[piece]);
      const auto mix = [&](std::size_t other, double share) {
        corner.bones[1] = static_cast<std::uint16_t>(bones[other]);
        corner.weights = {static_cast<float>(1 - share), static_cast<float>(share), 0, 0};
      };
      if (piece + 1 < bones.size() && at[piece + 1] - along < kMixed) {
        mix(piece + 1, 0.5 - 0.5 * (at[piece + 1] - along) / kMixed);
      } else if (piece > 0 && along - at[piece] < kMixed) {
        mix(piece - 1, 0.5 - 0.5 * (along - at[piece]) / kMixed);
      }
      const bool is_end = ring == 0 || ring == rings;
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2 * M_PI * i / kAround;
        const double r = is_end ? 0.3 * radius : radius;
        corner.position = middle + r * (std::cos(angle) * side + std::sin(angle) * out);
        corners_.push_back(corner);
      }
    }
    const auto corner = [&](int ring, int i) {
      return first + static_cast<std::uint32_t>(ring * kAround + i % kAround);
    };
    for (int i = 0; i < kAround; ++i) {
      for (int ring = 0; ring < rings; ++ring) {
        AddTriangle(corner(ring, i), corner(ring, i + 1), corner(ring + 1, i + 1));
        AddTriangle(corner(ring, i), corner(ring + 1, i + 1), corner(ring + 1, i));
      }
      if (i + 2 < kAround) {
        AddTriangle(corner(0, 0), corner(0, i + 2), corner(0, i + 1));
        AddTriangle(corner(rings, 0), corner(rings, i + 1), corner(rings, i + 2));
      }
    }
  }
  // Counter-clockwise from outside in the file, whatever its axes are.
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles_.insert(triangles_.end(), {a, c, b});
  }

  void AddParts() {
    const double size = sample_.height / 1.75;
    const auto joint = [&](std::size_t bone) { return JointOf(bone); };
    const auto beyond = [&](std::size_t bone, double x, double y, double z) {
      return Vector3d(joint(bone) + size * Vector3d(x, y, z));
    };
    AddTube({0, 1, 2, 3},
            {beyond(0, 0, 0, -0.10), joint(1), joint(2), joint(3), beyond(4, 0, 0, 0)},
            0.13 * size);
    AddTube({4, 5}, {beyond(4, 0, 0, -0.03), joint(5), beyond(5, 0, 0, 0.19)}, 0.07 * size);
    for (const std::size_t arm : {std::size_t{7}, std::size_t{15}}) {
      const Vector3d tip = joint(arm + 2) + 0.75 * (joint(arm + 2) - joint(arm + 1));
      AddTube({arm, arm + 1, arm + 2}, {joint(arm), joint(arm + 1), joint(arm + 2), tip},
              0.04 * size);
    }
    for (const std::size_t leg : {std::size_t{10}, std::size_t{18}}) {
      AddTube({leg, leg + 1}, {joint(leg), joint(leg + 1), beyond(leg + 2, 0, 0, -0.02)},
              0.07 * size);
      AddTube({leg + 2, leg + 3},
              {beyond(leg + 2, -0.06, 0, -0.045), beyond(leg + 3, 0, 0, 0.025),
               beyond(leg + 3, 0.08, 0, 0.025)},
              0.045 * size);
    }
  }

  std::string NameOf(const RigBone& bone) const {
    switch (sample_.names) {
      case BoneNames::kVrm1:
      case BoneNames::kVrm0: return std::string("J_Bip_") + bone.vrm + "_x";
      case BoneNames::kMixamo: return std::string("mixamorig:") + bone.mixamo;
      case BoneNames::kMvn: return bone.mvn;
    }
    return "";
  }

  // Bones are turned in their own ways, as programs like them.
  Eigen::Affine3d WorldOf(std::size_t bone) const {
    Eigen::Affine3d world(Eigen::Translation3d(ToFile(JointOf(bone))));
    return world *
           Eigen::AngleAxisd(0.3 * static_cast<double>(bone), Vector3d(1, 2, 3).normalized());
  }

  void AddNodes(nlohmann::json& document) {
    nlohmann::json nodes = nlohmann::json::array(), roots = nlohmann::json::array();
    nlohmann::json vrm1 = nlohmann::json::object(), vrm0 = nlohmann::json::array();
    for (std::size_t i = 0; i < kRigBones.size(); ++i) {
      const RigBone& bone = kRigBones[i];
      Eigen::Affine3d local = WorldOf(i);
      if (bone.parent >= 0) {
        const auto parent = static_cast<std::size_t>(bone.parent);
        local = WorldOf(parent).inverse() * local;
        nodes[parent]["children"].push_back(i);
      } else {
        roots.push_back(i);
      }
      const Eigen::Quaterniond turn(local.linear());
      const Vector3d at = local.translation();
      const bool is_missing = sample_.missing.count(static_cast<int>(i)) > 0;
      nodes.push_back({{"name", is_missing ? "helper" + std::to_string(i) : NameOf(bone)},
                       {"translation", {at.x(), at.y(), at.z()}},
                       {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}});
      if (is_missing) continue;
      vrm1[bone.vrm] = {{"node", i}};
      vrm0.push_back({{"bone", bone.vrm}, {"node", i}});
    }
    nodes.push_back({{"name", "Body"}, {"mesh", 0}, {"skin", 0}});
    roots.push_back(kRigBones.size());
    document["nodes"] = nodes;
    document["scenes"] = {{{"nodes", roots}}};
    if (sample_.names == BoneNames::kVrm1) {
      document["extensions"]["VRMC_vrm"] = {{"humanoid", {{"humanBones", vrm1}}}};
    }
    if (sample_.names == BoneNames::kVrm0) {
      document["extensions"]["VRM"] = {{"humanoid", {{"humanBones", vrm0}}}};
    }
  }

  // @return the accessor
  template <class T>
  std::size_t AddAccessor(const std::vector<T>& values, int component, const char* type,
                          std::size_t per_element, nlohmann::json& document) {
    const std::size_t bytes = sizeof(T) * values.size();
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}});
    binary_.append(reinterpret_cast<const char*>(values.data()), bytes);
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", values.size() / per_element},
                                     {"type", type}});
    return document["accessors"].size() - 1;
  }

  void AddMesh(nlohmann::json& document) {
    constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
    std::vector<float> positions, weights, binds;
    std::vector<std::uint16_t> joints;
    for (const Corner& corner : corners_) {
      for (const double value : ToFile(corner.position)) {
        positions.push_back(static_cast<float>(value));
      }
      joints.insert(joints.end(), corner.bones.begin(), corner.bones.end());
      weights.insert(weights.end(), corner.weights.begin(), corner.weights.end());
    }
    nlohmann::json bones = nlohmann::json::array();
    for (std::size_t i = 0; i < kRigBones.size(); ++i) {
      bones.push_back(i);
      const Eigen::Matrix4d bind = WorldOf(i).inverse().matrix();
      for (int k = 0; k < 16; ++k) binds.push_back(static_cast<float>(bind(k % 4, k / 4)));
    }
    const auto position = AddAccessor(positions, kFloat, "VEC3", 3, document);
    const auto joint = AddAccessor(joints, kUnsignedShort, "VEC4", 4, document);
    const auto weight = AddAccessor(weights, kFloat, "VEC4", 4, document);
    const auto index = AddAccessor(triangles_, kUnsignedInt, "SCALAR", 1, document);
    const auto bind = AddAccessor(binds, kFloat, "MAT4", 16, document);
    document["buffers"] = {{{"byteLength", binary_.size()}}};
    document["skins"] = {{{"joints", bones}, {"inverseBindMatrices", bind}}};
    document["meshes"] = {
        {{"name", "Body"},
         {"primitives",
          {{{"attributes", {{"POSITION", position}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}}},
            {"indices", index},
            {"material", 0}}}}}};
  }

  const RigSample& sample_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> triangles_;
  std::string binary_;
};

inline std::string RigGlb(const RigSample& sample = {}) { return RigWriter(sample).Glb(); }

}  // namespace kinescope::testing
