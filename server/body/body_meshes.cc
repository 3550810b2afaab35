#include "server/body/body_meshes.h"

#include <fmt/format.h>

#include <array>
#include <type_traits>
#include <utility>

#include "urdf/body_surface.h"
#include "urdf/hand_surface.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

// FNV-1a.
class MeshHash {
 public:
  std::uint64_t value() const { return value_; }

  void AddBytes(const void* data, std::size_t size) {
    const auto* const bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3ULL;
  }
  template <class Number>
  void Add(Number number) {
    static_assert(std::is_arithmetic_v<Number>);
    AddBytes(&number, sizeof number);
  }
  void Add(const Vector3d& vector) { AddBytes(vector.data(), 3 * sizeof(double)); }
  template <std::size_t size>
  void Add(const std::array<Vector3d, size>& vectors) {
    for (const Vector3d& vector : vectors) Add(vector);
  }
  void Add(const std::string& text) {
    Add(text.size());
    AddBytes(text.data(), text.size());
  }
  void Add(const std::vector<MeshFile>& files) {
    for (const MeshFile& file : files) {
      Add(file.name);
      Add(file.stl);
    }
  }

  // Every member that is a length: a body that differs in one of them must not get the meshes of
  // another.
  void Add(const urdf::Skeleton& skeleton) {
    static_assert(sizeof skeleton == (3 * (urdf::kSegmentCount + 7) + 2) * sizeof(double));
    Add(skeleton.origin_in_parent);
    Add(skeleton.head_top_in_head);
    Add(skeleton.finger_tip_in_hand);
    Add(skeleton.heel_in_foot);
    Add(skeleton.toe_tip_in_toe);
    Add(skeleton.height);
  }
  void Add(const urdf::HandSkeleton& hand) {
    static_assert(sizeof hand == (3 * urdf::kFingersPerHand + 1) * sizeof(double));
    Add(hand.origin_in_parent);
    Add(hand.length);
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

// Any body will do: its files change with every change of how surfaces are made.
urdf::HumanModel SampleBody() {
  constexpr double kStature = 1.9;  // m
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton(kStature);
  return human;
}

// The same as long as the program is the same.
std::uint64_t HashOfBuiltInSurfaces() {
  static const std::uint64_t kHash = [] {
    constexpr double kHandLength = 0.2;  // m
    urdf::HumanModel gloved = SampleBody();
    gloved.gloves[urdf::kRight] = urdf::DefaultHand(urdf::kRight, kHandLength);
    MeshHash hash;
    hash.Add(BodyMeshFiles(gloved, nullptr));
    return hash.value();
  }();
  return kHash;
}

}  // namespace

std::vector<MeshFile> BodyMeshFiles(const urdf::HumanModel& human, const CustomBodyMeshes* custom) {
  std::vector<MeshFile> files;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const bool is_gloved = (i == urdf::kRightHand && human.gloves[urdf::kRight]) ||
                           (i == urdf::kLeftHand && human.gloves[urdf::kLeft]);
    if (is_gloved) continue;
    files.push_back({std::string(urdf::kSegments[urdf::At(i)].link_name) + ".stl",
                     urdf::ToBinaryStl(BodyMeshOf(custom, human.skeleton, i))});
  }
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    for (int i = 0; human.gloves[side] && i < urdf::kFingersPerHand; ++i) {
      files.push_back({urdf::FingerFileName(side, i) + ".stl",
                       urdf::ToBinaryStl(urdf::FingerMesh(*human.gloves[side], i))});
    }
  }
  return files;
}

std::vector<MeshFile> ToolMeshFiles(const HandTools& tools, const urdf::Skeleton& skeleton) {
  std::vector<MeshFile> files;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (!tools[side]) continue;
    files.push_back({urdf::ToolFileName(side) + ".stl",
                     urdf::ToBinaryStl(ToHandFrame(*tools[side], skeleton, side))});
  }
  return files;
}

std::vector<MeshFile> AllMeshFiles(const BodyAppearance& appearance,
                                   const urdf::HumanModel& human) {
  std::vector<MeshFile> files;
  if (appearance.is_smooth) files = BodyMeshFiles(human, appearance.custom.get());
  if (!appearance.tools) return files;
  for (MeshFile& file : ToolMeshFiles(*appearance.tools, human.skeleton)) {
    files.push_back(std::move(file));
  }
  return files;
}

std::uint64_t HashOf(const BodyAppearance& appearance) {
  MeshHash hash;
  hash.Add(appearance.is_smooth);
  if (appearance.is_smooth) hash.Add(HashOfBuiltInSurfaces());
  const urdf::HumanModel sample = SampleBody();
  if (appearance.custom) {
    hash.Add(appearance.custom->fit_person);
    hash.Add(BodyMeshFiles(sample, appearance.custom.get()));
  }
  if (appearance.tools) hash.Add(ToolMeshFiles(*appearance.tools, sample.skeleton));
  return hash.value();
}

std::string MeshSetName(std::uint64_t appearance_hash, const urdf::HumanModel& human) {
  MeshHash hash;
  hash.Add(appearance_hash);
  hash.Add(human.skeleton);
  for (const auto& glove : human.gloves) {
    hash.Add(glove.has_value());
    if (glove) hash.Add(*glove);
  }
  return fmt::format("body-{:016x}", hash.value());
}

}  // namespace kinescope::app
