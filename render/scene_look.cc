#include "render/scene_look.h"

#include <limits>

namespace kinescope::render {

const std::array<ScenePartInfo, 14> kSceneParts = {{
    {ScenePart::kBody, "body", true, "bodies of the people"},
    {ScenePart::kLoads, "loads", true, "one load sphere per scored joint"},
    {ScenePart::kCom, "com", true, "centre of mass and its projection on the floor"},
    {ScenePart::kCop, "cop", true, "centre of pressure"},
    {ScenePart::kSupport, "support", true, "support polygon"},
    {ScenePart::kForces, "forces", true, "ground reaction force on each foot, 1 m per 1000 N"},
    {ScenePart::kHeld, "hand_loads", true, "loads in the hands"},
    {ScenePart::kShadows, "shadows", true, "soft shadows on the floor"},
    {ScenePart::kObjects, "objects", true, "tracked objects"},
    {ScenePart::kRobots, "robots", true, "robots beside the people"},
    {ScenePart::kMarkers, "markers", true, "external markers"},
    {ScenePart::kFrames, "link_frames", false, "axes of each link: x red, y green, z blue"},
    {ScenePart::kAxes, "joint_axes", false, "the three rotation axes of each joint"},
    {ScenePart::kScale, "scale", false,
     "length labels on the floor grid in metres, force labels on the arrows in newtons"},
}};

ScenePartSet::ScenePartSet() {
  for (const ScenePartInfo& info : kSceneParts) Set(info.part, info.by_default);
}

Theme ThemeOn(const Rgb& background) {
  constexpr double kDarkBelow = 0.4;
  const double luma = 0.2126 * background[0] + 0.7152 * background[1] + 0.0722 * background[2];
  return luma < kDarkBelow ? Theme::kDark : Theme::kLight;
}

const ThemeColors& ColorsOf(Theme theme) {
  static const ThemeColors light = {{0.955, 0.962, 0.972},
                                    {0.915, 0.925, 0.940},
                                    {0.78, 0.80, 0.83},
                                    {0.62, 0.65, 0.70},
                                    {0.20, 0.23, 0.30}};
  static const ThemeColors dark = {{0.085, 0.098, 0.118},
                                   {0.125, 0.140, 0.165},
                                   {0.20, 0.225, 0.26},
                                   {0.30, 0.335, 0.38},
                                   {0, 0, 0}};
  return theme == Theme::kDark ? dark : light;
}

namespace {

constexpr std::array<ScenePart, 9> kPartsOfState = {
    ScenePart::kLoads,   ScenePart::kCom,    ScenePart::kCop,
    ScenePart::kSupport, ScenePart::kForces, ScenePart::kHeld,
    ScenePart::kObjects, ScenePart::kRobots, ScenePart::kMarkers};

}  // namespace

bool HidesAnything(const SceneLook& look) {
  for (const ScenePart part : kPartsOfState) {
    if (!look.Shows(part)) return true;
  }
  return false;
}

SceneState Without(SceneState state, const SceneLook& look) {
  for (PersonState& person : state.people) {
    if (!look.Shows(ScenePart::kLoads)) person.loads.clear();
    if (!look.Shows(ScenePart::kCom)) person.com.reset();
    if (!look.Shows(ScenePart::kCop)) person.cop.reset();
    if (!look.Shows(ScenePart::kSupport)) person.forces.support.size = 0;
    if (!look.Shows(ScenePart::kForces)) {
      for (FootForce& foot : person.forces.feet) {
        foot.force.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
    if (!look.Shows(ScenePart::kHeld)) {
      for (HandForce& hand : person.forces.hands) hand.mass_kg = hand.shared_kg = 0;
    }
  }
  if (!look.Shows(ScenePart::kObjects)) state.objects.clear();
  if (!look.Shows(ScenePart::kRobots)) state.robots.clear();
  if (!look.Shows(ScenePart::kMarkers)) state.markers.clear();
  return state;
}

}  // namespace kinescope::render
