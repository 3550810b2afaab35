#include "server/body/body_meshes.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "urdf/body_surface.h"
#include "urdf/robot/robot_model.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

urdf::HumanModel Person(double height) {
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton(height);
  return human;
}

std::set<std::string> NamesOf(const std::vector<MeshFile>& files) {
  std::set<std::string> names;
  for (const MeshFile& file : files) names.insert(file.name);
  return names;
}

TEST(BodyMeshFiles, ContainEverySegment) {
  const std::vector<MeshFile> files = BodyMeshFiles(Person(1.75), nullptr);
  ASSERT_EQ(files.size(), std::size_t{urdf::kSegmentCount});
  for (const MeshFile& file : files) EXPECT_GT(file.stl.size(), 1000u) << file.name;
}

TEST(BodyMeshFiles, ContainFingersInsteadOfAGlovedHand) {
  urdf::HumanModel human = Person(1.75);
  human.gloves[urdf::kRight] = urdf::DefaultHand(urdf::kRight, 0.19);
  const std::set<std::string> names = NamesOf(BodyMeshFiles(human, nullptr));
  EXPECT_EQ(names.count("right_hand.stl"), 0u);
  EXPECT_EQ(names.count("left_hand.stl"), 1u);
  // The URDF names exactly these.
  human.body = urdf::MakeBodyParameters({}, human.skeleton);
  human.mesh_folder = "/meshes";
  std::set<std::string> named;
  for (const urdf::Link& link : urdf::ParseUrdf(urdf::WriteUrdf(human)).links) {
    for (const urdf::Visual& visual : link.visuals) {
      named.insert(visual.geometry.mesh_uri.substr(std::string("file:///meshes/").size()));
    }
  }
  EXPECT_EQ(names, named);
}

TEST(MeshSetName, DependsOnBodyAndAppearance) {
  const BodyAppearance smooth;
  BodyAppearance with_tool;
  const auto tools = std::make_shared<HandTools>();
  (*tools)[urdf::kRight] = HandTool{urdf::SegmentMesh(urdf::DefaultSkeleton(), urdf::kHead), {}};
  with_tool.tools = tools;
  BodyAppearance custom;
  const auto head = std::make_shared<CustomBodyMeshes>();
  head->meshes[urdf::kHead] = urdf::SegmentMesh(urdf::DefaultSkeleton(), urdf::kPelvis);
  custom.custom = head;
  urdf::HumanModel gloved = Person(1.6);
  gloved.gloves[urdf::kLeft] = urdf::DefaultHand(urdf::kLeft, 0.19);
  urdf::HumanModel other_toe = Person(1.6);
  other_toe.skeleton.toe_tip_in_toe[urdf::kLeft].x() += 1e-9;

  const std::string name = MeshSetName(HashOf(smooth), Person(1.6));
  EXPECT_EQ(name, MeshSetName(HashOf(BodyAppearance()), Person(1.6)));
  const std::set<std::string> all = {name,
                                     MeshSetName(HashOf(smooth), Person(1.9)),
                                     MeshSetName(HashOf(smooth), gloved),
                                     MeshSetName(HashOf(smooth), other_toe),
                                     MeshSetName(HashOf(with_tool), Person(1.6)),
                                     MeshSetName(HashOf(custom), Person(1.6))};
  EXPECT_EQ(all.size(), 6u) << "two bodies share a folder";
}

}  // namespace
}  // namespace kinescope::app
