// What a legend lists, and where it stands beside the scene.

#include "render/legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "core/system/errors.h"
#include "render/legend_place.h"
#include "render/overlay.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::Posture;
using kinescope::testing::SceneWith;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::vector<std::string> NamesOf(const LegendContent& content) {
  std::vector<std::string> names;
  for (const LegendRow& row : content.rows) names.push_back(row.name);
  return names;
}

LegendRow RowNamed(const LegendContent& content, const std::string& name) {
  for (const LegendRow& row : content.rows) {
    if (row.name == name) return row;
  }
  ADD_FAILURE() << "no entry " << name;
  return {};
}

RobotState Robot(const std::string& name) {
  RobotState robot;
  robot.name = name;
  auto model = std::make_shared<urdf::RobotModel>();
  urdf::Link link;
  link.visuals.emplace_back().rgba = Eigen::Vector4d(0.9, 0.8, 0.1, 1);
  model->links.push_back(link);
  robot.model = model;
  robot.world_from_link = {Eigen::Isometry3d::Identity()};
  return robot;
}

TEST(Legend, ListsOnlyWhatThePictureShowsWithItsColours) {
  SceneState state = SceneWith(Posture::kStanding);
  SceneLook look;
  const std::size_t plain = LegendOf(state, look).rows.size();
  look.trails = {{{}, {0.2, 0.45, 0.8}, "right hand"}, {{}, kComColor, "centre of mass"}};
  look.ghosts = {{state.people[0], 0.35, "N-pose"}, {state.people[0], 0.35, "N-pose"}};
  state.robots = {Robot("arm")};
  state.objects.resize(2);
  auto marker = std::make_shared<SceneMarker>(), frames = std::make_shared<SceneMarker>(),
       grid = std::make_shared<SceneMarker>(), axes = std::make_shared<SceneMarker>();
  axes->ns = kNamespaceOfAxes;
  frames->ns = kNamespaceOfFrames;
  grid->ns = kNamespaceOfGrids;
  marker->ns = "goal";
  marker->color = {0, 1, 0, 1};
  const auto red = std::make_shared<SceneMarker>(*marker);
  red->color = {1, 0, 0, 1};
  state.markers = {marker, red, frames, grid, axes};
  const LegendContent content = LegendOf(state, look);
  EXPECT_THAT(NamesOf(content), IsSupersetOf({"path: right hand", "path: centre of mass", "N-pose",
                                              "robot arm", "tracked object", "marker goal"}));
  EXPECT_EQ(content.rows.size(), plain + 6) << "each once";
  EXPECT_EQ(RowNamed(content, "path: right hand").ink.color, (Rgb{0.2, 0.45, 0.8}));
  EXPECT_EQ(RowNamed(content, "path: right hand").symbol, LegendRow::Symbol::kLine);
  EXPECT_EQ(RowNamed(content, "robot arm").ink.color, (Rgb{0.9, 0.8, 0.1}));
  EXPECT_EQ(RowNamed(content, "marker goal").ink.color, (Rgb{0, 1, 0}));
  for (const ScenePart part : {ScenePart::kRobots, ScenePart::kObjects, ScenePart::kMarkers}) {
    look.shown.Set(part, false);
  }
  EXPECT_THAT(NamesOf(LegendOf(state, look)),
              AllOf(Not(Contains("robot arm")), Not(Contains("tracked object")),
                    Not(Contains("marker goal"))));
}

TEST(Legend, OfASceneWithoutPeopleHasNoLoads) {
  SceneState state;
  state.liveness = Liveness::kNoPerson;
  state.stamp_nanos = 1'000'000'000;
  EXPECT_TRUE(LegendOf(state, {}).rows.empty());
  state.robots = {Robot("arm")};
  EXPECT_FALSE(HasOnlyRobots(state)) << "it has a time";
  const LegendContent content = LegendOf(state, {});
  EXPECT_EQ(NamesOf(content), std::vector<std::string>{"robot arm"});
  EXPECT_FALSE(content.has_classes());
  EXPECT_EQ(content.title, kSymbolsTitle);
}

TEST(Legend, NamesToolsInTheHandsWithTheColourOfThoseThatAreDrawn) {
  SceneState state = SceneWith(Posture::kStanding);
  const std::size_t plain = LegendOf(state, SceneLook()).rows.size();
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  model->human.tools.set(urdf::kRight).set(urdf::kLeft);
  for (urdf::Link& link : model->robot.links) {
    if (link.name.find("_hand") == std::string::npos) continue;
    urdf::Visual& tool = link.visuals.emplace_back();
    tool.material = urdf::kToolMaterial;
    tool.rgba = Eigen::Vector4d(0.1, 0.2, 0.3, 1);
  }
  state.people[0].model = model;
  const LegendContent content = LegendOf(state, SceneLook());
  EXPECT_EQ(content.rows.size(), plain + 1) << "one entry for both hands";
  EXPECT_EQ(RowNamed(content, "tool in the hand").ink.color, (Rgb{0.1, 0.2, 0.3}));
  EXPECT_TRUE(RowNamed(content, "tool in the hand").is_addition());
  SceneLook without_body;
  without_body.shown.Set(ScenePart::kBody, false);
  EXPECT_THAT(NamesOf(LegendOf(state, without_body)), Not(Contains("tool in the hand")))
      << "tools are hidden with the body";
}

