#include "urdf/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/shared_data.h"
#include "tests/temp_folder.h"
#include "tests/urdf/mesh_samples.h"

namespace kinescope::urdf {
namespace {

using kinescope::testing::BoxDae;
using kinescope::testing::BoxGlb;
using kinescope::testing::BoxObj;
using kinescope::testing::BoxStl;
using kinescope::testing::DaeOptions;
using kinescope::testing::Glb;
using kinescope::testing::GlbOptions;
using kinescope::testing::TempFolder;
using ::testing::HasSubstr;

std::string Fault(const std::string& bytes, const std::string& extension) {
  try {
    urdf::ReadMesh(bytes, extension, "");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

Eigen::AlignedBox3f BoxOf(const urdf::Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
  return box;
}

double Volume(const urdf::Mesh& mesh) {
  double volume = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) { return mesh.positions[mesh.triangles[i + k]]; };
    volume += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return volume;
}

void ExpectBox(const urdf::Mesh& mesh, const Eigen::Vector3f& least, const Eigen::Vector3f& most) {
  const Eigen::AlignedBox3f box = BoxOf(mesh);
  EXPECT_LT((box.min() - least).norm(), 1e-5) << box.min().transpose();
  EXPECT_LT((box.max() - most).norm(), 1e-5) << box.max().transpose();
  EXPECT_TRUE(mesh.IsClosed());
  EXPECT_NEAR(Volume(mesh), (most - least).prod(), 1e-4) << "inside out?";
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_NEAR(normal.norm(), 1, 1e-4);
}

TEST(MeshFile, ReadsStlAndObjFilesUnchanged) {
  ExpectBox(urdf::ReadMesh(BoxStl(), ".stl", ""), {0, 0, 0}, {1, 2, 3});
  ExpectBox(urdf::ReadMesh(BoxObj(), ".obj", ""), {0, 0, 0}, {1, 2, 3});
}

TEST(MeshFile, AppliesTheUnitAndUpAxisOfCollada) {
  DaeOptions options;
  ExpectBox(urdf::ReadMesh(BoxDae(options), ".dae", ""), {0, 0, 0}, {1, 2, 3});
  options.unit = "0.01";
  ExpectBox(urdf::ReadMesh(BoxDae(options), ".dae", ""), {0, 0, 0}, {0.01f, 0.02f, 0.03f});
  options.unit = "1";
  options.up = "Y_UP";  // y becomes z, z comes towards us
  ExpectBox(urdf::ReadMesh(BoxDae(options), ".dae", ""), {0, -3, 0}, {1, 0, 2});
  options.up = "X_UP";
  ExpectBox(urdf::ReadMesh(BoxDae(options), ".dae", ""), {-2, -3, 0}, {0, 0, 1});
}

TEST(MeshFile, IgnoresOnlyTheUpAxisOfColladaOnRequest) {
  DaeOptions options;
  options.unit = "0.01";
  options.nodes =
      "<node id='n'><translate>0 0 1</translate><rotate>0 0 1 90</rotate>"
      "<instance_geometry url='#g'/></node>";
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    SCOPED_TRACE(up);
    options.up = up;
    ExpectBox(urdf::ReadMesh(BoxDae(options), ".dae", "", urdf::ColladaUp::kIgnored),
              {-0.02f, 0, 0.01f}, {0, 0.01f, 0.04f});
  }
}

TEST(MeshFile, ReadsGlbFilesWithYUp) {
  ExpectBox(ReadMesh(BoxGlb(), ".glb", ""), {0, -3, 0}, {1, 0, 2});
}

TEST(MeshFile, ReadsColoursFromFilesThatContainThem) {
  EXPECT_TRUE(urdf::ReadMesh(BoxStl(), ".stl", "").colors.empty());
  EXPECT_TRUE(urdf::ReadMesh(BoxObj(), ".obj", "").colors.empty());
  const urdf::Mesh dae = urdf::ReadMesh(BoxDae(), ".dae", "");
  ASSERT_EQ(dae.colors.size(), dae.positions.size());
  EXPECT_LT((dae.colors[0] - Eigen::Vector4f(0.8f, 0.1f, 0.2f, 1)).norm(), 1e-5);
  const urdf::Mesh glb = urdf::ReadMesh(BoxGlb(), ".glb", "");
  ASSERT_EQ(glb.colors.size(), glb.positions.size());
  EXPECT_NEAR(glb.colors[0].x(), 0.7354, 1e-3) << "linear 0.5 as sRGB";

  const TempFolder folder;
  std::ofstream(folder / "box.mtl") << "newmtl paint\nKd 0.25 0.5 0.75\n";
  std::ofstream(folder / "box.obj") << BoxObj("mtllib box.mtl\n");
  const urdf::Mesh obj = urdf::ReadMeshFile((folder / "box.obj").string());
  ASSERT_EQ(obj.colors.size(), obj.positions.size());
  EXPECT_LT((obj.colors[0] - Eigen::Vector4f(0.25f, 0.5f, 0.75f, 1)).norm(), 1e-5);
}

// Some exporters write all of a colour as light that the surface gives off, and black as diffuse.
TEST(MeshFile, AddsTheEmissiveColourOfASurfaceToItsColour) {
  std::string dae = BoxDae();
  const std::string tag = "<lambert>";
  dae.insert(dae.find(tag) + tag.size(), "<emission><color>0.1 0.5 0.9 1</color></emission>");
  const urdf::Mesh mesh = urdf::ReadMesh(dae, ".dae", "");
  ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  EXPECT_LT((mesh.colors[0] - Eigen::Vector4f(0.9f, 0.6f, 1, 1)).norm(), 1e-5)
      << mesh.colors[0].transpose();
}

TEST(MeshFile, ReadsNoFilesOutsideTheFolderOfTheMesh) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "in");
  std::ofstream(folder / "secret.mtl") << "newmtl paint\nKd 0.25 0.5 0.75\n";
  for (const char* library : {"../secret.mtl", "/dev/zero", "/etc/passwd"}) {
    std::ofstream(folder / "in" / "box.obj") << BoxObj("mtllib " + std::string(library) + "\n");
    const urdf::Mesh mesh = urdf::ReadMeshFile((folder / "in").string() + "/box.obj");
    EXPECT_TRUE(mesh.colors.empty() || mesh.colors[0].head<3>().y() != 0.5f) << library;
  }
}

