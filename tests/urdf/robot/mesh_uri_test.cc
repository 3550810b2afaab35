#include "urdf/robot/mesh_uri.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/temp_folder.h"

namespace kinescope::urdf {
namespace {

namespace fs = std::filesystem;
using kinescope::testing::TempFolder;

class MeshUri : public ::testing::Test {
 protected:
  MeshUri() { ::unsetenv("ROS_PACKAGE_PATH"); }
  ~MeshUri() override { ::unsetenv("ROS_PACKAGE_PATH"); }

  fs::path Write(const std::string& name, const std::string& text = "x") {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path;
  }
  static fs::path Found(const std::string& uri, const MeshSearch& search) {
    const auto found = FindMesh(uri, search);
    const auto* missing = std::get_if<MeshNotFound>(&found);
    EXPECT_EQ(missing, nullptr) << missing->reason;
    return missing == nullptr ? std::get<fs::path>(found) : fs::path();
  }
  static std::string Reason(const std::string& uri, const MeshSearch& search) {
    const auto found = FindMesh(uri, search);
    const auto* missing = std::get_if<MeshNotFound>(&found);
    return missing == nullptr ? "found" : missing->reason;
  }

  TempFolder folder_;
};

TEST_F(MeshUri, ResolvesRelativeNamesFromTheFolderOfTheUrdf) {
  const fs::path mesh = Write("robot/meshes/a b.stl");
  const MeshSearch search = MakeMeshSearch(folder_ / "robot/urdf/r.urdf", {});
  EXPECT_TRUE(fs::equivalent(
      Found("../meshes/a b.stl", MakeMeshSearch(Write("robot/urdf/r.urdf"), {})), mesh));
  EXPECT_TRUE(fs::equivalent(
      Found("file://" + (folder_ / "robot/meshes/a%20b.stl").string(), search), mesh));
  EXPECT_TRUE(fs::equivalent(Found(mesh.string(), MeshSearch()), mesh));
}

TEST_F(MeshUri, FindsPackagesOnThePackagePathInItsOrder) {
  const fs::path first = Write("one/arm/meshes/a.stl"), second = Write("two/arm/meshes/a.stl");
  const std::string uri = "package://arm/meshes/a.stl";
  const fs::path urdf = Write("elsewhere/r.urdf");
  ::setenv("ROS_PACKAGE_PATH", ("/no/such:" + (folder_ / "two").string()).c_str(), 1);
  EXPECT_EQ(Found(uri, MakeMeshSearch(urdf, {})), second);
  EXPECT_EQ(Found(uri, MakeMeshSearch(urdf, {(folder_ / "one").string()})), first);
}

TEST_F(MeshUri, FindsNestedPackagesByTheNameInTheirManifest) {
  const fs::path mesh = Write("src/group/repo/folder/meshes/a.stl");
  Write("src/group/repo/folder/package.xml", "<package>\n <name> arm </name></package>");
  const fs::path urdf = Write("elsewhere/r.urdf");
  const std::string uri = "package://arm/meshes/a.stl";
  EXPECT_EQ(Found(uri, MakeMeshSearch(urdf, {(folder_ / "src").string()})), mesh);
  EXPECT_EQ(Found(uri, MakeMeshSearch(urdf, {(folder_ / "src/group/repo/folder").string()})), mesh);
  Write("src/group/repo/CATKIN_IGNORE");
  EXPECT_NE(Reason(uri, MakeMeshSearch(urdf, {(folder_ / "src").string()})), "found");
}

TEST_F(MeshUri, FindsThePackageThatContainsTheUrdf) {
  const fs::path mesh = Write("checkout/meshes/a.stl");
  Write("checkout/package.xml", "<package><name>arm</name></package>");
  const fs::path neighbour = Write("hand/meshes/h.stl");
  Write("hand/package.xml", "<package><name>hand</name></package>");
  const MeshSearch search = MakeMeshSearch(Write("checkout/urdf/deep/r.urdf"), {});
  EXPECT_EQ(Found("package://arm/meshes/a.stl", search), mesh);
  EXPECT_EQ(Found("package://hand/meshes/h.stl", search), neighbour);
}

TEST_F(MeshUri, ReportsMissingFilesWithTheSearchedPlacesAndARemedy) {
  const MeshSearch search = MakeMeshSearch(Write("r.urdf"), {(folder_ / "packages").string()});
  const std::string package = Reason("package://arm/a.stl", search);
  EXPECT_NE(package.find("'arm'"), std::string::npos) << package;
  EXPECT_NE(package.find((folder_ / "packages").string()), std::string::npos) << package;
  EXPECT_NE(package.find("ROS_PACKAGE_PATH"), std::string::npos) << package;
  EXPECT_NE(Reason("meshes/none.stl", search).find("No such file"), std::string::npos);
  for (const std::string& uri :
       {std::string(), std::string("package://"), std::string("package://arm"),
        std::string("package://../a"), std::string("file://relative.stl"),
        std::string("http://host/a.stl"), std::string("model://arm/a.stl"), std::string("a\0b", 3),
        std::string("/dev/zero"), std::string("."), std::string(100'000, 'a')}) {
    EXPECT_NE(Reason(uri, search), "found") << uri.substr(0, 40);
  }
  EXPECT_NE(Reason("a.stl", MeshSearch()).find("relative"), std::string::npos);
}

}  // namespace
}  // namespace kinescope::urdf
