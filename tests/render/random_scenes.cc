#include "tests/render/random_scenes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/system/errors.h"
#include "render/legend_place.h"
#include "render/load_curves.h"
#include "render/overlay_parts.h"
#include "tests/render/test_scene.h"
#include "tests/worn.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope::testing {
namespace {

using Eigen::Vector3d;

// Boxes and a cylinder, one of them translucent.
const char* const kRobot = R"(<robot name="arm">
  <link name="base"><visual><geometry><box size="0.4 0.3 0.5"/></geometry></visual></link>
  <link name="upper"><visual><geometry><cylinder radius="0.06" length="0.7"/></geometry></visual></link>
  <link name="hand"><visual><geometry><sphere radius="0.12"/></geometry>
    <material name="glass"><color rgba="0.2 0.5 0.9 0.4"/></material></visual></link>
  <joint name="a" type="fixed"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.6"/></joint>
  <joint name="b" type="fixed"><parent link="upper"/><child link="hand"/><origin xyz="0.1 0 0.4"/></joint>
</robot>)";

enum { kBare, kGloves, kPrimitives, kModels };

}  // namespace

RandomScenes::RandomScenes(unsigned seed) : random_(seed) {
  const auto bare = MakePersonModel();
  for (int i = 0; i < kModels; ++i) {
    auto model = std::make_shared<PersonModel>(i == kGloves ? *WornModel(*bare) : *bare);
    model->has_built_in_surface = i != kPrimitives;
    models_.push_back(std::move(model));
  }
  robot_ = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(kRobot));
}

double RandomScenes::Uniform(double from, double to) {
  // Of our own: the standard's distributions differ between libraries.
  return from + (to - from) * (random_() / 4294967296.0);
}

bool RandomScenes::Chance(double share) { return Uniform(0, 1) < share; }

int RandomScenes::Below(int count) {
  return static_cast<int>(random_() % static_cast<unsigned>(count));
}

// On the floor; now and then far away.
Vector3d RandomScenes::Place() {
  const double reach = Chance(0.05) ? 40 : 2.5;
  return {Uniform(-reach, reach), Uniform(-reach, reach), 0};
}

RandomScenes::View RandomScenes::NextView(int largest_px) {
  View view;
  view.spec.width = 160 + Below(largest_px - 159);
  view.spec.height = 160 + Below(largest_px - 159);
  view.spec.supersample = Chance(0.5) ? 2 : Chance(0.1) ? 4 : 1;
  view.spec.overlays = Chance(0.5);
  render::SceneLook& look = view.spec.look;
  look.theme = Chance(0.5) ? render::Theme::kDark : render::Theme::kLight;
  look.floor = Chance(0.8);
  look.figure = Chance(0.6) ? render::Figure::kSkin : render::Figure::kUrdf;
  look.detail = Chance(0.5) ? render::Detail::kBySize : render::Detail::kFull;
  look.loads = static_cast<render::LoadsShown>(Below(3));
  look.style = Chance(0.1)   ? render::Style::kLine
               : Chance(0.2) ? render::Style::kClay
                             : render::Style::kMatte;
  for (const render::ScenePart part :
       {render::ScenePart::kFrames, render::ScenePart::kAxes, render::ScenePart::kShadows,
        render::ScenePart::kBody, render::ScenePart::kScale}) {
    look.shown.Set(part, Chance(0.5));
  }
  view.camera = RandomCamera();
  if (Chance(0.15)) {
    for (int i = 2 + Below(3); i > 0; --i) view.spec.panes.push_back({"view", RandomCamera()});
    view.spec.pane_columns = 2;
  }
  if (view.spec.overlays) AddOverlays(view.spec);
  return view;
}

render::Camera RandomScenes::RandomCamera() {
  render::Camera camera;
  camera.target = {Uniform(-0.5, 0.5), Uniform(-0.5, 0.5), Uniform(0.5, 1.2)};
  const double distance = Chance(0.1) ? Uniform(0.3, 1) : Uniform(2, 8);
  const double around = Uniform(-M_PI, M_PI), above = Uniform(-0.1, 1.4);
  camera.position =
      camera.target + distance * Vector3d(std::cos(around) * std::cos(above),
                                          std::sin(around) * std::cos(above), std::sin(above));
  camera.vertical_fov_rad = Uniform(0.2, 1.2);
  if (Chance(0.2)) camera = render::Orthographic(camera);
  return camera;
}

PersonState RandomScenes::Person(int character) {
  const Vector3d place = Place();
  PersonState person = MixedScene(static_cast<Posture>(Below(3))).people[0];
  person.character = character;
  const int wears = character % kModels;  // makes no new skin when they jump
  person.model = models_[static_cast<std::size_t>(wears)];
  if (wears == kGloves) Wear(person, Uniform(0, 0.9), person.model);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(Uniform(-M_PI, M_PI), Vector3d::UnitZ()));
  const auto move = [&](Vector3d& point) { point = turn * point + place; };
  for (urdf::Pose& pose : person.links) {
    move(pose.position);
    const Vector3d axis(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1));
    pose.orientation =
        turn * pose.orientation *
        Eigen::AngleAxisd(Uniform(0, 0.4), (axis + Vector3d(0, 0, 1e-6)).normalized());
  }
  for (JointLoad& load : person.loads) move(load.position);
  if (person.com) move(*person.com);
  if (person.cop) move(*person.cop);
  for (FootForce& foot : person.forces.feet) {
    if (Chance(0.5)) continue;
    foot.cop = place + Vector3d(Uniform(-0.2, 0.2), Uniform(-0.2, 0.2), 0);
    foot.force = {Uniform(-80, 80), Uniform(-80, 80), Uniform(0, 900)};
  }
  return person;
}

