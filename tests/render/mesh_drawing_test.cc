// Mesh files are read inside the render module, so they are tested by what the picture shows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/mesh_file_on_demand.h"
#include "tests/render/test_scene.h"
#include "tests/temp_folder.h"
#include "urdf/human_urdf.h"

namespace kinescope::render {
namespace {

using kinescope::testing::Posture;
using kinescope::testing::SceneWith;
using kinescope::testing::TempFolder;

// A cube of side 0.2 m around the origin, as text STL; inside out on request.
std::string CubeStl(bool is_inside_out = false) {
  const int corners[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  std::string text = "solid cube\n";
  for (const auto& triangle : corners) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) {
      const int corner = triangle[is_inside_out ? 2 - i : i];
      for (int axis = 0; axis < 3; ++axis) {
        text +=
            std::string(axis == 0 ? "vertex " : " ") + ((corner >> axis) % 2 != 0 ? "0.1" : "-0.1");
      }
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid cube\n";
}

std::string CubeObj() {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) text += (corner >> axis) % 2 != 0 ? " 0.1" : " -0.1";
    text += "\n";
  }
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

// A person whose head alone is drawn, as `uri` shows it.
SceneState HeadFromFile(const std::string& uri, double scale = 1) {
  SceneState state = SceneWith(Posture::kStanding);
  PersonState& person = state.people[0];
  person.loads.clear();
  person.com.reset();
  person.cop.reset();
  auto model = std::make_shared<PersonModel>(*person.model);
  const std::string head = urdf::LinkName(model->human.model_name, urdf::kHead);
  for (urdf::Link& link : model->robot.links) {
    link.visuals.clear();
    if (link.name != head) continue;
    urdf::Visual visual;
    visual.geometry.kind = urdf::Geometry::Kind::kMesh;
    visual.geometry.mesh_uri = uri;
    visual.geometry.size = Eigen::Vector3d::Constant(scale);
    link.visuals.push_back(visual);
  }
  model->revision = 7;
  person.model = model;
  return state;
}

class MeshDrawing : public ::testing::Test {
 protected:
  MeshDrawing()
      : renderer_(
            MakeRenderer("osmesa", [this](const std::string& line) { log_.push_back(line); })) {
    spec_.width = 640;
    spec_.height = 360;
    spec_.overlays = false;
  }

  std::filesystem::path Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  // Pixels of the head and its shadow's neighbourhood that are no floor.
  Comparison Drawn(const SceneState& state) {
    const Camera camera = NamedCamera("front", state);
    SceneState bodiless = state;
    auto model = std::make_shared<PersonModel>(*state.people[0].model);
    for (urdf::Link& link : model->robot.links) link.visuals.clear();
    bodiless.people[0].model = model;
    return Compare(renderer_->Render(bodiless, camera, spec_),
                   renderer_->Render(state, camera, spec_));
  }

