#include "server/app/urdf/person_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"
#include "urdf/body_surface.h"
#include "urdf/robot/robot_model.h"

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

PersonFiles Meshes() { return {BodyMeshFiles(Person(), nullptr), {}}; }

std::vector<std::string> MeshUris(const fs::path& urdf_file) {
  std::vector<std::string> uris;
  for (const urdf::Link& link : urdf::ParseUrdf(ReadFile(urdf_file)).links) {
    for (const urdf::Visual& visual : link.visuals) uris.push_back(visual.geometry.mesh_uri);
  }
  return uris;
}

TEST(PersonExport, WritesAUrdfWithItsMeshes) {
  const testing::TempFolder folder;
  const fs::path out = folder / "a person & co";
  ExportPerson(Person(), Meshes(), out, "");
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

TEST(PersonExport, NamesMeshesByPackageIfOneIsGiven) {
  const testing::TempFolder folder;
  ExportPerson(Person(), Meshes(), folder.path(), "anna_description");
  EXPECT_THAT(MeshUris(folder / "person.urdf"),
              ::testing::Contains("package://anna_description/meshes/pelvis.stl"));
  for (const char* bad : {"no such", "../up", "2go", "a/b", "\"/>"}) {
    EXPECT_THROW(ExportPerson(Person(), Meshes(), folder.path(), bad), UsageError) << bad;
  }
}

TEST(PersonExport, ReplacesOldMeshes) {
  const testing::TempFolder folder;
  ExportPerson(Person(), Meshes(), folder / "out", "");
  PersonFiles own = Meshes();
  own.body.back().stl = "the left toe";
  ExportPerson(Person(), own, folder / "out", "");
  EXPECT_EQ(ReadFile(folder / "out" / "meshes" / "left_toe.stl"), "the left toe");
  EXPECT_EQ(MeshUris(folder / "out" / "person.urdf").size(), 23U);
}

TEST(PersonExport, HasNoMeshesForPrimitives) {
  const testing::TempFolder folder;
  urdf::HumanModel human = Person();
  human.mesh_folder = "/of/the/cache";
  ExportPerson(human, {}, folder / "out", "");
  for (const std::string& uri : MeshUris(folder / "out" / "person.urdf")) EXPECT_EQ(uri, "");
  EXPECT_FALSE(fs::exists(folder / "out" / "meshes"));
}

TEST(PersonExport, LeavesNoPartialExportAndNamesTheFailedFile) {
  const testing::TempFolder folder;
  std::ofstream(folder / "file") << "in the way";
  EXPECT_THROW(ExportPerson(Person(), Meshes(), folder / "file", ""), UsageError);
  fs::create_directories(folder / "out" / "meshes" / "pelvis.stl" / "in the way");
  try {
    ExportPerson(Person(), Meshes(), folder / "out", "");
    FAIL() << "a folder was replaced";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("pelvis.stl"));
  }
  EXPECT_FALSE(fs::exists(folder / "out" / "person.urdf"));
}

}  // namespace
}  // namespace kinescope::app
