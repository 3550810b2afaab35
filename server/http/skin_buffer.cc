#include "server/http/skin_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/skin_inputs.h"
#include "core/system/json_text.h"
#include "render/shape/coarser_skin.h"
#include "render/shape/fine_normals.h"
#include "urdf/skin/contact.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/limbs.h"
#include "urdf/skin/load_regions.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::http {
namespace {

using nlohmann::json;
using urdf::At;

template <class T>
void Append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
}

double Micro(double value) { return std::round(value * 1e6) / 1e6; }

// The place of a finger in VisibleLinks(); of a bare hand: -1.
int LinkOfFinger(const urdf::HumanModel& human, urdf::Side side, int finger) {
  if (!human.gloves[side]) return -1;
  const bool is_second = side == urdf::kLeft && human.gloves[urdf::kRight];
  return urdf::kSegmentCount + (is_second ? urdf::kFingersPerHand : 0) + finger;
}

// A column for each member, because 153 objects would take longer to send than the vertices.
json FramesToJson(const urdf::HumanModel& human) {
  json kinds = json::array(), links = json::array(), parents = json::array(),
       shares = json::array(), into_bend = json::array(), up_bone = json::array(),
       limbs = json::array(), parts = json::array();
  const auto add = [&](const char* kind, int link, int parent, double share,
                       const skin::FarthestMove& move) {
    kinds.push_back(kind);
    links.push_back(link);
    parents.push_back(parent);
    shares.push_back(Micro(share));
    into_bend.push_back(Micro(move.into_bend));
    up_bone.push_back(Micro(move.up_bone));
  };
  for (const skin::Frame& frame : skin::Frames()) {
    const int parent = urdf::kSegments[At(frame.segment)].parent;
    limbs.push_back(skin::LimbOfSegment(frame.segment));
    parts.push_back(static_cast<int>(skin::BodyPartOf(frame.segment)));
    switch (frame.kind) {
      case skin::FrameKind::kSegment: add("link", frame.segment, -1, 1, {}); continue;
      case skin::FrameKind::kSwing:
        add("swing", frame.segment, parent, frame.share, skin::FarthestMoveOf(frame));
        continue;
      case skin::FrameKind::kTwist: add("twist", frame.segment, parent, frame.share, {}); continue;
      case skin::FrameKind::kFinger:
      case skin::FrameKind::kHalfFinger: break;
    }
    const auto side = frame.segment == urdf::kLeftHand ? urdf::kLeft : urdf::kRight;
    const int link = LinkOfFinger(human, side, frame.finger);
    const int before = urdf::kFingerParents[At(frame.finger)];
    if (link < 0) {
      add("fixed", frame.segment, -1, 1, {});
    } else if (frame.kind == skin::FrameKind::kFinger) {
      add("link", link, -1, 1, {});
    } else {
      add("half", link, skin::HasFrames(before) ? LinkOfFinger(human, side, before) : frame.segment,
          0.5, {});
    }
  }
  return {{"kinds", std::move(kinds)},           {"links", std::move(links)},
          {"parents", std::move(parents)},       {"shares", std::move(shares)},
          {"into_bend_m", std::move(into_bend)}, {"up_bone_m", std::move(up_bone)},
          {"limbs", std::move(limbs)},           {"parts", std::move(parts)}};
}

// The capsules that cover the sky. Two ends each, one after the other.
json LimbsToJson(const urdf::Skeleton& skeleton, const skin::Build& build) {
  json links = json::array(), points = json::array(), radii = json::array(), whole = json::array(),
       joined = json::array();
  const skin::LimbShapes shapes = skin::LimbShapesOf(skeleton, build);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (const skin::LimbEnd& end : {shapes[i].start, shapes[i].end}) {
      links.push_back(end.segment);
      radii.push_back(Micro(end.radius));
      for (const double value : end.point) points.push_back(Micro(value));
    }
    json whole_here = json::array(), joined_here = json::array();
    for (std::size_t by = 0; by < shapes.size(); ++by) {
      switch (skin::CoveringOf(static_cast<skin::Limb>(i), static_cast<skin::Limb>(by))) {
        case skin::Covering::kNone: break;
        case skin::Covering::kJoined: joined_here.push_back(by); break;
        case skin::Covering::kWhole: whole_here.push_back(by); break;
      }
    }
    whole.push_back(std::move(whole_here));
    joined.push_back(std::move(joined_here));
  }
  return {{"links", std::move(links)},
          {"points_m", std::move(points)},
          {"radii_m", std::move(radii)},
          {"covered_by", std::move(whole)},
          {"covered_by_joined", std::move(joined)}};
}