  TempFolder folder_;
  std::vector<std::string> log_;
  std::unique_ptr<Renderer> renderer_;
  PictureSpec spec_;
};

// What a cube of `side` metres at the head covers from the front, px.
double ExpectedSide(const SceneState& state, double side) {
  const Eigen::Vector3d front =
      state.people[0].links[urdf::kHead].position + Eigen::Vector3d(side / 2, 0, 0);
  return side * Project(front, NamedCamera("front", state), 640, 360).px_per_m;
}

TEST_F(MeshDrawing, ShowsEveryFileFormatAtTheLink) {
  for (const std::string& uri :
       {"file://" + Write("cube.stl", CubeStl()).string(), Write("cube.obj", CubeObj()).string(),
        "file://" + Write("a%b cube.stl", CubeStl()).parent_path().string() +
            "/a%25b%20cube.stl"}) {
    const SceneState state = HeadFromFile(uri);
    const Comparison drawn = Drawn(state);
    const double side = ExpectedSide(state, 0.2);
    EXPECT_NEAR(drawn.right - drawn.left + 1, side, 2.5) << uri;
    const Projected head =
        Project(state.people[0].links[urdf::kHead].position, NamedCamera("front", state), 640, 360);
    EXPECT_NEAR((drawn.left + drawn.right + 1) / 2.0, head.x_px, 1.5) << uri;
    EXPECT_NEAR((drawn.top + drawn.bottom + 1) / 2.0, head.y_px, 3) << uri;
  }
  EXPECT_THAT(log_, ::testing::IsEmpty());
}

TEST_F(MeshDrawing, ReadsTheMeshesOfAPersonFromMemory) {
  SceneState state = HeadFromFile(Write("cube.stl", CubeStl()).string());
  const Camera camera = NamedCamera("front", state);
  const Image from_file = renderer_->Render(state, camera, spec_);
  std::filesystem::remove(folder_ / "cube.stl");
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  const auto files =
      std::make_shared<kinescope::testing::MeshFileOnDemand>(folder_ / "cube.stl", CubeStl());
  model->mesh_files = files;
  model->revision += 1;
  state.people[0].model = model;
  EXPECT_TRUE(Compare(renderer_->Render(state, camera, spec_), from_file).equal());
  EXPECT_THAT(log_, ::testing::IsEmpty());
  EXPECT_FALSE(files->is_provided());
}

TEST_F(MeshDrawing, NamesAMeshThatAPersonDoesNotHave) {
  SceneState state = HeadFromFile((folder_ / "sphere.stl").string());
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  model->mesh_files =
      std::make_shared<kinescope::testing::MeshFileOnDemand>(folder_ / "cube.stl", CubeStl());
  state.people[0].model = model;
  renderer_->Render(state, NamedCamera("front", state), spec_);
  EXPECT_THAT(log_, ::testing::ElementsAre(::testing::HasSubstr("sphere.stl")));
}

TEST_F(MeshDrawing, AppliesTheScaleOfTheUrdf) {
  const SceneState state = HeadFromFile(Write("cube.stl", CubeStl()).string(), 0.5);
  const Comparison drawn = Drawn(state);
  EXPECT_NEAR(drawn.right - drawn.left + 1, ExpectedSide(state, 0.1), 2);
}

TEST_F(MeshDrawing, RendersAnInsideOutMeshLikeACorrectOne) {
  const SceneState good = HeadFromFile(Write("good.stl", CubeStl()).string());
  const SceneState bad = HeadFromFile(Write("bad.stl", CubeStl(true)).string());
  const Camera camera = NamedCamera("three_quarter", good);
  EXPECT_TRUE(Compare(renderer_->Render(good, camera, spec_), renderer_->Render(bad, camera, spec_))
                  .equal());
}

// Four walls without lid and floor: seen from above at an angle, the far walls show from within.
TEST_F(MeshDrawing, RendersBothSidesOfAnOpenSurface) {
  std::string tube = CubeObj();
  const std::string::size_type lids = tube.find("f 1 3 4 2");
  tube = tube.substr(0, lids) + "f 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const SceneState open = HeadFromFile(Write("tube.obj", tube).string(), 2);
  const SceneState closed = HeadFromFile(Write("cube.obj", CubeObj()).string(), 2);
  const Camera camera = NamedCamera("iso", open);
  const Eigen::Vector3d& head = open.people[0].links[urdf::kHead].position;
  // Through the missing lid, the inner side of the far wall; through a hole, the floor.
  const Projected inside = Project(head + Eigen::Vector3d(-0.195, 0, 0.12), camera, 640, 360);
  const auto at = static_cast<std::size_t>(
      4 * (static_cast<int>(inside.y_px) * 640 + static_cast<int>(inside.x_px)));
  SceneState nobody;
  nobody.liveness = Liveness::kLive;
  const Image floor = renderer_->Render(nobody, camera, spec_);
  const Image picture = renderer_->Render(open, camera, spec_);
  EXPECT_GT(std::abs(picture.rgba[at] - floor.rgba[at]), 10);
  EXPECT_GT(Compare(picture, renderer_->Render(closed, camera, spec_)).pixels, 100);
}

TEST_F(MeshDrawing, ShowsALabelledBoxForAMissingMeshAndLogsItOnce) {
  const SceneState state = HeadFromFile("file:///no/such/head.stl");
  const Camera camera = NamedCamera("front", state);
  EXPECT_GT(Drawn(state).pixels, 100);
  const Image without_label = renderer_->Render(state, camera, spec_);
  spec_.overlays = true;
  const Image labelled = renderer_->Render(state, camera, spec_);
  const Projected head = Project(state.people[0].links[urdf::kHead].position, camera, 640, 360);
  int changed = 0;
  for (int y = static_cast<int>(head.y_px) - 8; y < static_cast<int>(head.y_px) + 8; ++y) {
    for (int x = static_cast<int>(head.x_px) - 40; x < static_cast<int>(head.x_px) + 40; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * 640 + x));
      changed += labelled.rgba[at] != without_label.rgba[at] ? 1 : 0;
    }
  }
  EXPECT_GT(changed, 200) << "no label over the box";
  ASSERT_EQ(log_.size(), 1u) << "once, not once per picture";
  EXPECT_THAT(log_[0], ::testing::AllOf(::testing::HasSubstr("/no/such/head.stl"),
                                        ::testing::HasSubstr("No such file"),
                                        ::testing::Not(::testing::HasSubstr("\n"))));
}

TEST_F(MeshDrawing, ReportsInvalidMeshesAndRendersBoxes) {
  const std::string whole = CubeStl();
  for (const std::string& uri :
       {Write("empty.stl", "").string(), Write("noise.stl", "no mesh at all").string(),
        Write("cut.stl", std::string(80, 'x') + std::string("\xFF\xFF\xFF\x7F", 4)).string(),
        Write("loose.obj", "v 0 0 0\nf 1 2 99999\n").string(),
        std::string("package://nobody/head.stl"), folder_.operator/("").string()}) {
    const std::size_t before = log_.size();
    EXPECT_GT(Drawn(HeadFromFile(uri)).pixels, 100) << uri;
    EXPECT_EQ(log_.size(), before + 1) << uri;
  }
}

TEST_F(MeshDrawing, ShowsABoxForAMeshOfTenMillionTrianglesAndNamesIt) {
  constexpr std::uint32_t kTriangles = 10'000'000;
  std::string header(84, '\0');
  std::memcpy(header.data() + 80, &kTriangles, sizeof kTriangles);
  const std::filesystem::path many = Write("many.stl", header);
  std::filesystem::resize_file(many, 84 + std::uintmax_t{50} * kTriangles);  // sparse
  EXPECT_GT(Drawn(HeadFromFile(many.string())).pixels, 100);
  ASSERT_EQ(log_.size(), 1u);
  EXPECT_THAT(log_[0], ::testing::HasSubstr("many.stl"));
}

TEST_F(MeshDrawing, RejectsHugeFilesWithoutReadingThem) {
  const std::filesystem::path huge = Write("huge.stl", "");
  std::filesystem::resize_file(huge, std::uintmax_t{1} << 32);  // sparse: it takes no room
  Drawn(HeadFromFile(huge.string()));
  ASSERT_EQ(log_.size(), 1u);
  EXPECT_THAT(log_[0], ::testing::HasSubstr("larger than"));
}

}  // namespace
}  // namespace kinescope::render
