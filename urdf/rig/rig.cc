#include "urdf/rig/rig.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "urdf/rig/glb_container.h"
#include "urdf/rig/glb_values.h"

namespace kinescope::rig {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using nlohmann::json;
using Fault = std::runtime_error;

constexpr std::size_t kNone = SIZE_MAX;
// In place of a texture, and of a missing material; linear. As the bare skin of the built-in suit.
constexpr std::array<double, 3> kPlain = {0.479, 0.434, 0.381};
constexpr std::size_t kMaxJointsOfAllMeshes = 200'000, kMaxPrimitives = 10'000;

std::string Quoted(const std::string& name) { return "'" + name.substr(0, 60) + "'"; }

float ToSrgb(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  return static_cast<float>(linear <= 0.0031308 ? 12.92 * linear
                                                : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

Affine3d TransformOf(const json& node) {
  Affine3d transform = Affine3d::Identity();
  if (node.contains("matrix")) {
    const auto m = NumbersOf<16>(node, "matrix", {});
    for (int i = 0; i < 12; ++i) {  // column by column; the last row is 0 0 0 1
      transform(i % 3, i / 3) = m[static_cast<std::size_t>(i % 3 + 4 * (i / 3))];
    }
    return transform;
  }
  const auto t = NumbersOf<3>(node, "translation", {0, 0, 0});
  const auto r = NumbersOf<4>(node, "rotation", {0, 0, 0, 1});
  const auto s = NumbersOf<3>(node, "scale", {1, 1, 1});
  Eigen::Quaterniond rotation(r[3], r[0], r[1], r[2]);
  if (rotation.norm() > 0) rotation.normalize();
  transform.translate(Vector3d(t[0], t[1], t[2]));
  transform.rotate(rotation);
  transform.scale(Vector3d(s[0], s[1], s[2]));
  return transform;
}

class Reader {
 public:
  explicit Reader(std::string_view glb)
      : chunks_(urdf::SplitGlb(glb)), document_(urdf::ParseGlbJson(chunks_.json)) {}

  Rig Read() {
    CheckExtensions();
    ReadNodes();
    ReadHumanoid();
    ReadMaterials();
    const json& nodes = ListOf(document_, "nodes");
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      if (nodes[node].contains("mesh")) ReadMesh(node);
    }
    const auto is_joint = [](const Node& node) { return node.is_joint; };
    if (std::none_of(rig_.nodes.begin(), rig_.nodes.end(), is_joint)) {
      throw Fault("has no rig: no mesh with a skin; bind the mesh to an armature and export both");
    }
    if (rig_.triangles.empty()) throw Fault("has no triangles");
    return std::move(rig_);
  }

 private:
  struct Skin {
    std::vector<int> nodes;
    std::vector<Affine3d> world_from_mesh;  // as each would carry it
  };

  // Those that only add to materials, or hold VRM's own data, may be ignored.
  void CheckExtensions() const {
    for (const json& extension : ListOf(document_, "extensionsRequired")) {
      const std::string name = extension.is_string() ? extension.get<std::string>() : "";
      const auto begins = [&](std::string_view with) {
        return name.compare(0, with.size(), with) == 0;
      };
      if (begins("KHR_materials_") || begins("KHR_texture_") || begins("EXT_texture_") ||
          begins("VRM")) {
        continue;
      }
      throw Fault("needs the extension " + Quoted(name) +
                  ", which is not supported: export it without compression");
    }
  }

  void ReadNodes() {
    const json& nodes = ListOf(document_, "nodes");
    if (nodes.size() > kMaxNodes) {
      throw Fault("has " + std::to_string(nodes.size()) + " nodes; expected at most " +
                  std::to_string(kMaxNodes));
    }
    rig_.nodes.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const json& node = EntryOf(nodes, i, "nodes");
      rig_.nodes[i].name = TextOf(node, "name");
      for (const json& child : ListOf(node, "children")) {
        if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size()) {
          throw Fault("node " + Quoted(rig_.nodes[i].name) + " has a child that does not exist");
        }
        Node& below = rig_.nodes[child.get<std::size_t>()];
        if (below.parent >= 0) throw Fault("a node has two parents");
        below.parent = static_cast<int>(i);
      }
    }
    std::vector<char> is_placed(nodes.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::vector<std::size_t> up;
      for (int at = static_cast<int>(i); at >= 0 && is_placed[static_cast<std::size_t>(at)] == 0;
           at = rig_.nodes[static_cast<std::size_t>(at)].parent) {
        up.push_back(static_cast<std::size_t>(at));
        if (up.size() > urdf::kMaxGlbDepth * 10) throw Fault("its nodes are nested too deeply");
      }
      while (!up.empty()) {
        Node& node = rig_.nodes[up.back()];
        const Affine3d own = TransformOf(nodes[up.back()]);
        node.world_from_node =
            node.parent < 0
                ? own
                : rig_.nodes[static_cast<std::size_t>(node.parent)].world_from_node * own;
        if (!node.world_from_node.matrix().allFinite()) {
          throw Fault("node " + Quoted(node.name) + " has a place that is not finite");
        }
        is_placed[up.back()] = 1;
        up.pop_back();
      }
    }
  }

