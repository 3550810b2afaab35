#include "render/label_layout.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace kinescope::render {
namespace {

constexpr double kFieldWidth = 640, kFieldHeight = 360;

bool Overlap(const LabelBox& a, const LabelPlace& at, const LabelBox& b, const LabelPlace& bt) {
  return at.left < bt.left + b.width && bt.left < at.left + a.width && at.top < bt.top + b.height &&
         bt.top < at.top + a.height;
}

TEST(LabelLayout, LeavesASingleLabelInPlace) {
  const auto places = PlaceLabels({{100, 50, 40, 20}}, kFieldWidth, kFieldHeight);
  ASSERT_TRUE(places[0]);
  EXPECT_EQ(places[0]->left, 80);
  EXPECT_EQ(places[0]->top, 40);
  EXPECT_FALSE(places[0]->is_moved);
}

TEST(LabelLayout, KeepsLabelsSeparateAndInsideThePicture) {
  std::mt19937 random(6);  // the same on every run
  std::uniform_real_distribution<double> x(0, kFieldWidth), y(0, kFieldHeight), width(20, 120);
  std::vector<LabelBox> boxes;
  for (int i = 0; i < 60; ++i) boxes.push_back({x(random), y(random), width(random), 20});
  for (int i = 0; i < 10; ++i) boxes.push_back({320, 180, 60, 20});  // all in one place
  const auto places = PlaceLabels(boxes, kFieldWidth, kFieldHeight);
  int shown = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!places[i]) continue;
    ++shown;
    EXPECT_GE(places[i]->left, 0);
    EXPECT_LE(places[i]->left + boxes[i].width, kFieldWidth);
    EXPECT_GE(places[i]->top, 0);
    EXPECT_LE(places[i]->top + boxes[i].height, kFieldHeight);
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(places[k] && Overlap(boxes[i], *places[i], boxes[k], *places[k]));
    }
  }
  EXPECT_GE(shown, 60) << "of 70, a third of the picture: there is room for nearly all";
}

TEST(LabelLayout, PlacesFixedLabelsAtTheirPlaceOrNotAtAll) {
  const std::vector<LabelBox> boxes = {
      {100, 100, 40, 20}, {110, 105, 40, 20, false}, {200, 100, 40, 20, false}};
  const auto places = PlaceLabels(boxes, kFieldWidth, kFieldHeight);
  EXPECT_TRUE(places[0]);
  EXPECT_FALSE(places[1]);
  ASSERT_TRUE(places[2]);
  EXPECT_EQ(places[2]->left, 180);
}

TEST(LabelLayout, OmitsLabelsOutsideThePictureAndNonFiniteOnes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto places =
      PlaceLabels({{-1, 50, 40, 20}, {100, 400, 40, 20}, {nan, 50, 40, 20}, {1, 1, 40, 20}},
                  kFieldWidth, kFieldHeight);
  EXPECT_FALSE(places[0]);
  EXPECT_FALSE(places[1]);
  EXPECT_FALSE(places[2]);
  ASSERT_TRUE(places[3]) << "at the border, so moved inside";
  EXPECT_EQ(places[3]->left, 0);
}

TEST(LabelLayout, AcceptsAnyNumberOfLabels) {
  const std::vector<LabelBox> boxes(20'000, LabelBox{320, 180, 60, 20});
  const auto places = PlaceLabels(boxes, kFieldWidth, kFieldHeight);
  ASSERT_EQ(places.size(), boxes.size());
  EXPECT_FALSE(places.back());
}

}  // namespace
}  // namespace kinescope::render
