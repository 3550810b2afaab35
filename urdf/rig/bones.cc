#include "urdf/rig/bones.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "urdf/rig/frame_names.h"
#include "urdf/rig/usual_names.h"
#include "urdf/skeleton.h"
#include "urdf/skin/frames.h"

namespace kinescope::rig {
namespace {

using urdf::At;

// What a name stands for: a segment, the spine, or a finger.
constexpr int kSpine = urdf::kSegmentCount, kMiddleFinger = kSpine + 1;

struct Role {
  int segment = 0;  // of the right side, where there are two
  const char* vrm = "";
  const char* mixamo = "";
  bool is_required = true;
};

// MVN's names are those of urdf::kSegments.
constexpr std::array kMiddleRoles = {
    Role{urdf::kPelvis, "hips", "Hips"},      Role{kSpine, "spine", "Spine"},
    Role{kSpine, "chest", "Spine1", false},   Role{kSpine, "upperChest", "Spine2", false},
    Role{urdf::kNeck, "neck", "Neck", false}, Role{urdf::kHead, "head", "Head"}};
constexpr std::array kSideRoles = {Role{urdf::kRightShoulder, "Shoulder", "Shoulder", false},
                                   Role{urdf::kRightUpperArm, "UpperArm", "Arm"},
                                   Role{urdf::kRightForeArm, "LowerArm", "ForeArm"},
                                   Role{urdf::kRightHand, "Hand", "Hand"},
                                   Role{urdf::kRightUpperLeg, "UpperLeg", "UpLeg"},
                                   Role{urdf::kRightLowerLeg, "LowerLeg", "Leg"},
                                   Role{urdf::kRightFoot, "Foot", "Foot"},
                                   Role{urdf::kRightToe, "Toes", "ToeBase", false},
                                   Role{kMiddleFinger, "MiddleProximal", "HandMiddle1", false}};

// Letters and digits in lower case, without what stands before a colon: "mixamorig:Left_Arm" is
// "leftarm".
std::string Plain(std::string name) {
  if (const auto colon = name.rfind(':'); colon != std::string::npos) name.erase(0, colon + 1);
  std::string plain;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') plain += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) plain += c;
  }
  constexpr std::string_view kMixamo = "mixamorig";  // tools drop the colon
  if (plain.compare(0, kMixamo.size(), kMixamo) == 0) plain.erase(0, kMixamo.size());
  return plain;
}

struct Meaning {
  int role = 0;  // a segment, kSpine or kMiddleFinger
  urdf::Side side = urdf::kRight;
};

int OnSide(int segment, urdf::Side side) {
  if (side == urdf::kRight || segment >= urdf::kSegmentCount) return segment;
  return segment + (segment < urdf::kRightUpperLeg ? urdf::kLeftShoulder - urdf::kRightShoulder
                                                   : urdf::kLeftUpperLeg - urdf::kRightUpperLeg);
}

// By plain name.
const std::map<std::string, Meaning>& Meanings() {
  static const std::map<std::string, Meaning> kMeanings = [] {
    std::map<std::string, Meaning> meanings;
    for (int i = 0; i < urdf::kSegmentCount; ++i) {
      meanings[Plain(std::string(urdf::kSegments[At(i)].mvn_name))] = {i, urdf::kRight};
    }
    for (const Role& role : kMiddleRoles) {
      meanings[Plain(role.vrm)] = meanings[Plain(role.mixamo)] = {role.segment, urdf::kRight};
    }
    for (const char* const more : {"spine3", "spine4", "spine5"}) meanings[more] = {kSpine, {}};
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      const std::string prefix = side == urdf::kRight ? "right" : "left";
      for (const Role& role : kSideRoles) {
        meanings[prefix + Plain(role.vrm)] =
            meanings[prefix + Plain(role.mixamo)] = {OnSide(role.segment, side), side};
      }
    }
    return meanings;
  }();
  return kMeanings;
}

// What the nodes are, by VRM's list if there is one, else by their names. Of those with one name,
// bones go before others.
std::map<int, Meaning> MeaningsOf(const Rig& rig) {
  std::map<int, Meaning> found;
  if (!rig.humanoid.empty()) {
    for (const auto& [name, node] : rig.humanoid) {
      const auto meaning = Meanings().find(Plain(name));
      if (meaning != Meanings().end()) found[node] = meaning->second;
    }
    return found;
  }
  std::map<std::string, int> node_of;
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    const std::string name = Plain(rig.nodes[i].name);
    if (Meanings().count(name) == 0) continue;
    const auto [other, is_first] = node_of.emplace(name, static_cast<int>(i));
    if (is_first) continue;
    const bool other_is_joint = rig.nodes[At(other->second)].is_joint;
    if (rig.nodes[i].is_joint && other_is_joint) {
      throw std::runtime_error(fmt::format("has two bones '{}'; expected one person per file",
                                           rig.nodes[i].name.substr(0, 60)));
    }
    if (!other_is_joint) other->second = static_cast<int>(i);
  }
  for (const auto& [name, node] : node_of) found[node] = Meanings().at(name);
  return found;
}

std::string BonesOf(const Rig& rig) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> names;
  for (const Node& node : rig.nodes) {
    if (node.is_joint) names.push_back("'" + node.name.substr(0, 40) + "'");
  }
  const std::size_t all = names.size();
  names.resize(std::min(all, kMost));
  return fmt::format("{}{}", fmt::join(names, ", "),
                     all > kMost ? fmt::format(" and {} more", all - kMost) : "");
}

