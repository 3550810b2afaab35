// What cannot be drawn is left out by name, and nothing else is.
#include "render/finite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/render/test_scene.h"
#include "tests/worn.h"

namespace kinescope::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kNotFinite[] = {std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(), 1e6, -1e7};

SceneState TwoStanding() {
  SceneState scene = testing::SceneWith(testing::Posture::kStanding);
  scene.people.push_back(scene.people[0]);
  scene.people[1].character = 7;
  scene.people[1].name = "Anna";
  TrackedObject box;
  box.name = "box";
  scene.objects.push_back(box);
  return scene;
}

struct Drawable {
  std::optional<SceneState> scene;
  std::vector<std::string> problems;
};

Drawable DrawableOf(const SceneState& scene) {
  Drawable drawable;
  drawable.scene = WithoutNonFinite(scene, drawable.problems);
  return drawable;
}

TEST(WithoutNonFinite, CopiesNothingIfEverythingIsFinite) {
  SceneState scene = TwoStanding();
  scene.people[0].com.reset();  // what is not known is nothing to complain about
  scene.people[1].cop.reset();
  const Drawable drawable = DrawableOf(scene);
  EXPECT_FALSE(drawable.scene);
  EXPECT_THAT(drawable.problems, IsEmpty());
}

TEST(WithoutNonFinite, RemovesAPersonWithANonFiniteLink) {
  for (const double value : kNotFinite) {
    SceneState scene = TwoStanding();
    scene.people[1].links[urdf::kLeftToe].position.y() = value;
    const Drawable drawable = DrawableOf(scene);
    ASSERT_TRUE(drawable.scene) << value;
    ASSERT_THAT(drawable.scene->people, SizeIs(1)) << value;
    EXPECT_EQ(drawable.scene->people[0].character, 0);
    EXPECT_THAT(drawable.problems,
                ElementsAre("person 7 ('Anna') is not drawn: a pose is not finite"));
  }
}

TEST(WithoutNonFinite, ChecksOrientationsGlovesAndPropsToo) {
  const double nan = kNotFinite[0];
  SceneState turned = TwoStanding();
  turned.people[0].links[urdf::kHead].orientation.w() = nan;
  EXPECT_THAT(DrawableOf(turned).problems,
              ElementsAre("person 0 is not drawn: a pose is not finite"));
  SceneState gloved = TwoStanding();
  testing::Wear(gloved.people[0]);
  EXPECT_FALSE(DrawableOf(gloved).scene);
  SceneState finger = gloved;
  finger.people[0].gloves[urdf::kLeft]->links[3].position.x() = nan;
  EXPECT_THAT(DrawableOf(finger).problems, SizeIs(1));
  SceneState prop = gloved;
  prop.people[0].props[2]->pose.position.z() = nan;
  EXPECT_THAT(DrawableOf(prop).problems, SizeIs(1));
}

TEST(WithoutNonFinite, RemovesOnlyNonFiniteMarksOfAPerson) {
  const double nan = kNotFinite[0];
  SceneState scene = TwoStanding();
  scene.people[0].loads[2].position.x() = nan;
  scene.people[0].loads[4].position.z() = nan;
  scene.people[0].com->y() = nan;
  scene.people[0].cop->x() = nan;
  const Drawable drawable = DrawableOf(scene);
  ASSERT_TRUE(drawable.scene);
  ASSERT_THAT(drawable.scene->people, SizeIs(2));
  const PersonState& person = drawable.scene->people[0];
  EXPECT_THAT(person.loads, SizeIs(scene.people[0].loads.size() - 2));
  EXPECT_EQ(person.loads[2].joint, scene.people[0].loads[3].joint) << "the others in their order";
  EXPECT_FALSE(person.com);
  EXPECT_FALSE(person.cop);
  EXPECT_TRUE(drawable.scene->people[1].com);
  EXPECT_THAT(drawable.problems,
              ElementsAre(HasSubstr("person 0: 2 load spheres"), HasSubstr("the centre of mass"),
                          HasSubstr("the centre of pressure")));
}

TEST(WithoutNonFinite, RemovesANonFiniteObjectAndNamesIt) {
  SceneState scene = TwoStanding();
  scene.objects.push_back(scene.objects[0]);
  scene.objects[0].name = "crate";
  scene.objects[0].pose.position.x() = kNotFinite[1];
  const Drawable drawable = DrawableOf(scene);
  ASSERT_TRUE(drawable.scene);
  ASSERT_THAT(drawable.scene->objects, SizeIs(1));
  EXPECT_EQ(drawable.scene->objects[0].name, "box");
  EXPECT_THAT(drawable.scene->people, SizeIs(2));
  EXPECT_THAT(drawable.problems,
              ElementsAre("object 'crate' is not drawn: its pose is not finite"));
}

}  // namespace
}  // namespace kinescope::render
