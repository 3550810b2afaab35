#include "urdf/mesh/texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/temp_folder.h"
#include "urdf/mesh/mesh_file.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector2f;
using Eigen::Vector4f;
using kinescope::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Vector4f kRed(1, 0, 0, 1), kGreen(0, 1, 0, 1), kBlue(0, 0, 1, 1), kWhite(1, 1, 1, 1);

// Red and green above blue and white, `side` px each.
Texture FourColors(int side) {
  Texture texture{2 * side, 2 * side, {}};
  for (int y = 0; y < 2 * side; ++y) {
    for (int x = 0; x < 2 * side; ++x) {
      const Vector4f& color = y < side ? (x < side ? kRed : kGreen) : (x < side ? kBlue : kWhite);
      for (int c = 0; c < 4; ++c) {
        texture.rgba.push_back(static_cast<std::uint8_t>(255 * color[c]));
      }
    }
  }
  return texture;
}

// The unit square of the plane z = 0, from which its texture coordinates are taken.
struct Square {
  Mesh mesh;
  std::vector<Vector2f> uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Square() {
    for (const Vector2f& at : uv) {
      mesh.AddVertex({at.x(), at.y(), 0}, Eigen::Vector3f::UnitZ());
    }
    mesh.AddTriangle(0, 1, 2);
    mesh.AddTriangle(0, 2, 3);
  }
};

// Of the vertex that is nearest to a place.
Vector4f ColorAt(const Mesh& mesh, float x, float y) {
  std::size_t nearest = 0;
  const auto distance = [&](std::size_t i) {
    return (mesh.positions[i] - Eigen::Vector3f(x, y, 0)).norm();
  };
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (distance(i) < distance(nearest)) nearest = i;
  }
  return mesh.colors.at(nearest);
}

TEST(Texture, IsSharpOnTwoTrianglesAndTheRightWayUp) {
  Square square;
  PaintTexture(FourColors(128), square.uv, kMostTexturedTriangles, square.mesh);
  const Mesh& mesh = square.mesh;
  EXPECT_LE(mesh.triangles.size() / 3, kMostTexturedTriangles);
  EXPECT_GT(mesh.triangles.size() / 3, kMostTexturedTriangles / 2);
  ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  EXPECT_EQ(ColorAt(mesh, 0.25F, 0.75F), kRed);
  EXPECT_EQ(ColorAt(mesh, 0.75F, 0.75F), kGreen);
  EXPECT_EQ(ColorAt(mesh, 0.25F, 0.25F), kBlue);
  EXPECT_EQ(ColorAt(mesh, 0.47F, 0.75F), kRed) << "1 % of the side is one part";
  EXPECT_EQ(ColorAt(mesh, 0.53F, 0.75F), kGreen);
}

TEST(Texture, RepeatsAndIsNotDividedFinerThanItsPixels) {
  Square square;
  for (Vector2f& at : square.uv) at = 1.5F * at - Vector2f(1, 1);  // from -1 to 0.5
  PaintTexture(FourColors(1), square.uv, kMostTexturedTriangles, square.mesh);
  EXPECT_EQ(square.mesh.triangles.size() / 3, 2U * 5 * 5) << "a diagonal is 4.24 px long";
  EXPECT_EQ(ColorAt(square.mesh, 0.2F, 0.4F), kRed) << "(-0.7, -0.4) is (0.3, 0.6)";
}

// One long triangle among many short ones: these are as sharp as without it.
TEST(Texture, IsAsSharpAsTheTrianglesAtEachPlace) {
  constexpr int kSide = 120;
  Mesh grid;
  std::vector<Vector2f> uv;
  for (int y = 0; y <= kSide; ++y) {
    for (int x = 0; x <= kSide; ++x) {
      uv.emplace_back(static_cast<float>(x) / kSide, static_cast<float>(y) / kSide);
      grid.AddVertex({uv.back().x(), uv.back().y(), 0}, Eigen::Vector3f::UnitZ());
    }
  }
  const auto at = [](int x, int y) { return static_cast<std::uint32_t>(y * (kSide + 1) + x); };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      grid.AddTriangle(at(x, y), at(x + 1, y), at(x + 1, y + 1));
      grid.AddTriangle(at(x, y), at(x + 1, y + 1), at(x, y + 1));
    }
  }
  grid.AddTriangle(at(0, 0), at(kSide, 0), at(kSide, kSide));
  PaintTexture(FourColors(256), uv, kMostTexturedTriangles, grid);
  EXPECT_EQ(grid.triangles.size() / 3, 2U * kSide * kSide + 1) << "too many to be divided";
  EXPECT_EQ(ColorAt(grid, 0.4F, 0.6F), kRed);
  EXPECT_EQ(ColorAt(grid, 0.6F, 0.6F), kGreen);
}

TEST(Texture, LeavesNoGapsInASurfaceThatIsClosed) {
  Mesh box = BoxMesh({1, 1, 1}, {0, 0, 0});
  ASSERT_TRUE(box.IsClosed());
  std::vector<Vector2f> uv;
  for (const Eigen::Vector3f& at : box.positions) uv.emplace_back(3 * at.x(), at.y() + at.z());
  PaintTexture(FourColors(100), uv, kMostTexturedTriangles, box);
  EXPECT_GT(box.triangles.size() / 3, 1000U);
  EXPECT_TRUE(box.IsClosed());
  for (const Eigen::Vector3f& normal : box.normals) EXPECT_NEAR(normal.norm(), 1, 1e-5);
}

TEST(Texture, TakesWhatIsNoNumber) {
  Square square;
  square.uv[0].x() = std::nanf("");
  square.uv[1].y() = std::numeric_limits<float>::infinity();
  square.uv[2].x() = 3e38F;
  PaintTexture(FourColors(3), square.uv, kMostTexturedTriangles, square.mesh);
  EXPECT_EQ(square.mesh.colors.size(), square.mesh.positions.size());
}

