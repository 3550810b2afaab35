#include "core/person_links.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/worn.h"

namespace kinescope {
namespace {

PersonState Person() {
  auto model = std::make_shared<PersonModel>();
  model->human.skeleton = urdf::DefaultSkeleton();
  model->human.body = urdf::MakeBodyParameters({}, model->human.skeleton);
  PersonState person;
  person.model = model;
  person.links = urdf::ForwardKinematics(model->human.skeleton, {}, {});
  return person;
}

TEST(PersonLinks, AreTheSegmentsOfAPersonWithoutGlovesAndProps) {
  const PersonState person = Person();
  const auto names = VisibleLinks(person.model->human);
  ASSERT_EQ(names.size(), static_cast<std::size_t>(urdf::kSegmentCount));
  EXPECT_EQ(names[urdf::kHead], "skeleton_head");
  EXPECT_EQ(VisibleLinkPoses(person).size(), names.size());
}

TEST(PersonLinks, HaveNamesAndPosesInTheSameOrder) {
  PersonState person = Person();
  testing::Wear(person);
  const auto names = VisibleLinks(person.model->human);
  const auto poses = VisibleLinkPoses(person);
  ASSERT_EQ(names.size(), 23u + 20 + 20 + 2);
  ASSERT_EQ(poses.size(), names.size());
  const auto at = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) ADD_FAILURE() << name << " is missing";
    return poses[static_cast<std::size_t>(found - names.begin())].position;
  };
  EXPECT_EQ(at("skeleton_right_toe"), person.links[urdf::kRightToe].position);
  EXPECT_EQ(at("skeleton_right_carpus"), person.gloves[urdf::kRight]->links[0].position);
  EXPECT_EQ(at("skeleton_left_fifth_dp"), person.gloves[urdf::kLeft]->links[19].position);
  EXPECT_EQ(at("skeleton_prop3"), person.props[2]->pose.position);
}

// What is drawn of a link without a pose would be nowhere, and a hand beside its glove there twice.
TEST(PersonLinks, AreTheLinksWithVisualsAndTheGlovedHands) {
  PersonState person = Person();
  testing::Wear(person);
  std::set<std::string> with_visuals;
  for (const urdf::Link& link : person.model->robot.links) {
    if (!link.visuals.empty()) with_visuals.insert(link.name);
  }
  const auto names = VisibleLinks(person.model->human);
  std::set<std::string> expected(names.begin(), names.end());
  expected.erase("skeleton_right_hand");
  expected.erase("skeleton_left_hand");
  EXPECT_EQ(with_visuals, expected);
}

}  // namespace
}  // namespace kinescope
