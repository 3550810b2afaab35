// Markers of other programs, tested by what the picture shows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <utility>

#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/marker_samples.h"
#include "tests/temp_folder.h"
#include "tests/urdf/mesh_samples.h"

namespace kinescope::render {
namespace {

constexpr int kViewWidth = 480, kViewHeight = 270;

SceneState Empty() {
  SceneState state;
  state.liveness = Liveness::kLive;
  return state;
}

SceneState With(std::vector<SceneMarker> markers) {
  SceneState state = Empty();
  for (SceneMarker& marker : markers) {
    state.markers.push_back(std::make_shared<SceneMarker>(std::move(marker)));
  }
  return state;
}

Camera Ahead() {
  Camera camera;
  camera.position = {5, 0, 1.6};
  camera.target = {0, 0, 0.8};
  return camera;
}

class MarkerDrawing : public ::testing::Test {
 protected:
  MarkerDrawing() {
    spec_.width = kViewWidth;
    spec_.height = kViewHeight;
    spec_.parts.legend = false;  // which names the markers
    std::ofstream(folder_ / "box.stl", std::ios::binary) << kinescope::testing::BoxStl();
  }
  std::vector<SceneMarker> All() const {
    return kinescope::testing::MarkersOfAllTypes("file://" + (folder_ / "box.stl").string());
  }
  SceneMarker Sample(MarkerType type) const { return All().at(static_cast<std::size_t>(type)); }
  Image Draw(const SceneState& state) { return renderer_->Render(state, Ahead(), spec_); }

