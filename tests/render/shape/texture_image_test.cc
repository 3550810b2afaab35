#include "render/shape/texture_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "render/shape/visual_mesh.h"
#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Red above green.
Image TwoColors(int side) {
  Image image;
  SetSize(image, side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * side + x));
      image.rgba[at] = y < side / 2 ? 255 : 0;
      image.rgba[at + 1] = y < side / 2 ? 0 : 255;
      image.rgba[at + 3] = 255;
    }
  }
  return image;
}

TEST(TextureImage, IsAPngOrAJpeg) {
  const Image image = TwoColors(32);
  for (const auto& bytes : {EncodePng(image), EncodeJpeg(image, 95)}) {
    const urdf::Texture texture = DecodeTexture(bytes.data(), bytes.size());
    EXPECT_EQ(texture.width, 32);
    EXPECT_EQ(texture.height, 32);
    ASSERT_EQ(texture.rgba.size(), 4U * 32 * 32);
    EXPECT_GT(texture.rgba[0], 240);
    EXPECT_GT(texture.rgba[4 * 31 * 32 + 1], 240);
  }
}

TEST(TextureImage, ThatIsDamagedOrOfAnotherKindIsRefused) {
  const std::vector<std::uint8_t> bytes = EncodePng(TwoColors(32));
  constexpr std::size_t kEnd = 12;  // bytes of the chunk after the pixels
  for (std::size_t size = 0; size + kEnd < bytes.size(); size += 7) {
    EXPECT_THROW((void)DecodeTexture(bytes.data(), size), std::runtime_error) << size;
  }
  const std::string text = "GIF89a, which RViz reads";
  EXPECT_THROW((void)DecodeTexture(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
               std::runtime_error);
}

class TexturedVisual : public ::testing::Test {
 protected:
  // Two visuals of one mesh, a square of 1 m.
  VisualMesh Read(const std::string& texture) {
    std::ofstream(folder_ / "square.mtl") << "newmtl m\nKd 1 1 1\nmap_Kd " << texture << "\n";
    std::ofstream(folder_ / "square.obj")
        << "mtllib square.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    urdf::Visual visual;
    visual.geometry.kind = urdf::Geometry::Kind::kMesh;
    visual.geometry.size = Eigen::Vector3d::Ones();
    visual.geometry.mesh_uri = "file://" + std::filesystem::path(folder_ / "square.obj").string();
    VisualReader reader(urdf::MakeMeshSearch({}, {}), urdf::ShapeDetail::Robot());
    VisualMesh mesh;
    reader.Add(visual, 0, mesh);
    reader.Add(visual, 1, mesh);
    return mesh;
  }

  kinescope::testing::TempFolder folder_;
};

TEST_F(TexturedVisual, HasTheColoursOfItsPicture) {
  WritePng(folder_ / "two.png", TwoColors(64));
  const VisualMesh visual = Read("two.png");
  EXPECT_THAT(visual.problems, IsEmpty());
  int red = 0, green = 0;
  for (std::size_t i = 0; i < visual.mesh.positions.size(); ++i) {
    const float y = visual.mesh.positions[i].y();
    if (y > 0.55F && visual.mesh.colors[i] == Eigen::Vector4f(1, 0, 0, 1)) ++red;
    if (y < 0.45F && visual.mesh.colors[i] == Eigen::Vector4f(0, 1, 0, 1)) ++green;
  }
  EXPECT_GT(red, 2000);
  EXPECT_GT(green, 2000);
}

TEST_F(TexturedVisual, WithoutItsPictureIsDrawnAndTheReasonIsToldOnce) {
  const VisualMesh visual = Read("none.png");
  EXPECT_EQ(visual.mesh.triangles.size(), 2U * 6);
  EXPECT_THAT(visual.placeholders, IsEmpty());
  EXPECT_THAT(visual.problems, ElementsAre(HasSubstr("square.obj: its texture 'none.png' is not "
                                                     "drawn: ")));
}

}  // namespace
}  // namespace kinescope::render
