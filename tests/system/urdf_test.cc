// `kinescope urdf`: a person as files, a look for faults, a picture of any robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "render/image/compare.h"
#include "render/image/png_file.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"
#include "tests/urdf/mesh_samples.h"
#include "urdf/robot/robot_model.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::ReadFile;
using testing::SharedData;
using testing::TempFolder;

class UrdfCommand : public ::testing::Test {
 protected:
  ProgramResult Urdf(std::vector<std::string> arguments,
                     const std::vector<std::string>& environment = {}) const {
    arguments.insert(arguments.begin(), "urdf");
    std::vector<std::string> all = {"XDG_CACHE_HOME=" + (folder_ / "cache").string()};
    all.insert(all.end(), environment.begin(), environment.end());
    return testing::Kinescope(arguments, all);
  }

  std::string Write(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  std::string At(const std::string& name) const { return (folder_ / name).string(); }

  TempFolder folder_;
};

constexpr char kArm[] =
    "<robot name='arm'>\n<link name='base'><visual><geometry><box size='0.2 0.2 0.2'/></geometry>"
    "</visual></link>\n<link name='hand'><visual><geometry>\n<mesh "
    "filename='package://arm_description/meshes/hand.stl' scale='0.1 0.1 0.1'/></geometry></visual>"
    "</link>\n<joint name='elbow' type='revolute'><parent link='base'/><child link='hand'/>"
    "<origin xyz='0 0 0.3'/><axis xyz='1 0 0'/>"
    "<limit lower='-2' upper='2' effort='1' velocity='1'/></joint>\n</robot>\n";

TEST_F(UrdfCommand, WritesAPersonOfASourceOrAHeightToTheScreenOrAFile) {
  const ProgramResult screen = Urdf({"--height", "1.62"});
  EXPECT_EQ(screen.exit_code, 0) << screen.err;
  EXPECT_EQ(urdf::ParseUrdf(screen.out).links.size(), 67u);
  EXPECT_EQ(Urdf({"--height", "1.62", "--out", At("a.urdf")}).exit_code, 0);
  EXPECT_EQ(ReadFile(At("a.urdf")), screen.out);
  const ProgramResult positional = Urdf({"demo:lift", "--body_model", "primitive"});
  EXPECT_EQ(positional.exit_code, 0) << positional.err;
  EXPECT_EQ(Urdf({"--source", "demo:lift", "--body_model", "primitive"}).out, positional.out);
}

TEST_F(UrdfCommand, ReportsAFullDiskAndKeepsTheOldFile) {
  const std::string file = Write("a.urdf", "<robot name='before'/>");
  const ProgramResult result =
      testing::RunProgram({"/usr/bin/prlimit", "--fsize=8192", testing::KinescopePath(), "urdf",
                           "--body_model", "primitive", "--out", file});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--out=" + file), HasSubstr("File too large")));
  EXPECT_EQ(ReadFile(file), "<robot name='before'/>");
  EXPECT_THAT(folder_.Names(), ::testing::ElementsAre("a.urdf"));

  const ProgramResult nowhere = Urdf({"--out", At("nowhere/a.urdf")});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("No such file or directory"));
}