TEST(MeshFile, KeepsSurfacesOfMirroredNodesFacingOutward) {
  DaeOptions options;
  const auto with = [&](const std::string& transform) {
    options.nodes = "<node id='n'>" + transform + "<instance_geometry url='#g'/></node>";
    return urdf::ReadMesh(BoxDae(options), ".dae", "");
  };
  ExpectBox(with("<scale>-1 1 1</scale>"), {-1, 0, 0}, {0, 2, 3});
  ExpectBox(with("<scale>2 0.5 -1</scale><translate>0 0 1</translate>"), {0, 0, -4}, {2, 1, -1});
  EXPECT_THROW(with("<scale>0 1 1</scale>"), std::runtime_error);
}

// assimp would leak what it had made so far.
TEST(MeshFile, RejectsTextStlWithoutTrianglesWithItsLine) {
  const std::string facet =
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex +1 0 0\n  vertex 0 1.5e0 0\n "
      "endloop\nendfacet\n";
  EXPECT_EQ(
      urdf::ReadMesh("solid facet\n" + facet + "endsolid vertex\n", ".stl", "").triangles.size(),
      3u);
  EXPECT_EQ(urdf::ReadMesh("solid\n" + facet + facet, ".stl", "").triangles.size(), 6u);
  EXPECT_EQ(urdf::ReadMesh("solid a\n" + facet + "endsolid a\nsolid b\n" + facet, ".stl", "")
                .triangles.size(),
            6u);
  const auto without = [&](const std::string& what) {
    std::string text = facet;
    return text.replace(text.find(what), what.size(), "");
  };
  EXPECT_THAT(Fault("solid a\n", ".stl"), HasSubstr("line 2: a solid has no facets"));
  EXPECT_THAT(Fault("solid a\nendsolid\n" + facet, ".stl"), HasSubstr("line 2"));
  EXPECT_THAT(Fault("solid a\n" + without("vertex 0 0 0"), ".stl"),
              HasSubstr("fewer than three vertices"));
  EXPECT_THAT(Fault("solid a\n" + facet + "vertex 1 1 1\n", ".stl"),
              HasSubstr("line 9: a facet has more than three vertices"));
  EXPECT_THAT(Fault("solid a\n" + without("normal"), ".stl"), HasSubstr("line 2"));
  EXPECT_THAT(Fault("solid a\n" + without("+1"), ".stl"), HasSubstr("a vertex does not have"));
  EXPECT_THAT(Fault("solid a\n" + facet + std::string(90, '\0'), ".stl"), HasSubstr("zero bytes"));
  for (const std::string word : {"nan", "1e999", "one", "0x1", "1,5", "", "\n0"}) {
    EXPECT_THAT(Fault("solid a\nfacet normal 0 0 " + word, ".stl"), HasSubstr("three numbers"));
  }
  // Wherever it stops, it is refused or whole.
  const std::string whole = "solid a\n" + facet + "endsolid a\n";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      EXPECT_EQ(urdf::ReadMesh(whole.substr(0, size), ".stl", "").triangles.size(), 3u) << size;
    } catch (const std::runtime_error& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

TEST(MeshFile, RejectsCountsLargerThanTheFileWithBothNumbers) {
  EXPECT_THAT(Fault(BoxStl(4'000'000'000u), ".stl"), HasSubstr("4000000000 triangles"));
  EXPECT_THAT(Fault(BoxStl(13), ".stl"), HasSubstr("13 triangles (734 bytes), but has 684"));
  EXPECT_THAT(Fault(std::string(40, '\0'), ".stl"), HasSubstr("40 bytes"));
  DaeOptions dae;
  for (const char* count : {"4000000000", "99999999999999999999", "-5", "24x"}) {
    dae.count = count;
    EXPECT_THAT(Fault(BoxDae(dae), ".dae"), HasSubstr("<float_array> declares a count of"));
  }
  GlbOptions glb;
  glb.position_count = "4000000000";
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("count of 4000000000"));
  glb.position_count = "9";
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("count of 9"));
  glb.position_count = "-1";
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("not a whole number"));
  glb = GlbOptions();
  glb.buffer_bytes = "1000000000";
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("1000000000 bytes"));
}