// "leftUpperArm (Mixamo: LeftArm, MVN: LeftUpperArm)"
std::string NamesOf(const Role& role, std::optional<urdf::Side> side) {
  if (!side) {
    const char* const mvn =
        role.segment == kSpine ? "T8" : urdf::kSegments[At(role.segment)].mvn_name.data();
    return fmt::format("{} (Mixamo: {}, MVN: {})", role.vrm, role.mixamo, mvn);
  }
  const bool is_left = *side == urdf::kLeft;
  return fmt::format("{}{} (Mixamo: {}{}, MVN: {})", is_left ? "left" : "right", role.vrm,
                     is_left ? "Left" : "Right", role.mixamo,
                     urdf::kSegments[At(OnSide(role.segment, *side))].mvn_name);
}

// Of joints only, because names without a standard say less. The first of two with one name counts.
std::map<int, Meaning> MeaningsByUsualNames(const Rig& rig) {
  std::map<int, Meaning> found;
  std::set<std::string> taken;
  int first_of_spine = -1;
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    if (!rig.nodes[i].is_joint) continue;
    const auto meaning = Meanings().find(UsualName(rig.nodes[i].name));
    if (meaning == Meanings().end()) continue;
    const bool is_spine = meaning->second.role == kSpine;
    if (!taken.insert(meaning->first).second && !is_spine) continue;
    found[static_cast<int>(i)] = meaning->second;
    if (is_spine && first_of_spine < 0) first_of_spine = static_cast<int>(i);
  }
  // Blender's spine begins with the hips.
  if (taken.count("hips") == 0 && first_of_spine >= 0) {
    found[first_of_spine] = {urdf::kPelvis, urdf::kRight};
  }
  return found;
}

// Which segment each node is, T8 for all bones of a spine with names of its own; -1: none.
struct Assignment {
  Bones bones;
  std::vector<int> own;
  bool has_spine = false;
};

Assignment Assign(const Rig& rig, const std::map<int, Meaning>& meanings) {
  Assignment assignment;
  auto& [bones, own, has_spine] = assignment;
  bones.node_of.fill(-1);
  bones.frame_of.assign(rig.nodes.size(), -1);
  own.assign(rig.nodes.size(), -1);
  for (const auto& [node, meaning] : meanings) {
    if (meaning.role == kMiddleFinger) {
      bones.middle_finger[meaning.side] = node;
      continue;
    }
    const bool is_trunk =
        meaning.role == kSpine || (meaning.role >= urdf::kL5 && meaning.role <= urdf::kT8);
    has_spine = has_spine || is_trunk;
    own[At(node)] = meaning.role == kSpine ? urdf::kT8 : meaning.role;
    bones.node_of[At(own[At(node)])] = node;
  }
  return assignment;
}

std::vector<std::string> MissingOf(const Assignment& assignment) {
  const std::array<int, urdf::kSegmentCount>& node_of = assignment.bones.node_of;
  std::vector<std::string> missing;
  for (const Role& role : kMiddleRoles) {
    const bool is_there =
        role.segment == kSpine ? assignment.has_spine : node_of[At(role.segment)] >= 0;
    if (role.is_required && !is_there) missing.push_back(NamesOf(role, std::nullopt));
  }
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    for (const Role& role : kSideRoles) {
      if (role.is_required && node_of[At(OnSide(role.segment, side))] < 0) {
        missing.push_back(NamesOf(role, side));
      }
    }
  }
  return missing;
}

// @throws std::runtime_error naming the bones that are missing by the better of both ways.
Assignment Assigned(const Rig& rig) {
  Assignment assignment = Assign(rig, MeaningsOf(rig));
  std::vector<std::string> missing = MissingOf(assignment);
  if (!missing.empty() && rig.humanoid.empty()) {
    Assignment by_usual_names = Assign(rig, MeaningsByUsualNames(rig));
    std::vector<std::string> still_missing = MissingOf(by_usual_names);
    if (still_missing.size() < missing.size()) {
      missing = std::move(still_missing);
      assignment = std::move(by_usual_names);
    }
  }
  if (missing.empty()) return assignment;
  throw std::runtime_error(fmt::format(
      "the rig has no bone {}; its bones are {}; rename them, or give them VRM's humanoid names",
      fmt::join(missing, ", "), BonesOf(rig)));
}

}  // namespace

Bones FindBones(const Rig& rig) {
  auto [bones, own, has_spine] = Assigned(rig);
  bones.has_spine_of_mvn = true;
  for (const int segment : {urdf::kL5, urdf::kL3, urdf::kT12, urdf::kT8}) {
    bones.has_spine_of_mvn = bones.has_spine_of_mvn && bones.node_of[At(segment)] >= 0;
  }
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    bones.frame_of[i] = FrameNamed(rig.nodes[i].name);
    bones.has_frames = bones.has_frames || bones.frame_of[i] >= 0;
  }
  // A node may come before its parent.
  bones.segment_of.assign(rig.nodes.size(), -1);
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    int at = static_cast<int>(i);
    while (at >= 0 && own[At(at)] < 0) at = rig.nodes[At(at)].parent;
    if (at >= 0) bones.segment_of[i] = own[At(at)];
    if (const int frame = bones.frame_of[i]; frame >= 0) {
      bones.segment_of[i] = skin::Frames()[At(frame)].segment;
    }
  }
  return bones;
}

}  // namespace kinescope::rig