TEST_F(UrdfCommand, ExportsAPackageThatItsOwnCheckFinds) {
  const ProgramResult result = Urdf({"--height", "1.9", "--out", At("ines"), "--package", "ines"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(ReadFile(At("ines/person.urdf")), HasSubstr("package://ines/meshes/"));
  const ProgramResult lost = Urdf({"check", At("ines/person.urdf")});
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.out, HasSubstr("package 'ines' was not found"));
  const ProgramResult found = Urdf({"check", At("ines/person.urdf"), "--package_path", At("")});
  EXPECT_EQ(found.exit_code, 0) << found.out;
  const ProgramResult by_ros =
      Urdf({"check", At("ines/person.urdf")}, {"ROS_PACKAGE_PATH=" + At("")});
  EXPECT_EQ(by_ros.exit_code, 0) << by_ros.out;

  ASSERT_EQ(Urdf({"--height", "1.9", "--out", At("plain")}).exit_code, 0);
  EXPECT_EQ(Urdf({"check", At("plain/person.urdf")}).exit_code, 0);
  const ProgramResult nowhere = Urdf({"--out", At("b.urdf"), "--package", "ines"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("--package=ines"));
}

std::vector<std::string> MeshUris(const std::string& urdf_file) {
  std::vector<std::string> uris;
  for (const urdf::Link& link : urdf::ParseUrdf(ReadFile(urdf_file)).links) {
    for (const urdf::Visual& visual : link.visuals) {
      if (!visual.geometry.mesh_uri.empty()) uris.push_back(visual.geometry.mesh_uri);
    }
  }
  return uris;
}

TEST_F(UrdfCommand, AppliesTheBodyModelWithAndWithoutASource) {
  Write("own/Head.stl", testing::BoxStl());  // of metres; as centimetres it may be a head
  for (const std::string source : {"", "demo:n_pose"}) {
    const auto write = [&](const std::string& figure, const std::string& out) {
      std::vector<std::string> arguments = {"--body_model", figure,  "--mesh_units",
                                            "cm",           "--out", At(out)};
      if (!source.empty()) arguments.push_back(source);
      const ProgramResult result = Urdf(arguments);
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return result.out;
    };
    EXPECT_THAT(write("primitive", "p"), Not(HasSubstr("meshes")));
    EXPECT_TRUE(MeshUris(At("p/person.urdf")).empty()) << "source '" << source << "'";
    EXPECT_FALSE(fs::exists(At("p/meshes")));
    write("primitive", "p.urdf");
    EXPECT_TRUE(MeshUris(At("p.urdf")).empty()) << "source '" << source << "'";

    write("smooth", "s");
    EXPECT_EQ(MeshUris(At("s/person.urdf")).size(), 23u);
    write("mesh:" + At("own"), "m");
    EXPECT_EQ(MeshUris(At("m/person.urdf")).size(), 23u);
    EXPECT_NE(ReadFile(At("m/meshes/head.stl")), ReadFile(At("s/meshes/head.stl")));
    EXPECT_EQ(ReadFile(At("m/meshes/l5.stl")), ReadFile(At("s/meshes/l5.stl")))
        << "ours stands in where there is none";
    write("mesh:" + At("own"), "m.urdf");
    for (const std::string& uri : MeshUris(At("m.urdf"))) {
      ASSERT_EQ(uri.rfind("file://", 0), 0u) << uri;
      const std::string path = uri.substr(7);
      if (fs::path(path).stem() != "head") continue;
      EXPECT_EQ(ReadFile(path), ReadFile(At("m/meshes/head.stl")));
    }
    fs::remove_all(At("p"));
  }
}

TEST_F(UrdfCommand, GivesEveryLinkAMassForGazebo) {
  const auto links_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--mass", "70", "--body_model", "primitive"});
    const ProgramResult result = Urdf(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return urdf::ParseUrdf(result.out).links;
  };
  for (const bool for_gazebo : {false, true}) {
    double mass = 0;
    int weightless = 0;
    const auto links = for_gazebo ? links_of({"--gazebo"}) : links_of({});
    for (const urdf::Link& link : links) {
      mass += link.mass;
      weightless += link.mass > 0 ? 0 : 1;
    }
    EXPECT_NEAR(mass, 70, 1e-9);
    EXPECT_EQ(weightless, for_gazebo ? 0 : 44);
  }
}

TEST_F(UrdfCommand, WritesTheSkinOfAMoment) {
  const std::string take = At("take.mvnx");
  ASSERT_EQ(testing::Kinescope({"convert", "demo:lift", "--seconds", "1", "--out", take}).exit_code,
            0);
  const auto written = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--out", At("person.glb")});
    const ProgramResult result = Urdf(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ReadFile(At("person.glb"));
  };
  const std::string bind = written({take}), start = written({take, "--time", "0"}),
                    later = written({take, "--time", "0.9"});
  EXPECT_NE(bind, start);
  EXPECT_NE(start, later);
  EXPECT_THAT(later, HasSubstr("\"skins\""));
  EXPECT_THAT(written({take, "--time", "0.9", "--no_skeleton"}), Not(HasSubstr("\"skins\"")));
}

TEST_F(UrdfCommand, RejectsATimeThatTheFileCannotShow) {
  const std::string take = At("take.mvnx");
  ASSERT_EQ(testing::Kinescope({"convert", "demo:lift", "--seconds", "1", "--out", take}).exit_code,
            0);
  const auto refusal = [&](const std::vector<std::string>& arguments) {
    const ProgramResult result = Urdf(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(At("a.glb")));
    return result.err;
  };
  EXPECT_THAT(refusal({take, "--time", "1.5", "--out", At("a.glb")}),
              HasSubstr("--time=1.5: " + take + " ends before this time, at 1.000 s"));
  EXPECT_THAT(refusal({"demo:lift", "--time", "-1", "--out", At("a.glb")}),
              HasSubstr("--time=-1: expected a number from 0 to 864000 s"));
  EXPECT_THAT(refusal({"demo:lift", "--time", "800000", "--out", At("a.glb")}),
              HasSubstr("--time=800000: demo:lift is generated motion"));
  EXPECT_THAT(refusal({"--time", "1", "--out", At("a.glb")}),
              HasSubstr("--time=1: needs a source"));
  EXPECT_THAT(refusal({take, "--time", "1", "--out", At("a.urdf")}),
              HasSubstr("--time=1: needs --out FILE.glb"));
  EXPECT_THAT(refusal({take, "--no_skeleton", "--out", At("a.urdf")}),
              HasSubstr("--no_skeleton: needs --out FILE.glb"));
}

TEST_F(UrdfCommand, ReportsFileLineAndElementOfAProblem) {
  const std::string file = Write("r.urdf", kArm);
  const ProgramResult missing = Urdf({"check", file});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.out, HasSubstr("robot 'arm', root 'base', 2 links, 1 joints, 0.000 kg"));
  EXPECT_THAT(missing.out,
              HasSubstr(file + ":4: wrong: link 'hand': mesh package://arm_description"));
  EXPECT_THAT(missing.out, HasSubstr("can be drawn, but contains 1 error"));
  Write("arm_description/meshes/hand.stl", testing::BoxStl());
  EXPECT_EQ(
      Urdf({"check", file, "--package_path", At("nowhere"), "--package_path", At("")}).exit_code,
      0);

  const ProgramResult json = Urdf({"check", file, "--json"});
  EXPECT_EQ(json.exit_code, 1);
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report.at("usable"), false);
  EXPECT_EQ(report.at("links"), 2);
  const auto& problems = report.at("problems");
  const auto wrong = std::find_if(problems.begin(), problems.end(),
                                  [](const auto& each) { return each.at("kind") == "wrong"; });
  ASSERT_NE(wrong, problems.end());
  EXPECT_EQ(wrong->at("line"), 4);
  EXPECT_EQ(wrong->at("element"), "link 'hand'");
}

