#include "render/vtk/person_actors.h"

#include <vtkActor.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/hand_load_shape.h"
#include "core/palette.h"

namespace kinescope::render {
namespace {

// px, by which the outline of a body may be wrong where fewer triangles are drawn; of a skin also
// where it is drawn in full detail, but not by lines.
// Of 0.5 and 0.75 px, the latter has 0.8 dB less against a picture without error (36.2 and 35.4 at
// 1280x720, 2x), and takes 1.5 of 12 ms less.
constexpr double kUnseen = 1, kUnseenInFullDetail = 0.75;
// m per px. Then the light at the vertices of the skin, 1 cm apart, costs less than light at each
// pixel, and differs from it by more than 8 of 255 in a few pixels of a picture only.
constexpr double kFar = 0.0008;

constexpr double kGhostBodyOpacity = 0.45;
constexpr int kMarkCorners = 32;

enum ShadowPart { kBodyShadow, kRightFootShadow, kLeftFootShadow, kShadowParts };
enum MarkPart {
  kComRing,
  kComLine,
  kCopEdge,
  kCopDisc,
  kSupportEdge,                    // the first of as many as a polygon may have
  kGhostMarkParts = kSupportEdge,  // the support polygon does not shine through shoes
  kMarkParts = kSupportEdge + static_cast<int>(kMaxSupportPoints)
};

// Of what is held: cylinders, and one box behind them.
constexpr int kHeldBox = static_cast<int>(kMaxHandLoadSolids) - 1;
constexpr int kHeldParts = kHeldBox + 1;

Eigen::Vector4f Color(const Rgb& rgb, float alpha = 1) {
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]),
          alpha};
}

urdf::Mesh PersonShadow() {
  urdf::Mesh all;
  constexpr float kDarkness[kShadowParts] = {0.20f, 0.38f, 0.38f};
  for (int part = 0; part < kShadowParts; ++part) {
    const std::size_t first = all.positions.size();
    all.Append(urdf::DiscMesh(12), Eigen::Affine3d::Identity());
    all.Paint(first, {0.20f, 0.23f, 0.30f, kDarkness[part]}, part);
  }
  return all;
}

// The first `parts` of MarkPart.
urdf::Mesh MarkMesh(int parts) {
  urdf::Mesh all;
  const auto add = [&](const urdf::Mesh& mesh, const Rgb& rgb, MarkPart part) {
    const std::size_t first = all.positions.size();
    all.Append(mesh, Eigen::Affine3d::Identity());
    all.Paint(first, Color(rgb), part);
  };
  add(urdf::RingMesh(kComRingHole, kMarkCorners), kComColor, kComRing);
  add(urdf::CylinderMesh(1, 1), kComColor, kComLine);
  add(urdf::DiscMesh(kMarkCorners), {1, 1, 1}, kCopEdge);
  add(urdf::DiscMesh(kMarkCorners), kCopColor, kCopDisc);
  for (int edge = kSupportEdge; edge < parts; ++edge) {
    add(urdf::BoxMesh({1, 1, 1}), kSupportColor, static_cast<MarkPart>(edge));
  }
  return all;
}

// Solids of size 1, stretched to theirs where they are placed.
urdf::Mesh HeldMesh() {
  urdf::Mesh all;
  for (int part = 0; part < kHeldParts; ++part) {
    const std::size_t first = all.positions.size();
    const urdf::ShapeDetail detail{0.04, 32, 0};
    all.Append(
        part == kHeldBox ? urdf::BoxMesh({1, 1, 1}, detail) : urdf::CylinderMesh(1, 1, detail),
        Eigen::Affine3d::Identity());
    all.Paint(first, Color(kHandLoadColor), part);
  }
  return all;
}

std::string HeldName(const HandLoadSolid& solid) {
  if (!solid.hand) return "load in both hands";
  return *solid.hand == urdf::kRight ? "load in the right hand" : "load in the left hand";
}

// What replaces the colours of a body, and its share.
Eigen::Vector4f TintOf(const SceneLook& look, bool is_stale) {
  constexpr float kPaper = 0.88f;  // the borders of the suit stay visible
  if (is_stale) return Color(kStaleBodyColor);
  switch (look.style) {
    case Style::kClay: return Color(kClayColor);
    case Style::kLine: return Color(PaperOf(look.theme), kPaper);
    case Style::kMatte: break;
  }
  return Eigen::Vector4f::Zero();
}

