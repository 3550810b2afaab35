#include "render/overlay_free_area.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "render/multi_view.h"
#include "render/overlay.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

// Where something is painted, px of the view or picture that was entered.
class BoxRecorder : public Painter {
 public:
  struct Painted {
    Tile tile;
    double left, top, right, bottom;
  };

  void Enter(const Tile& part) override { tile_ = part; }
  void RoundedBox(double x, double y, double width, double height, double /*radius*/,
                  const Ink& /*ink*/) override {
    painted.push_back({tile_, x, y, x + width, y + height});
  }
  void Disc(double x, double y, double radius, const Ink& /*ink*/) override {
    painted.push_back({tile_, x - radius, y - radius, x + radius, y + radius});
  }
  void Ring(double x, double y, double /*inner_radius*/, double radius,
            const Ink& /*ink*/) override {
    painted.push_back({tile_, x - radius, y - radius, x + radius, y + radius});
  }
  void Polyline(const std::vector<std::pair<double, double>>& points, double /*width*/,
                const Ink& /*ink*/) override {
    for (const auto& [x, y] : points) painted.push_back({tile_, x, y, x, y});
  }
  double Text(double x, double y, std::string_view utf8, Font& font, int size_px,
              const Ink& /*ink*/) override {
    const double end = x + font.Width(utf8, size_px);
    painted.push_back({tile_, x, y - 0.8 * size_px, end, y});
    return end;
  }

  std::vector<Painted> painted;

 private:
  Tile tile_{};
};

// As shares of the picture.
bool IsCovered(const PictureRect& rect, const FreeArea& area) {
  const double middle_x = 0.5 * (rect.left + rect.right);
  const double middle_y = 0.5 * (rect.top + rect.bottom);
  if (middle_y < area.free.top || middle_y > area.free.bottom) return true;
  for (const PictureRect& corner : area.corners) {
    if (rect.left >= corner.left - 1e-9 && rect.right <= corner.right + 1e-9 &&
        middle_y >= corner.top && middle_y <= corner.bottom && middle_x >= corner.left) {
      return true;
    }
  }
  return false;
}

// Everything that the overlays of `spec` paint over a scene is in what they are said to cover.
void ExpectAllCovered(PictureSpec spec, std::size_t curves) {
  SceneState state = testing::MixedScene(testing::Posture::kStanding);
  state.people[0].forces.feet[0].touches_floor = true;
  state.people[0].forces.feet[0].force = {0, 0, 400};
  if (curves > 0) {
    auto loads = std::make_shared<LoadCurves>();
    loads->to_secs = 1;
    loads->curves.resize(curves);
    for (LoadCurve& curve : loads->curves) curve.points = {{0, 0.2}, {1, 0.4}};
    spec.load_curves = loads;
  }
  Overlay overlay;
  BoxRecorder recorder;
  const Tile whole{0, 0, spec.width, spec.height};
  overlay.Paint(recorder, state, {{whole, Camera(), "", {}}}, spec);
  const std::vector<FreeArea> areas = FreeAreasOf(spec, {whole}, curves);
  ASSERT_FALSE(recorder.painted.empty());
  for (const BoxRecorder::Painted& each : recorder.painted) {
    const PictureRect rect{each.left / spec.width, each.top / spec.height, each.right / spec.width,
                           each.bottom / spec.height};
    EXPECT_TRUE(IsCovered(rect, areas[0])) << each.left << ' ' << each.top << ' ' << each.right
                                           << ' ' << each.bottom << " of " << spec.width;
  }
}

TEST(FreeAreas, CoverWhateverTheOverlaysPaint) {
  PictureSpec spec;
  spec.title = "Lifting";
  for (const auto& [width, height] :
       {std::pair(1280, 720), std::pair(640, 480), std::pair(360, 640), std::pair(3000, 3000)}) {
    spec.width = width;
    spec.height = height;
    spec.parts.frame_code = false;
    ExpectAllCovered(spec, 0);
    spec.parts.frame_code = true;
    ExpectAllCovered(spec, 2);
  }
  spec.print = {80, 7};
  spec.width = 945;
  spec.height = 709;
  ExpectAllCovered(spec, 0);
}

TEST(FreeAreas, AreTheWholePictureWithoutOverlays) {
  PictureSpec spec;
  spec.overlays = false;
  const std::vector<FreeArea> areas = FreeAreasOf(spec, {{0, 0, 1280, 720}}, 2);
  EXPECT_TRUE(areas[0].corners.empty());
  EXPECT_EQ(areas[0].free.top, 0);
  EXPECT_EQ(areas[0].free.bottom, 1);
}

TEST(FreeAreas, OfSeveralViewsHaveTheLegendInOneOfThem) {
  PictureSpec spec;
  const std::vector<FreeArea> areas = FreeAreasOf(spec, PaneTiles(1280, 720, 4, 2), 0);
  ASSERT_EQ(areas.size(), 4u);
  EXPECT_EQ(areas[0].corners.size(), 0u);
  EXPECT_EQ(areas[2].corners.size(), 1u) << "lower left";
  EXPECT_EQ(areas[3].corners.size(), 1u) << "the time code";
  EXPECT_GT(areas[0].free.top, areas[2].free.top) << "the state is in the upper row";
}

}  // namespace
}  // namespace kinescope::render