TEST_F(UrdfCommand, DistinguishesInvalidUrdfsFromUnreadableFiles) {
  EXPECT_EQ(Urdf({"check", Write("bomb.urdf", "<!DOCTYPE a [<!ENTITY b 'c'>]><robot name='&b;'/>")})
                .exit_code,
            1);
  EXPECT_EQ(Urdf({"check", Write("noise.urdf", std::string("\x00\xFF\x1B[31m", 6))}).exit_code, 1);
  EXPECT_EQ(Urdf({"check", Write("empty.urdf", "")}).exit_code, 1);
  for (const std::string& path : {At("none.urdf"), At("")}) {
    const ProgramResult result = Urdf({"check", path});
    EXPECT_EQ(result.exit_code, 2) << path;
    EXPECT_THAT(result.err, HasSubstr(path));
    EXPECT_EQ(result.out, "");
  }
  const std::string huge = Write("huge.urdf", "");
  fs::resize_file(huge, std::uintmax_t{1} << 36);  // sparse: it takes no room
  const ProgramResult result = Urdf({"check", huge});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("the limit is"));
}

TEST_F(UrdfCommand, PrintsRepeatedProblemsWithTheirNumber) {
  std::string xml = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i <= 50; ++i) {
    const std::string n = std::to_string(i);
    xml += "\n<link name='l" + n + "'/><joint name='j" + n +
           "' type='continuous'><parent link='l0'/><child link='l" + n + "'/></joint>";
  }
  const ProgramResult result = Urdf({"check", Write("r.urdf", xml + "</robot>")});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("and 47 more like this"),
                                HasSubstr("usable, with 50 warnings"), Not(HasSubstr("'l9'"))));
}