TEST(MeshFile, RejectsOrReadsEveryTruncation) {
  for (const auto& [bytes, extension] :
       {std::pair(BoxStl(), ".stl"), std::pair(BoxDae(), ".dae"), std::pair(BoxGlb(), ".glb"),
        std::pair(BoxObj(), ".obj")}) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string fault = Fault(bytes.substr(0, size), extension);
      EXPECT_FALSE(fault.empty());
      if (extension == std::string(".glb")) {
        EXPECT_NE(fault, "accepted") << size;
      }
    }
  }
}

TEST(MeshFile, RejectsCyclicDeepAndExpandingNodes) {
  DaeOptions dae;
  dae.nodes = "<node id='a'><instance_geometry url='#g'/><instance_node url='#a'/></node>";
  EXPECT_THAT(Fault(BoxDae(dae), ".dae"), HasSubstr("contains itself"));
  dae.nodes = "";
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<instance_node url='#n" + std::to_string(i + 1) + "'/>";
    dae.nodes += "<node id='n" + std::to_string(i) + "'>" + next + next + "</node>";
  }
  dae.nodes += "<node id='n40'><instance_geometry url='#g'/></node>";
  EXPECT_THAT(Fault(BoxDae(dae), ".dae"), HasSubstr("expands"));
  dae.nodes.clear();
  for (int i = 0; i < 100'000; ++i) dae.nodes += "<node>";
  EXPECT_THAT(Fault(BoxDae(dae), ".dae"), HasSubstr("deep"));
  GlbOptions glb;
  glb.nodes = R"([{"mesh":0,"children":[1]},{"children":[0]}])";
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("contains itself"));
  glb.nodes = R"([{"mesh":7}])";
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("meshes that does not exist"));
  glb = GlbOptions();
  glb.more = ",\"extras\":" + std::string(200'000, '[');
  EXPECT_THAT(Fault(BoxGlb(glb), ".glb"), HasSubstr("nested too deeply"));
}

TEST(MeshFile, RejectsAnInvalidIndex) {  // assimp would look at it for ever
  std::string dae = BoxDae();
  dae.insert(dae.find("<p>") + 10, "~");
  EXPECT_THAT(Fault(dae, ".dae"), HasSubstr("<p> contains a value that is not an index"));
}

TEST(MeshFile, RejectsEntitiesExternalFilesAndUnsupportedFormats) {
  std::string dae = BoxDae();
  dae.insert(dae.find("<COLLADA"), "<!DOCTYPE COLLADA [<!ENTITY a 'b'>]>");
  EXPECT_THAT(Fault(dae, ".dae"), HasSubstr("DOCTYPE"));
  EXPECT_THAT(Fault(Glb(R"("asset":{"version":"2.0"},"buffers":[{"uri":"/etc/passwd",)"
                        R"("byteLength":4}])",
                        "1234"),
                    ".glb"),
              HasSubstr("other files"));
  EXPECT_THAT(Fault("x", ".blend"), HasSubstr("unsupported mesh format '.blend'"));
}

TEST(MeshFile, RejectsMeshesThatCannotBeRendered) {
  EXPECT_THAT(Fault("", ".stl"), HasSubstr("empty"));
  std::string nan = BoxStl();
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data() + 84 + 12, &not_a_number, sizeof not_a_number);
  EXPECT_THAT(Fault(nan, ".stl"), HasSubstr("not finite"));
  EXPECT_NE(Fault("v 0 0 0\nv 1 0 0\nv 0 1 0\n", ".obj"), "accepted") << "no faces";
  EXPECT_NE(Fault("v 0 0 0\nf 1 2 99999\n", ".obj"), "accepted");
  std::string polygon = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 200'000; ++i) polygon += " " + std::to_string(i % 3 + 1);
  EXPECT_THAT(Fault(polygon + "\n", ".obj"), HasSubstr("200000 corners"));
  std::string point = std::string(80, '\0');
  kinescope::testing::AppendBytes(point, std::uint32_t{400'000});
  point.resize(84 + 50 * 400'000);
  EXPECT_THAT(Fault(point, ".stl"), HasSubstr("at one point"));
  std::string many = std::string(80, '\0');
  kinescope::testing::AppendBytes(many, std::uint32_t{600'000});
  many.resize(84 + 50 * 600'000);
  EXPECT_THAT(Fault(many, ".stl"), HasSubstr("more than 500000 triangles"));
}

TEST(MeshFile, NamesMissingAndIrregularFiles) {
  const auto fault = [](const std::string& path) -> std::string {
    try {
      urdf::ReadMeshFile(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  const TempFolder folder;
  std::filesystem::create_directories(folder / "folder.stl");
  EXPECT_THAT(fault("/no/such/a.stl"), HasSubstr("/no/such/a.stl: No such file"));
  EXPECT_THAT(fault((folder / "folder.stl").string()), HasSubstr("not a regular file"));
  EXPECT_THAT(fault("/dev/zero"), HasSubstr("not a regular file"));
}

TEST(MeshFile, ReadsThePublishedMeshesOfOtherProjects) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-model-generator/meshes/Head.stl");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           kinescope::testing::SharedData("models/human-model-generator/meshes"))) {
    const urdf::Mesh mesh = urdf::ReadMeshFile(entry.path().string());
    EXPECT_GT(mesh.triangles.size(), 3 * 80u) << entry.path();
    EXPECT_LT(BoxOf(mesh).diagonal().norm(), 1.0) << entry.path();
    EXPECT_GT(Volume(mesh), 0) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 25);
}

}  // namespace
}  // namespace kinescope::urdf