// The regions of joint loads. A byte or two of each vertex would take more than the page may load.
json RegionsToJson(const skin::BindPose& bind, double height) {
  json joints = json::array(), balls = json::array(), parts = json::array(),
       middles = json::array(), directions = json::array(), half_widths = json::array(),
       flares = json::array();
  const skin::RegionShapes shapes = skin::RegionShapesOf(bind, height);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const skin::RegionShape& shape = shapes[i];
    joints.push_back(urdf::kScoredJoints[i]);
    balls.push_back(shape.is_ball);
    parts.push_back(shape.parts.to_ulong());
    for (const double value : shape.middle) middles.push_back(Micro(value));
    for (const double value : shape.direction) directions.push_back(Micro(value));
    half_widths.push_back(Micro(shape.half_width));
    flares.push_back(Micro(shape.flare));
  }
  return {{"joints", std::move(joints)},         {"balls", std::move(balls)},
          {"parts", std::move(parts)},           {"middles_m", std::move(middles)},
          {"directions", std::move(directions)}, {"half_widths_m", std::move(half_widths)},
          {"flares", std::move(flares)},         {"least_weight", skin::kPartWeight}};
}

// The folds at which flesh meets.
json FoldsToJson(const skin::BindPose& bind, double height) {
  json folds = json::array();
  const auto vector = [](const Eigen::Vector3d& v) {
    return json{Micro(v.x()), Micro(v.y()), Micro(v.z())};
  };
  const auto growth = [](const skin::Growth& of) { return json{Micro(of.from), Micro(of.to)}; };
  for (const skin::FoldShape& fold : skin::FoldsOf(bind, height)) {
    folds.push_back({{"link", fold.segment},
                     {"before", fold.before},
                     {"frame", fold.frame},
                     {"center_m", vector(fold.center)},
                     {"normal", vector(fold.normal)},
                     {"across", vector(fold.across)},
                     {"inwards", vector(fold.inwards)},
                     {"pressed_m", growth(fold.pressed)},
                     {"bulging_m", growth(fold.bulging)},
                     {"outwards", vector(fold.outwards)},
                     {"beside_midline_m", growth(fold.beside_midline)},
                     {"softness_m", Micro(fold.softness)},
                     {"bulge", fold.bulge},
                     {"bulges", growth(fold.bulges)}});
  }
  return {{"shapes", std::move(folds)},
          {"contact", growth(skin::kContact)},
          {"bulge_reach_m", Micro(static_cast<double>(skin::kBulgeReach))}};
}

// [x, y, z, w] by link, for those whose twist is spread.
json MiddlesToJson() {
  json middles = json::object();
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (skin::TwistFrames(segment) == 0) continue;
    const Eigen::Quaterniond middle = skin::MiddleOfRange(segment);
    middles[std::to_string(segment)] = {middle.x(), middle.y(), middle.z(), middle.w()};
  }
  return middles;
}

template <class Vector>
void AppendSteps(const Vector& values, float step, std::vector<std::int16_t>& steps) {
  for (const float value : values) {
    steps.push_back(static_cast<std::int16_t>(std::lround(value / step)));
  }
}

constexpr float kBorderStep = skin::kFarthestBorder / INT8_MAX;

std::vector<std::int8_t> BordersInSteps(const std::vector<skin::Borders>& all) {
  std::vector<std::int8_t> steps;
  steps.reserve(4 * all.size());
  for (const skin::Borders& border : all) {
    for (const float inside : {border.trousers, border.bare, border.shoes, border.bands}) {
      steps.push_back(static_cast<std::int8_t>(std::lround(inside / kBorderStep)));
    }
  }
  return steps;
}

using Lean = render::FineNormals::Lean;

std::vector<float> FloatsOf(const std::vector<Lean>& leans) {
  std::vector<float> floats;
  floats.reserve(3 * leans.size());
  for (const Lean& lean : leans) {
    floats.insert(floats.end(), {lean.own, lean.along[0], lean.along[1]});
  }
  return floats;
}