TEST_F(UrdfCommand, RendersAnyRobotInAnyPose) {
  const std::string file = Write("robot/urdf/r.urdf", kArm);
  Write("robot/package.xml", "<package><name>arm_description</name></package>");
  Write("robot/meshes/hand.stl", testing::BoxStl());
  const auto draw = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"picture", file, "--out", At(out), "--size", "320x240"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Urdf(arguments);
  };
  const ProgramResult straight = draw("a.png", {});
  ASSERT_EQ(straight.exit_code, 0) << straight.err;
  EXPECT_THAT(straight.out, AllOf(HasSubstr("robot 'arm', 2 links"), Not(HasSubstr("missing"))));
  ASSERT_EQ(draw("b.png", {"--joint", "elbow=1.2"}).exit_code, 0);
  ASSERT_EQ(draw("c.png", {"--camera", "left"}).exit_code, 0);
  const render::Image picture = render::ReadPng(At("a.png"));
  EXPECT_EQ(picture.width, 320);
  EXPECT_EQ(picture.height, 240);
  EXPECT_GT(render::Compare(picture, render::ReadPng(At("b.png"))).pixels, 500);
  EXPECT_GT(render::Compare(picture, render::ReadPng(At("c.png"))).pixels, 500);

  fs::remove(folder_ / "robot/meshes/hand.stl");
  const ProgramResult missing = draw("d.png", {});
  EXPECT_EQ(missing.exit_code, 0) << missing.err;
  EXPECT_THAT(missing.out, HasSubstr("1 mesh files or textures missing or rejected"));
  EXPECT_THAT(missing.err, HasSubstr("hand.stl"));
}

TEST_F(UrdfCommand, RejectsInvalidPictureOptionsInOneLine) {
  const std::string file = Write("r.urdf", kArm);
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "picture");
    const ProgramResult result = Urdf(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    return result.err;
  };
  EXPECT_THAT(refusal({file, "--out", At("a.jpg")}), HasSubstr("a.jpg"));
  EXPECT_THAT(refusal({file, "--out", At("a.png"), "--joint", "knee=1"}), HasSubstr("'knee'"));
  EXPECT_THAT(refusal({file, "--out", At("a.png"), "--joint", "elbwo=1"}),
              HasSubstr("nearest: elbow"));
  EXPECT_THAT(refusal({file, "--out", At("a.png"), "--joint", "elbow"}), HasSubstr("NAME=RADIANS"));
  EXPECT_THAT(refusal({file, "--out", At("a.png"), "--joint", "elbow=nan"}),
              HasSubstr("--joint=elbow=nan: expected NAME=RADIANS"));
  const std::string bad = Write("bad.urdf", "<robot name='r'>\n<link/></robot>");
  EXPECT_THAT(refusal({bad, "--out", At("a.png")}), HasSubstr("bad.urdf: line 2: link: it has no"));
  const std::string bare = Write("bare.urdf", "<robot name='r'><link name='a'/></robot>");
  EXPECT_THAT(refusal({bare, "--out", At("a.png")}), HasSubstr("nothing to draw"));
}

TEST_F(UrdfCommand, RendersAndChecksPublishedHumanModels) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-gazebo/humanSubject01_66dof.urdf");
  for (const char* file :
       {"human-gazebo/humanSubject01_66dof.urdf", "human-gazebo/humanSubject01_48dof.urdf",
        "human-model-generator/humanModelTemplate.urdf"}) {
    const std::string path = SharedData(std::string("models/") + file);
    EXPECT_EQ(Urdf({"check", path}).exit_code, 0) << file;
    const ProgramResult picture =
        Urdf({"picture", path, "--out", At("a.png"), "--size", "320x240"});
    EXPECT_EQ(picture.exit_code, 0) << picture.err;
    EXPECT_THAT(picture.out, Not(HasSubstr("missing")));
  }
}

}  // namespace
}  // namespace kinescope
