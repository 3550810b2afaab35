#include "server/app/golden/golden_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "tests/server/picture/fake_renderer.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class GoldenCaseFile : public ::testing::Test {
 protected:
  GoldenCase Load(const std::string& yaml) const {
    std::ofstream(folder_ / "case.yaml") << yaml;
    return LoadGoldenCase(folder_ / "case.yaml");
  }
  std::string Complaint(const std::string& yaml) const {
    try {
      Load(yaml);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }

  kinescope::testing::TempFolder folder_;
};

TEST_F(GoldenCaseFile, RejectsAnInvalidTime) {
  for (const std::string time : {"-3", "-0.001", "864001", "1e300", "nan", "inf"}) {
    EXPECT_THAT(Complaint("source: demo:lift\ntime: " + time + "\n"),
                AllOf(HasSubstr("case.yaml:2: time=" + time + ": expected"),
                      HasSubstr("from 0 to 864000 s")));
  }
  EXPECT_EQ(Complaint("source: demo:lift\ntime: 0\n"), "");
  EXPECT_EQ(Complaint("source: demo:lift\ntime: 864000\n"), "");
}

TEST_F(GoldenCaseFile, RejectsACaseWithoutTheSpheresThatAreCompared) {
  EXPECT_THAT(Complaint("source: demo:lift\nloads: skin\n"), HasSubstr("use both"));
  EXPECT_EQ(Complaint("source: demo:lift\nloads: both\n"), "");
}

TEST_F(GoldenCaseFile, RejectsATimeThatTheBuiltInSubjectReachesTooLate) {
  const GoldenCase golden_case = Load("source: demo:lift\ntime: 864000\nsize: 16x16\n");
  kinescope::testing::FakeRenderer renderer;
  try {
    Draw(golden_case, renderer, [](const GoldenDrawing&) {});
    ADD_FAILURE() << "it was drawn";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("golden case case: time: 864000: demo:lift is generated "
                                        "motion; expected at most 3600 s"));
  }
}

TEST_F(GoldenCaseFile, HasTheViewOfAnRvizFileBesideIt) {
  std::ofstream(folder_ / "lab.rviz")
      << "Visualization Manager:\n  Global Options: {Background Color: 10; 20; 30}\n"
         "  Displays: [{Class: rviz/Path, Enabled: true, Topic: /plan}]\n"
         "  Views: {Current: {Class: rviz/Orbit, Distance: 4}}\n";
  std::ofstream(folder_ / "walk.bag") << "#ROSBAG V2.0\n";
  const GoldenCase golden_case = Load("source: walk.bag\nrviz: lab.rviz\nfov: 50\nsize: 16x16\n");
  EXPECT_EQ(*golden_case.rviz, folder_ / "lab.rviz");
  EXPECT_EQ(golden_case.view.background.ToText(), "#0a141e");
  EXPECT_THAT(golden_case.view.marker_topics.ToText(), HasSubstr("/plan"));
  EXPECT_TRUE(golden_case.view.camera->front().place);
  EXPECT_EQ(golden_case.view.moves.fov.ToText(), "50") << "the case has its own";
  EXPECT_EQ(golden_case.given.count("camera"), 0u) << "the file may change";
  EXPECT_THAT(Complaint("source: walk.bag\nrviz: other.rviz\n"), HasSubstr("other.rviz"));
}

TEST_F(GoldenCaseFile, HasItsMeasuredForcesBesideIt) {
  const GoldenCase golden_case =
      Load("source: demo:lift\nsize: 16x16\ntime: 0.05\nwrenches: forces.csv\n");
  std::ofstream(*golden_case.loads.measured.wrenches)
      << "time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm,tz_Nm\n"
         "0,LeftHand,0,0,-50,,,,0,0,0\n0.1,LeftHand,0,0,-50,,,,0,0,0\n";
  EXPECT_EQ(*golden_case.loads.measured.wrenches, folder_ / "forces.csv");
  bool is_measured = false;
  kinescope::testing::FakeRenderer renderer(
      [&](const auto&, const SceneState& state, const auto&, const auto&) {
        is_measured = state.people.at(0).forces.hands[urdf::kLeft].is_measured;
      });
  Draw(golden_case, renderer, [](const GoldenDrawing&) {});
  EXPECT_TRUE(is_measured);
}

