/// A rigged person of the user's, read from a GLB (glTF 2.0, also VRM): nodes, which include the
/// bones, and the surface that they carry, in the pose in which the file shows it. The file's axes
/// and unit. Plain data and pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::rig {

/// Limits per file. Only what draws is counted.
inline constexpr std::size_t kMaxFileBytes = 128u << 20;
inline constexpr std::size_t kMaxTriangles = 250'000;
inline constexpr std::size_t kMaxNodes = 20'000;

struct Node {
  std::string name;
  int parent = -1;  // -1: none
  Eigen::Affine3d world_from_node = Eigen::Affine3d::Identity();
  bool is_joint = false;  // of a skin that is used
};

struct RigVertex {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // unit; zero: unknown
  std::array<std::int32_t, 4> nodes{};               // that carry it
  std::array<float, 4> weights{};                    // descending; their sum is 1
  std::uint32_t material = 0;                        // of Rig::colors
};

struct Rig {
  std::vector<Node> nodes;
  std::vector<RigVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
  std::vector<std::array<float, 3>> colors;             // of the materials, sRGB 0..1; and a last
                                                        // one of what has none
  /// VRM's names of bones ("leftUpperArm") and their nodes; empty: the file has none.
  std::map<std::string, int> humanoid;
  bool is_two_sided = false;  // a material is
  bool has_textures = false;  // which are not read
};

/// Meshes without a skin are carried by their node. Morph targets, textures and vertex colours are
/// not read. @throws std::runtime_error with the reason and the way out, without a file name:
/// truncated or inconsistent files, references to other files, compressed or sparse vertices,
/// numbers that are not finite, vertices without weight, more than the limits, no bones, no
/// triangles.
Rig ReadRig(std::string_view glb);

}  // namespace kinescope::rig