  const kinescope::testing::TempFolder folder_;
  std::vector<std::string> log_;
  const std::unique_ptr<Renderer> renderer_ =
      MakeRenderer("osmesa", [this](const std::string& line) { log_.push_back(line); });
  PictureSpec spec_;
};

TEST_F(MarkerDrawing, RendersEveryTypeAtItsPosition) {
  const Image empty = Draw(Empty());
  const std::vector<SceneMarker> all = All();
  ASSERT_EQ(all.size(), 12u);
  for (const SceneMarker& marker : all) {
    const Image image = Draw(With({marker}));
    const Comparison change = Compare(empty, image);
    const Projected at = Project(marker.pose.position, Ahead(), kViewWidth, kViewHeight);
    ASSERT_GT(change.pixels, 20) << Name(marker.type);
    const double reach = 0.45 * at.px_per_m;
    EXPECT_NEAR(0.5 * (change.left + change.right), at.x_px, reach) << Name(marker.type);
    EXPECT_NEAR(0.5 * (change.top + change.bottom), at.y_px, reach) << Name(marker.type);
  }
  EXPECT_THAT(log_, ::testing::IsEmpty());
  EXPECT_THAT(renderer_->problems(), ::testing::IsEmpty());
}

TEST_F(MarkerDrawing, NamesNonFiniteMarkersAndRendersTheOthers) {
  SceneMarker good = Sample(MarkerType::kCube);
  SceneMarker bad = good;
  bad.ns = "walls";
  bad.id = 7;
  bad.pose.position.y() = std::numeric_limits<double>::quiet_NaN();
  const Image expected = Draw(With({good}));
  EXPECT_EQ(Draw(With({bad, good})).rgba, expected.rgba);
  EXPECT_THAT(renderer_->problems(), ::testing::ElementsAre(::testing::HasSubstr("walls/7")));
  EXPECT_THAT(log_, ::testing::ElementsAre(::testing::HasSubstr("position is not finite")));
}

TEST_F(MarkerDrawing, DrawsPointsAsSquaresThatFaceTheCameraInTheirOwnColour) {
  SceneMarker points;
  points.type = MarkerType::kPoints;
  points.scale = {0.4, 0.2, 0};
  points.points = {{0, 0, 0.8}};
  points.colors = {{1, 0.5, 0, 1}};
  for (const Eigen::Vector3d& from : {Eigen::Vector3d(5, 0, 0.8), {0, 5, 0.8}, {3, 0, 4.8}}) {
    Camera camera = Ahead();
    camera.position = from;
    camera.target = points.points[0];
    const Image empty = renderer_->Render(Empty(), camera, spec_),
                image = renderer_->Render(With({points}), camera, spec_);
    const Comparison change = Compare(empty, image);
    const double px_per_m = Project(camera.target, camera, kViewWidth, kViewHeight).px_per_m;
    EXPECT_NEAR(change.right - change.left, 0.4 * px_per_m, 2) << from.transpose();
    EXPECT_NEAR(change.bottom - change.top, 0.2 * px_per_m, 2) << from.transpose();
    const auto* const middle = &image.rgba[4 * (kViewHeight / 2 * kViewWidth + kViewWidth / 2)];
    EXPECT_EQ(std::vector<int>(middle, middle + 3), (std::vector<int>{255, 128, 0})) << "unlit";
  }
}

SceneMarker PointsInPixels(double size_px, std::vector<Eigen::Vector3d> points) {
  SceneMarker marker;
  marker.type = MarkerType::kPoints;
  marker.scale = {size_px, size_px, 0};
  marker.is_in_pixels = true;
  marker.points = std::move(points);
  marker.color = {1, 0.5, 0, 1};
  return marker;
}

TEST_F(MarkerDrawing, DrawsPointsInPixelsEquallyLargeAtAnyDistance) {
  Camera camera = Ahead();
  camera.position.z() = camera.target.z();
  for (const Camera& seen_by : {camera, Orthographic(camera)}) {
    for (const int supersample : {1, 2}) {
      spec_.supersample = supersample;
      const Image empty = renderer_->Render(Empty(), seen_by, spec_);
      for (const double x : {4.0, -30.0}) {  // 1 m and 35 m away, before the middle of the picture
        const SceneMarker point = PointsInPixels(4, {{x, 0, camera.target.z()}});
        const Comparison change = Compare(empty, renderer_->Render(With({point}), seen_by, spec_));
        EXPECT_EQ(change.pixels, 16) << x << " m, " << supersample << "x";
        EXPECT_EQ(change.right - change.left, 3) << x << " m, " << supersample << "x";
        EXPECT_EQ(change.left, kViewWidth / 2 - 2) << x << " m, " << supersample << "x";
        EXPECT_EQ(change.top, kViewHeight / 2 - 2) << x << " m, " << supersample << "x";
      }
    }
  }
}

TEST_F(MarkerDrawing, DrawsPointsInPixelsEquallyLargeInEachTile) {
  spec_.width = 1100;  // drawn as tiles of 1024 and 76 px
  spec_.height = 40;
  spec_.supersample = 4;
  spec_.overlays = false;
  Camera camera = Ahead();
  camera.position.z() = camera.target.z();
  const double px_per_m = Project(camera.target, camera, spec_.width, spec_.height).px_per_m;
  const auto at = [&](double px_from_middle) {
    return Eigen::Vector3d(0, px_from_middle / px_per_m, camera.target.z());
  };
  const Image empty = renderer_->Render(Empty(), camera, spec_);
  const SceneMarker points = PointsInPixels(4, {at(-500), at(500)});
  const Comparison change = Compare(empty, renderer_->Render(With({points}), camera, spec_));
  EXPECT_EQ(change.pixels, 2 * 16);
  EXPECT_EQ(change.right - change.left, 1000 + 3);
  EXPECT_EQ(change.bottom - change.top, 3);
}

// Upright lines before and behind the middle of the picture, of which the second begins behind the
// camera.
TEST_F(MarkerDrawing, DrawsLinesOfAPixelAtAnyDistance) {
  Camera camera = Ahead();
  camera.position.z() = camera.target.z();
  const Eigen::Vector3d ahead = camera.target - camera.position;
  const auto line = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    SceneMarker marker = PointsInPixels(1, {from, to});
    marker.type = MarkerType::kLineList;
    return marker;
  };
  for (const Camera& seen_by : {camera, Orthographic(camera)}) {
    const Image empty = renderer_->Render(Empty(), seen_by, spec_);
    for (const double times : {0.3, 3.0}) {
      const Eigen::Vector3d middle = camera.position + times * ahead;
      const Eigen::Vector3d up(0, 0, 0.2);
      const Comparison change =
          Compare(empty, renderer_->Render(With({line(middle - up, middle + up)}), seen_by, spec_));
      EXPECT_LE(change.right - change.left, 1) << times;
      const Projected at = Project(middle, seen_by, kViewWidth, kViewHeight);
      const Projected end = Project(middle + up, seen_by, kViewWidth, kViewHeight);
      EXPECT_NEAR(change.bottom - change.top, 2 * (at.y_px - end.y_px), 2) << times;
    }
  }
  const Eigen::Vector3d below(0, 0, 0.5);
  const Image empty = renderer_->Render(Empty(), camera, spec_);
  const Comparison change =
      Compare(empty, renderer_->Render(With({line(camera.position - ahead - below,
                                                  camera.position + 20 * ahead - below)}),
                                       camera, spec_));
  EXPECT_LE(change.right - change.left, 1) << "straight down from the middle";
  EXPECT_EQ(change.bottom, kViewHeight - 1);
}

// The names of frames are white, as in RViz, whose background is dark.
// A scan that faces the viewer at the height of a map was half under it, and cells on it were in
// shreds.
TEST_F(MarkerDrawing, ShowsWhatLiesOnAMapWhole) {
  const auto square = [](double side, const Eigen::Vector4d& color, GroundLayer layer) {
    SceneMarker marker;
    marker.type = MarkerType::kTriangleList;
    marker.color = color;
    marker.ground = layer;
    const double s = side / 2;
    marker.points = {{-s, -s, 0}, {s, -s, 0}, {s, s, 0}, {-s, -s, 0}, {s, s, 0}, {-s, s, 0}};
    return marker;
  };
  Camera from_above, plan, from_below;
  from_above.position = {0, 0, 6};
  from_above.target = {0, 0, 0};
  from_above.up = {0.6, 0.8, 0};
  plan = from_above;
  plan.position.z() = 500;
  plan.far_m = 2000;
  plan.ortho_height_m = 4;
  from_below = from_above;
  from_below.position.z() = -6;
  Camera camera;
  const auto pixels_of = [&](const std::vector<SceneMarker>& markers, int channel) {
    const Image image = renderer_->Render(With(markers), camera, spec_);
    int count = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      const auto at = [&](int k) { return int{image.rgba[i + static_cast<std::size_t>(k)]}; };
      const int others = std::max(at((channel + 1) % 3), at((channel + 2) % 3));
      if (at(channel) > 150 && others < 60) ++count;
    }
    return count;
  };
  SceneMarker scan;
  scan.type = MarkerType::kPoints;
  scan.scale = {0.06, 0.06, 0};
  scan.color = {1, 0, 0, 1};
  for (int i = -8; i <= 8; ++i) scan.points.emplace_back(0.1 * i, 0.1 * i, 0);
  const SceneMarker map = square(3, {0, 0, 1, 1}, GroundLayer::kMap),
                    cells = square(1, {0, 1, 0, 1}, GroundLayer::kCells),
                    alone = square(1, {0, 1, 0, 1}, GroundLayer::kNone);
  for (const Camera& each : {Ahead(), from_above, plan}) {
    SCOPED_TRACE(each.position.z());
    camera = each;
    const int of_scan = pixels_of({scan}, 0), of_cells = pixels_of({cells}, 1);
    ASSERT_GT(of_scan, 100);
    ASSERT_GT(of_cells, 100);
    EXPECT_NEAR(pixels_of({map, scan}, 0), of_scan, 0.03 * of_scan);
    EXPECT_EQ(pixels_of({cells, map}, 1), of_cells) << "whatever their order";
    EXPECT_EQ(pixels_of({map, alone}, 1), pixels_of({alone}, 1)) << "a marker, too";
    if (each.position.z() < 2) continue;  // that does not see what is below
    SceneMarker below = square(1, {0, 1, 0, 0.9}, GroundLayer::kNone);
    below.pose.position.z() = -1;
    EXPECT_GT(pixels_of({below}, 1), 100);
    EXPECT_EQ(pixels_of({map, below}, 1), 0) << "though it is drawn after it";
  }
  camera = from_below;
  SceneMarker upstairs = square(1, {0, 1, 0, 1}, GroundLayer::kMap);
  upstairs.pose.position.z() = 2;
  EXPECT_GT(pixels_of({upstairs}, 1), 100);
  EXPECT_EQ(pixels_of({map, upstairs}, 1), 0) << "seen from below";
}