std::vector<std::uint16_t> NeighboursOf(const std::vector<Lean>& leans) {
  std::vector<std::uint16_t> neighbours;
  neighbours.reserve(2 * leans.size());
  for (const Lean& lean : leans) {
    neighbours.insert(neighbours.end(), {lean.neighbours[0], lean.neighbours[1]});
  }
  return neighbours;
}

}  // namespace

std::string SkinBuffer(const PersonModel& model, const skin::SkinTemplate* own, int error_mm) {
  const urdf::HumanModel& human = model.human;
  const skin::Build build = BuildOf(model);
  const skin::SkinTemplate& whole = own != nullptr ? *own : skin::BuiltInSkin();
  render::CoarserSkin coarser;
  if (error_mm > 0) {
    coarser = render::MakeCoarserSkin(whole, build, human.skeleton, 1e-3 * error_mm);
  }
  const skin::SkinTemplate& of = error_mm > 0 ? coarser.skin : whole;
  const skin::PersonSkin skin(of, build, human.skeleton, GlovesOf(human));

  float farthest = 0;
  for (const Eigen::Vector3f& p : skin.rest())
    farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
  const float step = std::max(farthest, 1e-3f) / INT16_MAX;
  std::vector<std::int16_t> positions;
  positions.reserve(3 * skin.rest().size());
  for (const Eigen::Vector3f& p : skin.rest()) AppendSteps(p, step, positions);
  std::string paint;  // four bytes of each vertex
  if (of.colors.empty()) {
    Append(paint, BordersInSteps(skin::OutfitOf(of, build)));
  } else {
    Append(paint, of.colors);
  }
  std::vector<float> bind;
  for (const urdf::Pose& frame : skin.bind_frames()) {
    for (const double value : frame.position) bind.push_back(static_cast<float>(value));
    for (const double value : frame.orientation.coeffs()) bind.push_back(static_cast<float>(value));
  }

  const SuitColors& colors = model.suit;
  const std::string header =
      JsonText(json{{"vertices", of.size()},
                    {"triangles", of.triangles.size()},
                    {"position_step_m", step},
                    {"border_step_m", kBorderStep},
                    {"paint", of.colors.empty() ? "suit" : "colors"},
                    {"two_sided", of.is_two_sided},
                    {"leans", error_mm > 0},
                    {"frames", FramesToJson(human)},
                    {"limbs", LimbsToJson(human.skeleton, build)},
                    {"regions", RegionsToJson(skin.bind(), human.skeleton.height)},
                    {"folds", FoldsToJson(skin.bind(), human.skeleton.height)},
                    {"middles", MiddlesToJson()},
                    {"own_plane_until_rad", skin::kOwnPlaneUntil},
                    {"middle_share", skin::kMiddleShare},
                    {"colors",
                     {{"top", colors.top},
                      {"trousers", colors.trousers},
                      {"shoes", colors.shoes},
                      {"bare", colors.bare},
                      {"band", colors.band}}}});
  const std::string blanks((4 - header.size() % 4) % 4, ' ');
  std::string bytes;
  Append(bytes,
         std::vector<std::uint32_t>{static_cast<std::uint32_t>(header.size() + blanks.size())});
  bytes += header + blanks;
  Append(bytes, bind);
  Append(bytes, FloatsOf(coarser.normals.leans()));
  Append(bytes, of.weights);
  bytes += paint;
  Append(bytes, NeighboursOf(coarser.normals.leans()));
  Append(bytes, positions);
  Append(bytes, of.triangles);
  return bytes;
}

std::shared_ptr<const std::string> SkinBuffers::Of(const std::shared_ptr<const PersonModel>& model,
                                                   const skin::SkinTemplate* own, int error_mm) {
  made_.erase(std::remove_if(made_.begin(), made_.end(),
                             [](const Made& made) { return made.model.expired(); }),
              made_.end());
  for (const Made& made : made_) {
    if (made.model.lock() == model && made.error_mm == error_mm) return made.buffer;
  }
  made_.push_back(
      {model, error_mm, std::make_shared<const std::string>(SkinBuffer(*model, own, error_mm))});
  return made_.back().buffer;
}

}  // namespace kinescope::http