std::shared_ptr<const SceneMarker> RandomScenes::Marker(int id) {
  SceneMarker marker;
  marker.ns = "random";
  marker.id = id;
  constexpr MarkerType kTypes[] = {MarkerType::kCube, MarkerType::kSphere, MarkerType::kCylinder,
                                   MarkerType::kText};
  marker.type = kTypes[Below(4)];
  if (marker.type == MarkerType::kText) marker.text = "marker";
  marker.pose.position = Place() + Vector3d(0, 0, Uniform(0, 2));
  const double size = Chance(0.03) ? 100 : Uniform(0.02, 0.5);
  marker.scale = Vector3d(Uniform(0.1, 1), Uniform(0.1, 1), Uniform(0.1, 1)) * size;
  marker.color = {Uniform(0, 1), Uniform(0, 1), Uniform(0, 1), Chance(0.3) ? 0.4 : 1};
  return std::make_shared<const SceneMarker>(marker);
}

void RandomScenes::AddOverlays(render::PictureSpec& spec) {
  for (const render::OverlayInfo& overlay : render::kOverlays) {
    spec.parts.*overlay.part = Chance(0.6);
  }
  if (Chance(0.5)) spec.title = std::string(static_cast<std::size_t>(Below(60)), 'T') + " title";
  for (int i = Below(3); i > 0; --i) spec.marks.push_back("marked");
  if (Chance(0.3)) spec.print.width_mm = Uniform(40, 200);
  auto loads = std::make_shared<render::LoadCurves>();
  loads->to_secs = 4;
  for (int i = 1 + Below(3); i > 0; --i) {
    render::LoadCurve curve{"Right elbow", {}};
    for (double secs = 0; secs < loads->to_secs; secs += 0.1) {
      curve.points.push_back({secs, Chance(0.1) ? std::nan("") : Uniform(0, 1.2), LoadClass::kLow});
    }
    loads->curves.push_back(std::move(curve));
  }
  spec.load_curves = std::move(loads);
  spec.plot_secs = Uniform(0, 4);
  if (Chance(0.6)) return;
  const render::PictureSpec inside = spec;
  spec.legend = Chance(0.5) ? render::LegendPlace::kBelow : render::LegendPlace::kOutside;
  try {
    render::PlaceLegend(spec, render::LegendOf(MixedScene(Posture::kStanding), spec.look));
  } catch (const UsageError&) {  // no room
    spec = inside;
  }
}

RobotState RandomScenes::Robot() {
  RobotState robot;
  robot.name = "arm";
  robot.model = robot_;
  robot.world_from_link = urdf::PlaceLinks(*robot_, {});
  const Eigen::Isometry3d place =
      Eigen::Translation3d(Place()) * Eigen::AngleAxisd(Uniform(-M_PI, M_PI), Vector3d::UnitZ());
  for (Eigen::Isometry3d& link : robot.world_from_link) link = place * link;
  return robot;
}

SceneState RandomScenes::NextState(render::SceneLook& look) {
  if (people_.size() < 4 && Chance(0.3)) {
    people_.push_back(Person(1 + Below(8)));
    const int character = people_.back().character;
    const auto same = std::find_if(people_.begin(), people_.end() - 1, [&](const auto& person) {
      return person.character == character;
    });
    if (same != people_.end() - 1) people_.erase(same);
  }
  if (!people_.empty() && Chance(0.1)) people_.erase(people_.begin());
  for (PersonState& person : people_) {
    if (Chance(0.8)) person = Person(person.character);
  }
  if (Chance(0.3)) {
    markers_.clear();
    for (int i = Below(5); i > 0; --i) markers_.push_back(Marker(i));
  }
  trail_.push_back(Place() + Vector3d(0, 0, Uniform(0, 2)));
  if (trail_.size() > 6) trail_.erase(trail_.begin());
  look.trails.clear();
  look.ghosts.clear();
  if (Chance(0.4)) look.trails.push_back({trail_, {0.1, 0.4, 0.7}, "hand"});
  if (Chance(0.2)) look.ghosts.push_back({Person(1), 0.35, "reference"});

  SceneState state;
  state.liveness = Chance(0.2) ? Liveness::kStale : Liveness::kLive;
  state.people = people_;
  state.counter = static_cast<std::uint32_t>(Below(100'000));
  state.time_code_millis = Below(86'400'000);
  state.markers = markers_;
  if (Chance(0.3)) state.robots.push_back(Robot());
  if (Chance(0.3)) {
    TrackedObject object;
    object.name = "tool";
    object.pose.position = Place();
    state.objects.push_back(object);
  }
  return state;
}

}  // namespace kinescope::testing