TEST_F(GoldenCaseFile, HasItsPersonBesideIt) {
  EXPECT_EQ(Load("source: demo:lift\nfigure: skin:person.glb\n").view.figure.ToText(),
            "skin:" + std::string(folder_ / "person.glb"));
  EXPECT_EQ(Load("source: demo:lift\nfigure: skin:/a/person.glb\n").view.figure.ToText(),
            "skin:/a/person.glb");
  EXPECT_EQ(Load("source: demo:lift\nfigure: urdf\n").view.figure.ToText(), "urdf");
}

TEST_F(GoldenCaseFile, HasAllItsFilesBesideIt) {
  const GoldenCase golden_case = Load(
      "source: a.mvnx\nghost: b.mvnx@2\nrobot: [c.urdf, '/d.urdf@1,2']\nbody_model: mesh:e\n"
      "tool: right:f.stl@0,0,0;left:/g.stl\ncamera: h.yaml\n");
  const std::string folder = folder_.path();
  EXPECT_EQ(*golden_case.source, folder + "/a.mvnx");
  EXPECT_EQ(golden_case.view.ghost->source, folder + "/b.mvnx");
  EXPECT_EQ(golden_case.view.robot->at(0).file, folder + "/c.urdf");
  EXPECT_EQ(golden_case.view.robot->at(1).file, "/d.urdf");
  EXPECT_EQ(golden_case.person.body_model->folder, folder + "/e");
  EXPECT_EQ((*golden_case.person.tool)[urdf::kRight]->path, folder + "/f.stl");
  EXPECT_EQ((*golden_case.person.tool)[urdf::kLeft]->path, "/g.stl");
  EXPECT_EQ(golden_case.view.camera->at(0).text, folder + "/h.yaml");
  EXPECT_EQ(golden_case.given.at("ghost"), "b.mvnx@2") << "as the file says it";
  EXPECT_EQ(Load("source: demo:lift\nghost: demo:lift@1\n").view.ghost->source, "demo:lift");
}

// A long one is folded, or keeps its line breaks; it is no file beside the case.
TEST_F(GoldenCaseFile, HasAWrittenPose) {
  for (const std::string source :
       {"pose:right_elbow=90,left_knee=45", "'pose: right_elbow=90, left_knee=45'",
        ">\n  pose:\n  right_elbow=90,\n  left_knee=45",
        "|\n  pose:\n  right_elbow=90,\n  left_knee=45"}) {
    const GoldenCase golden_case =
        Load("source: " + source + "\nghost: pose:t_pose,x=1@0\nsize: 16x16\n");
    EXPECT_EQ(golden_case.source->substr(0, 5), "pose:") << source;
    EXPECT_EQ(golden_case.view.ghost->source, "pose:t_pose,x=1");
    double flexion = 0, ghost_x = 0;
    kinescope::testing::FakeRenderer renderer(
        [&](const auto&, const SceneState& state, const auto&, const auto& spec) {
          const auto angles = urdf::AnatomicalAngles(OrientationsOf(state.people.at(0).sample),
                                                     urdf::AngleSequence::kZxy);
          flexion = angles[urdf::jRightElbow].z();
          ghost_x = spec.look.ghosts.at(0).person.links[urdf::kPelvis].position.x();
        });
    Draw(golden_case, renderer, [](const auto&) {});
    EXPECT_NEAR(flexion, 90, 1e-6) << source;
    EXPECT_NEAR(ghost_x, 1, 1e-6) << source;
    EXPECT_THAT(InputsOf(golden_case), ::testing::SizeIs(1)) << "no file is read";
    EXPECT_EQ(InputsOf(golden_case).front().name, "pose:right_elbow=90,left_knee=45");
    EXPECT_EQ(InputsOf(golden_case).front().sha256, "");
  }
}

TEST_F(GoldenCaseFile, GivesTheReferencePoseTheAppearanceOfThePerson) {
  const GoldenCase golden_case =
      Load("source: demo:lift\nghost: demo:lift@1\nbody_model: primitive\nsize: 16x16\n");
  int drawn = 0;
  kinescope::testing::FakeRenderer renderer(
      [&](const auto&, const auto&, const auto&, const auto& view) {
        ++drawn;
        ASSERT_EQ(view.look.ghosts.size(), 1u);
        EXPECT_EQ(view.look.ghosts[0].person.model->human.mesh_folder, "");
      });
  Draw(golden_case, renderer, [](const GoldenDrawing&) {});
  EXPECT_EQ(drawn, 1);
}

}  // namespace
}  // namespace kinescope::app