TEST_F(MarkerDrawing, WritesTextsThatCanBeReadOnAnyBackground) {
  SceneMarker text = Sample(MarkerType::kText);
  const auto darkest_and_brightest = [&](double lightness, Theme theme) {
    text.color = {lightness, lightness, lightness, 1};
    spec_.look.theme = theme;
    const Image empty = Draw(Empty()), image = Draw(With({text}));
    int least = 255, most = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      if (std::equal(&image.rgba[i], &image.rgba[i] + 4, &empty.rgba[i])) continue;
      least = std::min<int>(least, image.rgba[i]);
      most = std::max<int>(most, image.rgba[i]);
    }
    return std::pair(least, most);
  };
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    spec_.look.theme = theme;
    const double behind = BackgroundOf(spec_.look)[0];
    for (const double lightness : {0.0, 1.0, behind > 0.5 ? behind - 0.27 : behind + 0.27}) {
      const auto [least, most] = darkest_and_brightest(lightness, theme);
      EXPECT_GT(most - least, 100) << lightness;
    }
  }
}

TEST_F(MarkerDrawing, KeepsTextsWithoutOverlaysIfTold) {
  const SceneMarker text = Sample(MarkerType::kText);
  spec_.overlays = false;
  EXPECT_EQ(Compare(Draw(Empty()), Draw(With({text}))).pixels, 0);
  spec_.marker_texts = true;
  EXPECT_GT(Compare(Draw(Empty()), Draw(With({text}))).pixels, 20);
}