TEST(Legend, CountsRobotsBeyondTheFirstFew) {
  SceneState state = SceneWith(Posture::kStanding);
  for (int i = 0; i < 60; ++i) state.robots.push_back(Robot(std::to_string(i)));
  const std::vector<std::string> names = NamesOf(LegendOf(state, SceneLook()));
  EXPECT_THAT(names, IsSupersetOf({"robot 0", "robot 2", "57 other robots"}));
  EXPECT_LT(names.size(), 12u);
}

TEST(Legend, OfSeveralMomentsHasTheEntriesOfAll) {
  SceneState state = SceneWith(Posture::kStanding);
  LegendContent content = LegendOf(state, SceneLook());
  const std::size_t before = content.rows.size();
  state.objects.resize(1);
  content.Add(LegendOf(state, SceneLook()));
  EXPECT_EQ(content.rows.size(), before + 1);
  EXPECT_THAT(NamesOf(content), Contains("tracked object"));
}

// Where each overlay is painted, px of the picture.
class PlaceRecorder : public Painter {
 public:
  struct Place {
    double left, top, right, bottom;
    std::string text;
  };

  void Enter(const Tile& part) override { tile_ = part; }
  void RoundedBox(double x, double y, double width, double height, double /*radius*/,
                  const Ink& /*ink*/) override {
    Add(x, y, x + width, y + height);
  }
  void Disc(double x, double y, double radius, const Ink& /*ink*/) override {
    Add(x - radius, y - radius, x + radius, y + radius);
  }
  void Ring(double x, double y, double /*inner*/, double radius, const Ink& /*ink*/) override {
    Add(x - radius, y - radius, x + radius, y + radius);
  }
  void Polyline(const std::vector<std::pair<double, double>>& points, double /*width*/,
                const Ink& /*ink*/) override {
    for (const auto& [x, y] : points) Add(x, y, x, y);
  }
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
              const Ink& /*ink*/) override {
    const double end = x + font.Width(utf8, size_px);
    Add(x, y - 0.75 * size_px, end, y + 0.2 * size_px, std::string(utf8));
    return end;
  }

  std::vector<Place> places;

 private:
  void Add(double left, double top, double right, double bottom, std::string text = "") {
    places.push_back(
        {tile_.x + left, tile_.y + top, tile_.x + right, tile_.y + bottom, std::move(text)});
  }
  Tile tile_{};
};

PictureSpec SpecOf(int width, int height, LegendPlace place) {
  PictureSpec spec;
  spec.width = width;
  spec.height = height;
  spec.legend = place;
  for (const OverlayInfo& overlay : kOverlays) spec.parts.*overlay.part = false;
  spec.parts.legend = true;
  return spec;
}

void ExpectBesideTheScene(PictureSpec spec) {
  SceneState state = SceneWith(Posture::kStanding);
  spec.look.trails = {{{}, kComColor, "centre of mass"}};
  spec.look.ghosts = {{state.people[0], 0.35, "N-pose"}};
  PlaceLegend(spec, LegendOf(state, spec.look));
  ASSERT_TRUE(spec.scene.has_value());
  const Tile& scene = *spec.scene;
  EXPECT_GE(scene.width, 0.4 * spec.width);
  EXPECT_GE(scene.height, 0.4 * spec.height);
  PlaceRecorder recorder;
  Overlay().Paint(recorder, state, {{scene, Camera(), "", {}}}, spec);
  std::vector<std::string> texts;
  for (const PlaceRecorder::Place& place : recorder.places) {
    const bool is_over_scene = place.left < scene.x + scene.width && place.top < scene.height;
    EXPECT_FALSE(is_over_scene) << place.text << " at " << place.left << ", " << place.top;
    EXPECT_GE(place.left, 0) << place.text;
    EXPECT_LE(place.right, spec.width) << place.text;
    EXPECT_LE(place.bottom, spec.height) << place.text;
    texts.push_back(place.text);
    for (const PlaceRecorder::Place& other : recorder.places) {
      if (&other == &place || place.text.empty() || other.text.empty()) continue;
      const bool overlaps = place.left < other.right && other.left < place.right &&
                            place.top < other.bottom && other.top < place.bottom;
      EXPECT_FALSE(overlaps) << place.text << " and " << other.text;
    }
  }
  EXPECT_THAT(texts, IsSupersetOf({"low", "≤ 30 %", "unknown", "path: centre of mass", "N-pose"}));
}

