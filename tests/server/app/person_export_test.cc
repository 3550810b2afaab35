#include "server/app/person_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/core/errors.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"
#include "urdf/figure.h"
#include "urdf/robot_model.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using testing::ReadFile;

urdf::HumanModel Person() {
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton(1.68);
  human.body = urdf::MakeBodyParameters({}, human.skeleton);
  return human;
}

std::vector<std::string> MeshUris(const fs::path& urdf_file) {
  std::vector<std::string> uris;
  for (const urdf::Link& link : urdf::ParseUrdf(ReadFile(urdf_file)).links) {
    for (const urdf::Visual& visual : link.visuals) uris.push_back(visual.geometry.mesh_uri);
  }
  return uris;
}

TEST(PersonExport, WritesAUrdfWhoseMeshesAreThere) {
  const testing::TempFolder folder;
  const fs::path out = folder / "a person & co";
  ExportPerson(Person(), out, "");
  const auto uris = MeshUris(out / "person.urdf");
  ASSERT_EQ(uris.size(), static_cast<std::size_t>(urdf::kSegmentCount));
  const std::string start = "file://" + fs::canonical(folder.path()).string();
  for (std::size_t i = 0; i < uris.size(); ++i) {
    const std::string file = std::string(urdf::kSegments[i].link_name) + ".stl";
    EXPECT_THAT(uris,
                ::testing::Contains(start + "/a%20person%20%26%20co/meshes/" + file).Times(1));
    EXPECT_EQ(ReadFile(out / "meshes" / file),
              urdf::ToBinaryStl(urdf::SegmentMesh(Person().skeleton, static_cast<int>(i))));
  }
}

TEST(PersonExport, NamesMeshesByPackageWhereOneIsGiven) {
  const testing::TempFolder folder;
  ExportPerson(Person(), folder.path(), "anna_description");
  EXPECT_THAT(MeshUris(folder / "person.urdf"),
              ::testing::Contains("package://anna_description/meshes/pelvis.stl"));
  for (const char* bad : {"no such", "../up", "2go", "a/b", "\"/>"}) {
    EXPECT_THROW(ExportPerson(Person(), folder.path(), bad), UsageError) << bad;
  }
}

TEST(PersonExport, TakesTheMeshesThatThePersonHasAndReplacesOldOnes) {
  const testing::TempFolder folder;
  fs::create_directories(folder / "own");
  urdf::HumanModel human = Person();
  human.mesh_folder = (folder / "own").string();
  for (const urdf::SegmentInfo& segment : urdf::kSegments) {
    std::ofstream(folder / "own" / (std::string(segment.link_name) + ".stl")) << segment.mvn_name;
  }
  ExportPerson(Person(), folder / "out", "");
  ExportPerson(human, folder / "out", "");
  EXPECT_EQ(ReadFile(folder / "out" / "meshes" / "right_toe.stl"), "RightToe");
  EXPECT_EQ(MeshUris(folder / "out" / "person.urdf").size(), 23U);
}

TEST(PersonExport, LeavesNothingHalfWrittenAndSaysWhy) {
  const testing::TempFolder folder;
  std::ofstream(folder / "file") << "in the way";
  EXPECT_THROW(ExportPerson(Person(), folder / "file", ""), UsageError);
  urdf::HumanModel human = Person();
  human.mesh_folder = (folder / "gone").string();
  try {
    ExportPerson(human, folder / "out", "");
    FAIL() << "meshes came from nowhere";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("pelvis.stl"));
  }
  EXPECT_FALSE(fs::exists(folder / "out" / "person.urdf"));
  EXPECT_TRUE(fs::is_empty(folder / "out" / "meshes"));
}

}  // namespace
}  // namespace kinescope::app