  // VRM 1.0: {"hips": {"node": 3}}; VRM 0.x: [{"bone": "hips", "node": 3}].
  void ReadHumanoid() {
    const auto extensions = document_.find("extensions");
    if (extensions == document_.end() || !extensions->is_object()) return;
    for (const char* const name : {"VRMC_vrm", "VRM"}) {
      const auto extension = extensions->find(name);
      if (extension == extensions->end() || !extension->is_object()) continue;
      const auto humanoid = extension->find("humanoid");
      if (humanoid == extension->end() || !humanoid->is_object()) continue;
      const auto bones = humanoid->find("humanBones");
      if (bones == humanoid->end() || !bones->is_structured()) continue;
      for (const auto& [key, bone] : bones->items()) {
        if (!bone.is_object()) continue;
        const std::size_t node = IndexOf(bone, "node", rig_.nodes.size(), kNone);
        const std::string bone_name = bones->is_array() ? TextOf(bone, "bone") : key;
        if (node != kNone) rig_.humanoid[bone_name] = static_cast<int>(node);
      }
      return;
    }
  }

  void ReadMaterials() {
    for (const json& material : ListOf(document_, "materials")) {
      std::array<double, 4> color = {1, 1, 1, 1};
      if (material.is_object() && material.contains("pbrMetallicRoughness") &&
          material["pbrMetallicRoughness"].is_object()) {
        const json& surface = material["pbrMetallicRoughness"];
        color = NumbersOf<4>(surface, "baseColorFactor", color);
        if (surface.contains("baseColorTexture")) {  // usually times white
          rig_.has_textures = true;
          for (std::size_t i = 0; i < kPlain.size(); ++i) color[i] *= kPlain[i];
        }
      }
      rig_.colors.push_back({ToSrgb(color[0]), ToSrgb(color[1]), ToSrgb(color[2])});
    }
    rig_.colors.push_back({ToSrgb(kPlain[0]), ToSrgb(kPlain[1]), ToSrgb(kPlain[2])});
  }

  Skin SkinOf(std::size_t index, std::size_t mesh_node) {
    const json& skin = EntryOf(ListOf(document_, "skins"), index, "skins");
    const json& joints = ListOf(skin, "joints");
    joints_seen_ += joints.size();
    if (joints.empty()) throw Fault("a skin has no bones");
    if (joints_seen_ > kMaxJointsOfAllMeshes) {
      throw Fault("its meshes have more than " + std::to_string(kMaxJointsOfAllMeshes) + " bones");
    }
    const std::size_t binds = IndexOf(skin, "inverseBindMatrices", kNone, kNone);
    Skin made;
    for (const json& joint : joints) {
      if (!joint.is_number_unsigned() || joint.get<std::uint64_t>() >= rig_.nodes.size()) {
        throw Fault("a skin of node " + Quoted(rig_.nodes[mesh_node].name) +
                    " has a bone that does not exist");
      }
      Node& node = rig_.nodes[joint.get<std::size_t>()];
      node.is_joint = true;
      made.nodes.push_back(joint.get<int>());
      made.world_from_mesh.push_back(node.world_from_node);
    }
    if (binds == kNone) return made;
    const Accessor matrices(document_, chunks_.binary, binds, "MAT4");
    if (matrices.count() < joints.size() || !matrices.is_float()) {
      throw Fault("a skin has " + std::to_string(joints.size()) + " bones, but " +
                  std::to_string(matrices.count()) + " inverse bind matrices");
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      Affine3d bone_from_mesh = Affine3d::Identity();
      for (int entry = 0; entry < 12; ++entry) {
        bone_from_mesh(entry % 3, entry / 3) =
            matrices.Number(i, static_cast<std::size_t>(entry % 3 + 4 * (entry / 3)));
      }
      made.world_from_mesh[i] = made.world_from_mesh[i] * bone_from_mesh;
      if (!made.world_from_mesh[i].matrix().allFinite()) {
        throw Fault("the bind matrix of bone " +
                    Quoted(rig_.nodes[static_cast<std::size_t>(made.nodes[i])].name) +
                    " is not finite");
      }
    }
    return made;
  }