TEST(LegendPlace, IsBesideTheSceneAndWithinThePicture) {
  for (const LegendPlace place : {LegendPlace::kBelow, LegendPlace::kOutside}) {
    for (const auto& [width, height] :
         {std::pair(1280, 720), std::pair(640, 480), std::pair(480, 640), std::pair(3000, 3000)}) {
      PictureSpec spec = SpecOf(width, height, place);
      ExpectBesideTheScene(spec);
      spec.print = {160, 7};
      spec.width = 1890;
      spec.height = 1890 * height / width;
      ExpectBesideTheScene(spec);
    }
  }
}

TEST(LegendPlace, LeavesTheWholePictureToTheSceneIfThereIsNoLegend) {
  const SceneState state = SceneWith(Posture::kStanding);
  PictureSpec spec = SpecOf(640, 480, LegendPlace::kBelow);
  spec.parts.legend = false;
  PlaceLegend(spec, LegendOf(state, spec.look));
  EXPECT_FALSE(spec.scene.has_value());
  spec.parts.legend = true;
  PlaceLegend(spec, {});
  EXPECT_FALSE(spec.scene.has_value()) << "nothing to list";
  spec.legend = LegendPlace::kInside;
  PlaceLegend(spec, LegendOf(state, spec.look));
  EXPECT_FALSE(spec.scene.has_value());
}

TEST(LegendPlace, RejectsAPictureWithoutRoom) {
  const SceneState state = SceneWith(Posture::kStanding);
  const auto error = [&](PictureSpec spec) -> std::string {
    try {
      PlaceLegend(spec, LegendOf(state, spec.look));
    } catch (const UsageError& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_THAT(error(SpecOf(200, 100, LegendPlace::kBelow)),
              AllOf(HasSubstr("--legend=below"), HasSubstr("px of"), HasSubstr("larger picture")));
  EXPECT_THAT(error(SpecOf(160, 400, LegendPlace::kOutside)),
              AllOf(HasSubstr("--legend=outside"), HasSubstr("width")));
  PictureSpec printed = SpecOf(945, 709, LegendPlace::kOutside);
  printed.print = {80, 14};
  EXPECT_THAT(error(printed), HasSubstr("--text_pt"));
}

TEST(LegendPlace, DrawsTheSceneAsAPictureOfItsSize) {
  const auto renderer = MakeRenderer();
  const SceneState state = SceneWith(Posture::kStanding);
  const Camera camera = kinescope::testing::FrontCamera();
  for (const LegendPlace place : {LegendPlace::kBelow, LegendPlace::kOutside}) {
    PictureSpec spec = SpecOf(480, 360, place);
    spec.supersample = 1;
    PlaceLegend(spec, LegendOf(state, spec.look));
    const Tile scene = spec.SceneTile();
    const Image whole = renderer->Render(state, camera, spec);
    PictureSpec alone = spec;
    alone.scene.reset();
    alone.width = scene.width;
    alone.height = scene.height;
    alone.overlays = false;
    const Image part = renderer->Render(state, camera, alone);
    int differing = 0, ink_in_legend = 0;
    const auto at = [](const Image& image, int x, int y) {
      return &image.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x))];
    };
    for (int y = 0; y < whole.height; ++y) {
      for (int x = 0; x < whole.width; ++x) {
        const bool is_scene = x < scene.width && y < scene.height;
        if (is_scene) {
          differing += std::equal(at(whole, x, y), at(whole, x, y) + 4, at(part, x, y)) ? 0 : 1;
        } else {
          ink_in_legend += at(whole, x, y)[0] < 100 ? 1 : 0;
        }
      }
    }
    EXPECT_EQ(differing, 0);
    EXPECT_GT(ink_in_legend, 200);
  }
}

TEST(LegendPlace, OfViewsOfSeveralMomentsShowsEachWithItsScene) {
  const auto renderer = MakeRenderer();
  const SceneState standing = SceneWith(Posture::kStanding), bent = SceneWith(Posture::kDeepBend);
  const Camera camera = kinescope::testing::FrontCamera();
  PictureSpec spec = SpecOf(400, 160, LegendPlace::kInside);
  spec.overlays = false;
  spec.supersample = 1;
  spec.pane_columns = 2;
  for (const SceneState* state : {&standing, &bent}) {
    SceneState raised = *state;
    raised.floor_z = 0.5;  // of a recording whose floor is found late
    raised.people[0].com.reset();
    spec.panes.push_back(
        {"", camera, std::make_shared<const PaneScene>(PaneScene{raised, {}, {}})});
  }
  const Image both = renderer->Render(standing, camera, spec);
  spec.panes[1].scene = spec.panes[0].scene;
  const Image same = renderer->Render(standing, camera, spec);
  EXPECT_NE(both.rgba, same.rgba);
  SceneState broken = bent;
  broken.people[0].links[urdf::kPelvis].position.x() = std::nan("");
  spec.panes[1].scene = std::make_shared<const PaneScene>(PaneScene{broken, {}, {}});
  renderer->Render(standing, camera, spec);
  EXPECT_FALSE(renderer->problems().empty()) << "a pose that is not finite is left out and named";
}

}  // namespace
}  // namespace kinescope::render