class TextureFileTest : public ::testing::Test {
 protected:
  TextureFileTest() {
    std::filesystem::create_directories(folder_ / "lab/meshes");
    std::filesystem::create_directories(folder_ / "lab/textures");
  }

  Mesh Read(const std::string& texture) {
    std::ofstream(folder_ / "lab/meshes/square.mtl")
        << "newmtl wood\nKd 1 1 1\nmap_Kd " << texture << "\n";
    std::ofstream(folder_ / "lab/meshes/square.obj")
        << "mtllib square.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
           "vt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    reading_.problems.clear();
    return ReadMeshFile(folder_ / "lab/meshes/square.obj", ColladaUp::kIgnored, &reading_);
  }

  TempFolder folder_;
  TextureReading reading_{[](const std::uint8_t* bytes, std::size_t size) {
    if (std::string(reinterpret_cast<const char*>(bytes), size) != "four colours") {
      throw std::runtime_error("it is no picture");
    }
    return FourColors(64);
  }};
};

TEST_F(TextureFileTest, IsReadBesideTheMeshOrInAFolderOfItsPackage) {
  std::ofstream(folder_ / "lab/meshes/wood.png") << "four colours";
  std::ofstream(folder_ / "lab/textures/wood.png") << "four colours";
  const std::string whole =
      "file://" + std::filesystem::path(folder_ / "lab/meshes/wood.png").string();
  for (const std::string& name : {std::string("wood.png"), std::string("../textures/wood.png"),
                                  std::string("..\\textures\\wood.png"), whole}) {
    const Mesh mesh = Read(name);
    EXPECT_THAT(reading_.problems, IsEmpty()) << name;
    EXPECT_EQ(ColorAt(mesh, 0.25F, 0.75F), kRed) << name;
    EXPECT_EQ(ColorAt(mesh, 0.75F, 0.25F), kWhite) << name;
  }
  EXPECT_EQ(ReadMeshFile(folder_ / "lab/meshes/square.obj").positions.size(), 4U)
      << "nothing is divided where no textures are wanted";
}

TEST_F(TextureFileTest, IsDrawnOnTheMeshesThatHaveCoordinatesForIt) {
  std::ofstream(folder_ / "lab/meshes/wood.png") << "four colours";
  Read("wood.png");
  std::ofstream(folder_ / "lab/meshes/two.obj")
      << "mtllib square.mtl\no bare\nusemtl wood\nv 0 0 9\nv 1 0 9\nv 1 1 9\nf 1 2 3\n"
         "o square\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
         "vt 0 1\nf 4/1 5/2 6/3\nf 4/1 6/3 7/4\n";
  const Mesh mesh = ReadMeshFile(folder_ / "lab/meshes/two.obj", ColladaUp::kIgnored, &reading_);
  EXPECT_THAT(reading_.problems, ElementsAre(HasSubstr("no texture coordinates")));
  EXPECT_EQ(ColorAt(mesh, 0.25F, 0.75F), kRed);
}

TEST_F(TextureFileTest, IsTintedByTheColourOfItsMaterial) {
  std::ofstream(folder_ / "lab/meshes/wood.png") << "four colours";
  const Mesh mesh = Read("wood.png\nKd 0.5 1 0.25");
  EXPECT_EQ(ColorAt(mesh, 0.25F, 0.75F), Vector4f(0.5F, 0, 0, 1));
  EXPECT_EQ(ColorAt(mesh, 0.75F, 0.25F), Vector4f(0.5F, 1, 0.25F, 1));
}

TEST_F(TextureFileTest, OfManyMeshesHasNoMoreTrianglesThanOfOne) {
  std::ofstream(folder_ / "lab/meshes/wood.png") << "four colours";
  Read("wood.png");
  std::ofstream obj(folder_ / "lab/meshes/many.obj");
  obj << "mtllib square.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  for (int i = 0; i < 100; ++i) {
    obj << "o part" << i << "\nusemtl wood\nv 0 0 " << i << "\nv 1 0 " << i << "\nv 1 1 " << i
        << "\nv 0 1 " << i << "\nf -4/1 -3/2 -2/3\nf -4/1 -2/3 -1/4\n";
  }
  obj.close();
  const Mesh mesh = ReadMeshFile(folder_ / "lab/meshes/many.obj", ColladaUp::kIgnored, &reading_);
  EXPECT_LE(mesh.triangles.size() / 3, kMostTexturedTriangles);
  EXPECT_GT(mesh.triangles.size() / 3, kMostTexturedTriangles / 2);
}

TEST_F(TextureFileTest, ThatCannotBeReadIsNamedAndTheMeshIsDrawn) {
  std::ofstream(folder_ / "secret.png") << "four colours";
  std::ofstream(folder_ / "lab/meshes/text.png") << "something else";
  const auto problem = [&](const std::string& name) {
    EXPECT_EQ(Read(name).triangles.size(), 6U);
    EXPECT_EQ(reading_.problems.size(), 1U);
    return reading_.problems.empty() ? "" : reading_.problems[0];
  };
  EXPECT_THAT(problem("none.png"), HasSubstr("its texture 'none.png' is not drawn: "));
  EXPECT_THAT(problem("text.png"), HasSubstr("it is no picture"));
  EXPECT_THAT(problem("../../secret.png"), HasSubstr("it is neither beside the mesh nor in a "
                                                     "folder beside that of the mesh"));
  EXPECT_THAT(problem((folder_ / "secret.png").c_str()), HasSubstr("neither beside the mesh"));
}

}  // namespace
}  // namespace kinescope::urdf