  void ReadMesh(std::size_t node) {
    const json& json_node = ListOf(document_, "nodes")[node];
    const json& mesh =
        EntryOf(ListOf(document_, "meshes"), IndexOf(json_node, "mesh", kNone, kNone), "meshes");
    const std::size_t skin_index = IndexOf(json_node, "skin", kNone, kNone);
    Skin skin;
    if (skin_index != kNone) {
      skin = SkinOf(skin_index, node);
    } else {
      skin = {{static_cast<int>(node)}, {rig_.nodes[node].world_from_node}};
    }
    for (const json& primitive : ListOf(mesh, "primitives")) {
      if (++primitives_ > kMaxPrimitives) {
        throw Fault("has more than " + std::to_string(kMaxPrimitives) + " parts");
      }
      constexpr std::size_t kTriangleMode = 4;
      if (!primitive.is_object() || !primitive.contains("attributes") ||
          !primitive["attributes"].is_object()) {
        throw Fault("a part of mesh " + Quoted(TextOf(mesh, "name")) + " has no attributes");
      }
      if (IndexOf(primitive, "mode", 7, kTriangleMode) != kTriangleMode) continue;
      ReadPrimitive(primitive, skin, skin_index != kNone, "mesh " + Quoted(TextOf(mesh, "name")));
    }
  }