Eigen::Affine3d At(double x, double y, double z, double scale_xy, double scale_z = 1) {
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translate(Eigen::Vector3d(x, y, z));
  place.scale(Eigen::Vector3d(scale_xy, scale_xy, scale_z));
  return place;
}

// A line on the floor.
Eigen::Affine3d Edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  constexpr double kHeight = 0.001, kAboveFloor = 0.004;
  const Eigen::Vector2d middle = 0.5 * (from + to), along = to - from;
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translate(Eigen::Vector3d(middle.x(), middle.y(), kAboveFloor));
  place.rotate(Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ()));
  place.scale(Eigen::Vector3d(along.norm() + kSupportWidth, kSupportWidth, kHeight));
  return place;
}

}  // namespace

PersonActors::PersonActors()
    : body_(std::make_unique<BodyActor>()),
      shadow_(Pass::kBlended, PartActor::Light::kSoft, kShadowParts),
      held_(Pass::kSolid, PartActor::Light::kLit, kHeldParts),
      ghost_marks_(Pass::kGhost, PartActor::Light::kFlat, kGhostMarkParts),
      marks_(Pass::kSolid, PartActor::Light::kFlat, kMarkParts),
      ghost_spheres_(Pass::kGhost, kGhostBodyOpacity),
      spheres_(Pass::kSolid, 1) {
  shadow_.SetMesh(PersonShadow());
  marks_.SetMesh(MarkMesh(kMarkParts));
  held_.SetMesh(HeldMesh());
  ghost_marks_.SetMesh(MarkMesh(kGhostMarkParts));
  ghost_marks_.SetOpacity(static_cast<float>(kGhostBodyOpacity));
}

bool PersonActors::Update(const PersonState& person, Liveness liveness, const Camera& camera,
                          const SceneLook& look, double metres_per_pixel, OnceLog& log,
                          std::vector<Label>& labels) {
  const bool is_stale = liveness == Liveness::kStale;
  const bool is_full = look.detail == Detail::kFull, has_lines = look.style == Style::kLine;
  const double unseen = !is_full ? kUnseen : has_lines ? 0 : kUnseenInFullDetail;
  const bool has_loads_on_skin =
      look.loads != LoadsShown::kSpheres && look.Shows(ScenePart::kLoads);
  const bool is_veil = look.body_opacity < 1;
  const bool is_new = std::exchange(is_veil_, is_veil) != is_veil;
  if (is_new) body_ = std::make_unique<BodyActor>(is_veil ? Pass::kVeil : Pass::kSolid);
  body_->SetVisible(look.Shows(ScenePart::kBody));
  body_->SetOpacity(look.body_opacity);
  bool is_changed =
      body_->Update(person, {look.figure, has_loads_on_skin, has_lines}, TintOf(look, is_stale),
                    {is_full ? 0 : kUnseen * metres_per_pixel, unseen * metres_per_pixel,
                     metres_per_pixel > kFar},
                    log, labels);
  is_changed = UpdateAxes(person, look) || is_new || is_changed;
  UpdateShadow(person, look);
  const bool has_spheres = look.loads != LoadsShown::kSkin || body_->limbs() == nullptr;
  UpdateMarks(person, has_spheres, camera, is_full ? 0 : metres_per_pixel);
  forces_.Show(person, look.Shows(ScenePart::kScale) ? &labels : nullptr);
  UpdateHeld(person, liveness);
  return is_changed;
}

std::vector<vtkActor*> PersonActors::ghosts() {
  std::vector<vtkActor*> actors = {ghost_marks_.actor(), forces_.ghost()};
  for (vtkActor* spheres : ghost_spheres_.actors()) actors.push_back(spheres);
  for (const auto* axes : {&frames_, &joint_axes_}) {
    if (*axes == nullptr) continue;
    for (vtkActor* actor : (*axes)->ghosts()) actors.push_back(actor);
  }
  return actors;
}