TEST_F(MarkerDrawing, RejectsTooManyTrianglesByName) {
  SceneMarker flood;
  flood.ns = "flood";
  flood.type = MarkerType::kSphereList;
  flood.points.assign(kMaxMarkerPoints, Eigen::Vector3d::Zero());
  const Image empty = Draw(Empty());
  EXPECT_EQ(Draw(With({flood})).rgba, empty.rgba);
  EXPECT_THAT(renderer_->problems(),
              ::testing::ElementsAre(::testing::HasSubstr("too many triangles")));
  std::vector<SceneMarker> many(11'000);
  for (SceneMarker& marker : many) marker.scale.setZero();
  Draw(With(many));
  EXPECT_THAT(renderer_->problems(), ::testing::SizeIs(21)) << "one fault, not thousands of lines";
}

TEST_F(MarkerDrawing, ShowsABoxForAMissingMeshAndNamesIt) {
  SceneMarker mesh = Sample(MarkerType::kMesh);
  mesh.mesh_uri = "file:///nowhere/cup.stl";
  const Image empty = Draw(Empty());
  EXPECT_GT(Compare(empty, Draw(With({mesh}))).pixels, 100);
  EXPECT_THAT(renderer_->problems(), ::testing::ElementsAre(::testing::HasSubstr("cup.stl")));
}

TEST_F(MarkerDrawing, BlendsTranslucentMarkersWithTheirBackground) {
  SceneMarker cube = Sample(MarkerType::kCube);
  cube.pose.position = {0, 0, 0.8};
  const auto middle = [&](double opacity) {
    cube.color.w() = opacity;
    const Image image = Draw(With({cube}));
    return static_cast<int>(image.rgba[4 * (kViewHeight / 2 * kViewWidth + kViewWidth / 2)]);
  };
  EXPECT_NEAR(middle(0.5), 0.5 * (middle(0) + middle(1)), 2);
  EXPECT_GT(std::abs(middle(0) - middle(1)), 20);
}

}  // namespace
}  // namespace kinescope::render