  void ReadPrimitive(const json& primitive, const Skin& skin, bool is_skinned,
                     const std::string& where) {
    const json& attributes = primitive["attributes"];
    const auto accessor = [&](const char* name, const char* type) {
      return Accessor(document_, chunks_.binary, IndexOf(attributes, name, kNone, kNone), type);
    };
    const Accessor positions = accessor("POSITION", "VEC3");
    if (!positions.is_float()) throw Fault(where + ": its positions are quantised");
    std::vector<std::pair<Accessor, Accessor>> influences;
    for (const char* const set : {"0", "1"}) {
      const std::string joints = std::string("JOINTS_") + set,
                        weights = std::string("WEIGHTS_") + set;
      if (!is_skinned || !attributes.contains(joints) || !attributes.contains(weights)) continue;
      influences.emplace_back(accessor(joints.c_str(), "VEC4"), accessor(weights.c_str(), "VEC4"));
    }
    if (is_skinned && influences.empty()) throw Fault(where + " has a skin, but no weights");
    const bool has_normals = attributes.contains("NORMAL");
    const std::vector<Accessor> normals =
        has_normals ? std::vector<Accessor>{accessor("NORMAL", "VEC3")} : std::vector<Accessor>{};

    const std::size_t index_accessor = IndexOf(primitive, "indices", kNone, kNone);
    std::vector<Accessor> corners;
    if (index_accessor != kNone) {
      corners.emplace_back(document_, chunks_.binary, index_accessor, "SCALAR");
    }
    const std::size_t count = (corners.empty() ? positions : corners.front()).count() / 3;
    if (count > kMaxTriangles || rig_.triangles.size() + count > kMaxTriangles) {
      throw Fault("has " + std::to_string(rig_.triangles.size() + count) +
                  " triangles or more; expected at most " + std::to_string(kMaxTriangles) +
                  ": reduce the mesh (Blender: modifier Decimate)");
    }
    const std::size_t material =
        IndexOf(primitive, "material", rig_.colors.size() - 1, rig_.colors.size() - 1);
    if (material + 1 < rig_.colors.size()) {
      const json& of = ListOf(document_, "materials")[material];
      const auto two_sided = of.is_object() ? of.find("doubleSided") : of.end();
      rig_.is_two_sided =
          rig_.is_two_sided || (of.is_object() && two_sided != of.end() && *two_sided == true);
    }
    // Parts may share their vertices; each takes those that it draws.
    std::unordered_map<std::uint32_t, std::uint32_t> taken;
    const auto take = [&](std::uint32_t of_file) {
      const auto [known, is_new] =
          taken.emplace(of_file, static_cast<std::uint32_t>(rig_.vertices.size()));
      if (!is_new) return known->second;
      if (of_file >= positions.count()) throw Fault(where + " has a corner that is no vertex");
      RigVertex vertex;
      vertex.material = static_cast<std::uint32_t>(material);
      SetWeights(influences, of_file, skin, where, vertex);
      Place(skin, positions, normals, of_file, where, vertex);
      rig_.vertices.push_back(vertex);
      return known->second;
    };
    const bool is_mirrored = skin.world_from_mesh.front().linear().determinant() < 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        triangle[c] = take(corners.empty() ? static_cast<std::uint32_t>(3 * i + c)
                                           : corners.front().Whole(3 * i + c));
      }
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      rig_.triangles.push_back(triangle);
    }
  }

  // Indices of `skin`; the heaviest four, whose sum becomes 1.
  void SetWeights(const std::vector<std::pair<Accessor, Accessor>>& influences,
                  std::uint32_t of_file, const Skin& skin, const std::string& where,
                  RigVertex& vertex) const {
    if (influences.empty()) {
      vertex.nodes = {};
      vertex.weights = {1, 0, 0, 0};
      return;
    }
    std::vector<std::pair<double, std::int32_t>> all;
    const std::string name = where + ", vertex " + std::to_string(of_file);
    for (const auto& [joints, weights] : influences) {
      if (of_file >= joints.count() || of_file >= weights.count()) {
        throw Fault(name + " has no weights");
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const double weight = weights.Number(of_file, k, true);
        if (!std::isfinite(weight) || weight < 0 || weight > 1e6) {
          throw Fault(name + ": a weight is " + std::to_string(weight) + "; expected 0 to 1");
        }
        if (weight == 0) continue;
        const std::uint32_t joint = joints.Whole(of_file, k);
        if (joint >= skin.nodes.size()) throw Fault(name + " hangs on a bone that does not exist");
        all.emplace_back(-weight, static_cast<std::int32_t>(joint));
      }
    }
    std::sort(all.begin(), all.end());
    all.resize(std::min<std::size_t>(all.size(), 4));
    double sum = 0;
    for (const auto& [weight, joint] : all) sum -= weight;
    if (!(sum > 1e-6)) {
      throw Fault(name +
                  ": its weights sum up to 0; assign it to a bone (Blender: Weights, "
                  "Assign Automatic from Bones)");
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      vertex.nodes[k] = all[k].second;
      vertex.weights[k] = static_cast<float>(-all[k].first / sum);
    }
  }

  // In the pose that the file shows. Turns indices of `skin` into nodes.
  static void Place(const Skin& skin, const Accessor& positions,
                    const std::vector<Accessor>& normals, std::uint32_t of_file,
                    const std::string& where, RigVertex& vertex) {
    const auto vector = [&](const Accessor& from) {
      return Vector3d(from.Number(of_file, 0, true), from.Number(of_file, 1, true),
                      from.Number(of_file, 2, true));
    };
    const Vector3d at = vector(positions);
    Vector3d normal = Vector3d::Zero();
    if (!normals.empty() && of_file < normals.front().count()) normal = vector(normals.front());
    Vector3d turned = Vector3d::Zero();
    for (std::size_t k = 0; k < 4 && vertex.weights[k] > 0; ++k) {
      const Affine3d& carries = skin.world_from_mesh[static_cast<std::size_t>(vertex.nodes[k])];
      vertex.position += static_cast<double>(vertex.weights[k]) * (carries * at);
      turned += static_cast<double>(vertex.weights[k]) * (carries.linear() * normal);
      vertex.nodes[k] = skin.nodes[static_cast<std::size_t>(vertex.nodes[k])];
    }
    constexpr double kFarthest = 1e9;
    if (!at.allFinite() || !vertex.position.allFinite() ||
        vertex.position.cwiseAbs().maxCoeff() > kFarthest) {
      throw Fault(where + ", vertex " + std::to_string(of_file) + ": its position is not finite");
    }
    const double length = turned.norm();
    if (std::isfinite(length) && length > 0) vertex.normal = (turned / length).cast<float>();
  }

  const urdf::GlbChunks chunks_;
  const json document_;
  Rig rig_;
  std::size_t joints_seen_ = 0, primitives_ = 0;
};

}  // namespace

Rig ReadRig(std::string_view glb) {
  if (glb.size() > kMaxFileBytes) {
    throw Fault("is larger than " + std::to_string(kMaxFileBytes >> 20) + " MiB");
  }
  try {
    return Reader(glb).Read();
  } catch (const json::exception& error) {
    throw Fault(std::string("its JSON part is invalid: ") + error.what());
  }
}

}  // namespace kinescope::rig