std::vector<vtkActor*> PersonActors::marks() {
  std::vector<vtkActor*> actors = {marks_.actor(), forces_.solid()};
  for (vtkActor* spheres : spheres_.actors()) actors.push_back(spheres);
  for (const auto* axes : {&frames_, &joint_axes_}) {
    if (*axes == nullptr) continue;
    for (vtkActor* actor : (*axes)->solids()) actors.push_back(actor);
  }
  return actors;
}

std::vector<std::string> PersonActors::NamesOf(const vtkActor* actor) {
  const auto is_of = [&](const auto& actors) {
    return std::find(actors.begin(), actors.end(), actor) != actors.end();
  };
  if (is_of(bodies())) return {"body"};
  if (actor == held_.actor()) return held_names_;
  if (is_of(spheres_.actors()) || is_of(ghost_spheres_.actors())) return sphere_names_;
  if (actor == forces_.solid() || actor == forces_.ghost()) return ForceArrows::Names();
  if (actor == marks_.actor() || actor == ghost_marks_.actor()) {
    std::vector<std::string> names(kMarkParts, "support polygon");
    names[kComRing] = names[kComLine] = "line of the centre of mass";
    names[kCopEdge] = names[kCopDisc] = "centre of pressure";
    return names;
  }
  const auto is_axes = [&](const std::unique_ptr<AxesActor>& axes) {
    return axes != nullptr && (is_of(axes->solids()) || is_of(axes->ghosts()));
  };
  if (is_axes(frames_)) return {"link frames"};
  if (is_axes(joint_axes_)) return {"joint axes"};
  return {};
}

// Made when they are asked for: most pictures have none. @return whether there are others now.
bool PersonActors::UpdateAxes(const PersonState& person, const SceneLook& look) {
  bool is_changed = false;
  const auto update = [&](ScenePart part, AxesActor::Kind kind, std::unique_ptr<AxesActor>& axes) {
    const bool is_shown = look.Shows(part);
    is_changed = is_changed || is_shown != (axes != nullptr);
    if (!is_shown) return axes.reset();
    if (axes == nullptr) axes = std::make_unique<AxesActor>(kind);
    axes->Show(person);
  };
  update(ScenePart::kFrames, AxesActor::Kind::kFrames, frames_);
  update(ScenePart::kAxes, AxesActor::Kind::kJoints, joint_axes_);
  return is_changed;
}

void PersonActors::UpdateShadow(const PersonState& person, const SceneLook& look) {
  const skin::Capsules* const limbs = body_->limbs();
  const bool is_shown = look.Shows(ScenePart::kShadows);
  has_floor_shadow_ = is_shown && limbs != nullptr;
  shadow()->SetVisibility(is_shown && limbs == nullptr);
  if (has_floor_shadow_) return floor_shadow_.Cast(*limbs);
  shadow_.SetOverride(Color(ColorsOf(look.theme).shadow));
  PlaceShadow(person);
}

// Not where a lamp would cast them, but what tells the eye where the person stands.
void PersonActors::PlaceShadow(const PersonState& person) {
  const urdf::Skeleton& skeleton = person.model->human.skeleton;
  const double size = skeleton.height / urdf::kReferenceHeight;
  const Eigen::Vector3d middle =
      0.5 * (person.links[urdf::kPelvis].position + person.links[urdf::kT8].position);
  shadow_.Place(kBodyShadow, At(middle.x(), middle.y(), 0.002, 0.55 * size));
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const int part = side == urdf::kRight ? kRightFootShadow : kLeftFootShadow;
    const urdf::Pose& foot =
        person.links[side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot];
    const Eigen::Vector3d heel = foot.position + foot.orientation * skeleton.heel_in_foot[side];
    const Eigen::Vector3d ball =
        foot.position +
        foot.orientation *
            urdf::EndOf(skeleton, side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot);
    const double lift = std::max(0.0, std::min(heel.z(), ball.z()));
    if (lift > 0.5) {
      shadow_.Hide(part);
      continue;
    }
    const Eigen::Vector3d center = 0.4 * heel + 0.6 * ball;
    Eigen::Affine3d place = At(center.x(), center.y(), 0.003, 1);
    place.rotate(Eigen::AngleAxisd(std::atan2(ball.y() - heel.y(), ball.x() - heel.x()),
                                   Eigen::Vector3d::UnitZ()));
    place.scale(Eigen::Vector3d(0.24 * size, 0.13 * size, 1) * (1 - lift));
    shadow_.Place(part, place);
  }
  shadow_.Commit();
}

void PersonActors::UpdateMarks(const PersonState& person, bool has_spheres, const Camera& camera,
                               double metres_per_pixel) {
  const double height = person.model->human.skeleton.height;
  const MarkSizes sizes = MarkSizesOf(height);
  looks_.clear();
  sphere_names_.clear();
  for (const JointLoad& load : person.loads) {
    // The last one is for the centre of mass.
    if (!has_spheres || looks_.size() + 1 == kSphereCapacity) break;
    looks_.push_back({load.position, SphereRadius(load.joint, load.load_class, *person.model),
                      SphereDepth(load.joint, height), ColorOf(load.load_class),
                      RimOf(load.load_class)});
    sphere_names_.emplace_back(urdf::kJoints[static_cast<std::size_t>(load.joint)].ros_name);
  }
  for (PartActor* marks : {&marks_, &ghost_marks_}) {
    const bool is_ghost = marks == &ghost_marks_;
    for (int part = 0; part < (is_ghost ? kGhostMarkParts : kMarkParts); ++part) marks->Hide(part);
    if (person.com) {
      const Eigen::Vector3d& com = *person.com;
      marks->Place(kComRing, At(com.x(), com.y(), 0.004, sizes.com_ring));
      marks->Place(kComLine, At(com.x(), com.y(), 0.5 * com.z(), sizes.com_line, com.z()));
    }
    if (person.cop) {
      marks->Place(kCopEdge, At(person.cop->x(), person.cop->y(), 0.006, sizes.cop_edge));
      marks->Place(kCopDisc, At(person.cop->x(), person.cop->y(), 0.008, sizes.cop));
    }
    if (!is_ghost) {
      const SupportPolygon& support = person.forces.support;
      for (std::size_t i = 0; i < support.size && support.size > 1; ++i) {
        marks->Place(kSupportEdge + static_cast<int>(i),
                     Edge(support.corners[i], support.corners[(i + 1) % support.size]));
      }
    }
    marks->Commit();
  }
  if (person.com) {
    looks_.push_back({*person.com, sizes.com, sizes.com_depth, kComColor, 0});
    sphere_names_.emplace_back("centre of mass");
  }
  double largest = 0;
  for (const SphereLook& look : looks_) largest = std::max(largest, look.radius);
  const bool is_small =
      metres_per_pixel > 0 && largest < SphereActor::kSmallRadius * metres_per_pixel;
  spheres_.Show(looks_, camera, is_small);
  ghost_spheres_.Show(looks_, camera, is_small);
}

void PersonActors::UpdateHeld(const PersonState& person, Liveness liveness) {
  const HandLoadShape held = ShapeOfHandLoad(person);
  held_.actor()->SetVisibility(held.count > 0);
  if (held.count == 0) return;
  held_names_.assign(kHeldParts, "");
  for (int part = 0; part < kHeldParts; ++part) held_.Hide(part);
  int cylinder = 0;
  for (std::size_t i = 0; i < held.count; ++i) {
    const HandLoadSolid& solid = held.solids[i];
    const bool is_box = solid.kind == HandLoadSolid::Kind::kBox;
    Eigen::Affine3d place(Eigen::Translation3d(solid.pose.position) * solid.pose.orientation);
    place.scale(solid.size);
    const int part = is_box ? kHeldBox : cylinder++;
    held_.Place(part, place);
    held_names_[static_cast<std::size_t>(part)] = HeldName(solid);
  }
  held_.SetOverride(liveness == Liveness::kStale ? Color(kStaleBodyColor)
                                                 : Eigen::Vector4f(Eigen::Vector4f::Zero()));
  held_.Commit();
}

// Ghosts are where the solids are.
void PersonActors::AddTo(PictureRegion& region) const {
  body_->AddTo(region);
  shadow_.AddTo(region);
  held_.AddTo(region);
  marks_.AddTo(region);
  spheres_.AddTo(region);
  forces_.AddTo(region);
  for (const auto* axes : {&frames_, &joint_axes_}) {
    if (*axes != nullptr) (*axes)->AddTo(region);
  }
}

}  // namespace kinescope::render
