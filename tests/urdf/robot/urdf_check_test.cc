#include "urdf/robot/urdf_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "tests/shared_data.h"
#include "urdf/human_urdf.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::urdf {
namespace {

using Kind = UrdfProblem::Kind;

std::string All(const UrdfReport& report) {
  std::string text;
  for (const UrdfProblem& problem : report.problems) {
    text += std::to_string(problem.line) + " " + Name(problem.kind) + " " + problem.element + ": " +
            problem.what + "\n";
  }
  return text;
}

// Whether there is a problem of this kind, in this line, with this element, that says `what`.
::testing::AssertionResult Says(const UrdfReport& report, Kind kind, int line,
                                const std::string& element, const std::string& what) {
  for (const UrdfProblem& problem : report.problems) {
    if (problem.kind == kind && problem.line == line && problem.element == element &&
        problem.what.find(what) != std::string::npos && !problem.suggestion.empty()) {
      return ::testing::AssertionSuccess();
    }
  }
  return ::testing::AssertionFailure() << "not among:\n" << All(report);
}

UrdfReport Check(const std::string& xml) { return CheckUrdf(xml, MeshSearch()); }

constexpr char kBody[] =
    "<inertial><mass value='1'/>"
    "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";

std::string Body(const std::string& name) {
  return "<link name='" + name + "'>" + kBody + "</link>\n";
}

std::string Joint(
    const std::string& name, const std::string& parent, const std::string& child,
    const std::string& inner = "<limit lower='-1' upper='1' effort='1' velocity='1'/>") {
  return "<joint name='" + name + "' type='revolute'><parent link='" + parent + "'/><child link='" +
         child + "'/>" + inner + "</joint>\n";
}

// Each piece begins a line; the first is in line 2.
std::string Robot(const std::vector<std::string>& pieces) {
  std::string xml = "<robot name='r'>\n";
  for (const std::string& piece : pieces) xml += piece;
  return xml + "</robot>";
}

TEST(UrdfCheck, FindsNoProblemsInAValidRobot) {
  const UrdfReport report = Check(Robot({Body("a"), Body("b"), Joint("j", "a", "b")}));
  EXPECT_TRUE(report.problems.empty()) << All(report);
  EXPECT_TRUE(report.is_usable());
  EXPECT_EQ(report.robot, "r");
  EXPECT_EQ(report.roots, std::vector<std::string>{"a"});
  EXPECT_EQ(report.links, 2u);
  EXPECT_EQ(report.joints, 1u);
  EXPECT_EQ(report.moving_joints, 1u);
  EXPECT_EQ(report.mass, 2);
}

TEST(UrdfCheck, DistinguishesTwoParentsLoopsAndSeveralRoots) {
  const UrdfReport two =
      Check(Robot({Body("a"), Body("b"), Body("c"), Joint("j", "a", "c"), Joint("k", "b", "c")}));
  EXPECT_TRUE(Says(two, Kind::kUnreadable, 6, "link 'c'", "two joints; the other is in line 5"));
  EXPECT_TRUE(Says(two, Kind::kUnreadable, 3, "robot", "2 roots: link 'a', link 'b'"));

  const UrdfReport loop =
      Check(Robot({Body("a"), Body("b"), Body("c"), Joint("j", "b", "c"), Joint("k", "c", "b")}));
  EXPECT_TRUE(Says(loop, Kind::kUnreadable, 6, "link 'b'", "a loop of 2 links: b → c → b"));
  EXPECT_EQ(loop.roots, std::vector<std::string>{"a"});

  const UrdfReport own = Check(Robot({Body("a"), Joint("j", "a", "a")}));
  EXPECT_TRUE(Says(own, Kind::kUnreadable, 3, "link 'a'", "a loop of 1 link"));
  EXPECT_TRUE(own.roots.empty());
}

TEST(UrdfCheck, ReportsMissingAndDuplicateElements) {
  const UrdfReport report =
      Check(Robot({Body("a"), Body("a"), Joint("j", "a", "ghost"), Joint("j", "a", ""), "<link/>\n",
                   "<joint type='fixed'/>\n"}));
  EXPECT_TRUE(Says(report, Kind::kUnreadable, 3, "link 'a'", "already used in line 2"));
  EXPECT_TRUE(Says(report, Kind::kUnreadable, 4, "joint 'j'", "child link 'ghost' does not exist"));
  EXPECT_TRUE(Says(report, Kind::kUnreadable, 5, "joint 'j'", "already used in line 4"));
  EXPECT_TRUE(Says(report, Kind::kUnreadable, 6, "link", "no name"));
  EXPECT_TRUE(Says(report, Kind::kUnreadable, 7, "joint ''", "names no parent link"));
  EXPECT_TRUE(Says(Check("<robot name='r'/>"), Kind::kUnreadable, 1, "robot", "no <link>"));
  EXPECT_TRUE(
      Says(Check("<robot><link name='a'/></robot>"), Kind::kUnreadable, 1, "robot", "no name"));
}

TEST(UrdfCheck, ChecksTheMassAndInertiaOfEveryLink) {
  const auto inertial = [](const std::string& mass, const std::string& xx, const std::string& yy,
                           const std::string& zz, const std::string& xy = "0") {
    return "<link name='b'><inertial><mass value='" + mass + "'/><inertia ixx='" + xx + "' ixy='" +
           xy + "' ixz='0' iyy='" + yy + "' iyz='0' izz='" + zz + "'/></inertial></link>\n";
  };
  const auto check = [&](const std::string& link) {
    return Check(Robot({Body("a"), link, Joint("j", "a", "b")}));
  };
  const auto says = [&](const std::string& link, Kind kind, const std::string& what) {
    return Says(check(link), kind, 3, "link 'b'", what);
  };
  EXPECT_TRUE(says(inertial("-1", "1", "1", "1"), Kind::kWrong, "negative: -1 kg"));
  EXPECT_TRUE(says(inertial("1e9", "1", "1", "1"), Kind::kWrong, "1e+09 kg"));
  EXPECT_TRUE(says(inertial("nan", "1", "1", "1"), Kind::kUnreadable, "<mass> value='nan'"));
  EXPECT_TRUE(says(inertial("0", "0", "0", "0"), Kind::kWarning, "moves and has no mass"));
  EXPECT_TRUE(says("<link name='b'/>\n", Kind::kWarning, "moves and has no mass"));
  EXPECT_TRUE(says(inertial("1", "0", "0", "0"), Kind::kWarning, "no inertia for 1 kg"));
  EXPECT_TRUE(says(inertial("1", "1", "1", "-1"), Kind::kWrong, "not positive definite"));
  EXPECT_TRUE(says(inertial("1", "1", "1", "1", "2"), Kind::kWrong, "not positive definite"));
  EXPECT_TRUE(says(inertial("1", "1", "1", "2.1"), Kind::kWrong, "triangle inequality"));
  EXPECT_TRUE(check(inertial("1", "1", "1", "2")).problems.empty()) << "a flat body";
  // A root, or what is welded on, needs no mass.
  EXPECT_TRUE(Check("<robot name='r'><link name='a'/></robot>").problems.empty());
}

TEST(UrdfCheck, ChecksEveryShape) {
  const auto says = [](const std::string& visual, Kind kind, const std::string& what) {
    return Says(Check("<robot name='r'><link name='a'>\n<collision>\n" + visual +
                      "</collision></link></robot>"),
                kind, 3, "link 'a'", what);
  };
  EXPECT_TRUE(says("<geometry><box size='1 1 1001'/></geometry>", Kind::kUnreadable, "1001 m"));
  EXPECT_TRUE(says("<geometry><box size='1 -1 1'/></geometry>", Kind::kUnreadable, "negative"));
  EXPECT_TRUE(says("<geometry><box size='1 1'/></geometry>", Kind::kUnreadable, "size='1 1'"));
  EXPECT_TRUE(says("<geometry><box size='1 1 1 1'/></geometry>", Kind::kUnreadable, "size="));
  EXPECT_TRUE(says("<geometry><box/></geometry>", Kind::kUnreadable, "size is missing"));
  EXPECT_TRUE(says("<geometry><sphere radius='0'/></geometry>", Kind::kWarning, "is 0"));
  EXPECT_TRUE(says("<geometry><cone/></geometry>", Kind::kUnreadable, "<cone> is not a shape"));
  EXPECT_TRUE(says("<geometry><mesh/></geometry>", Kind::kUnreadable, "no filename"));
  EXPECT_TRUE(says("<geometry><mesh filename='/no/such.stl'/></geometry>", Kind::kWrong,
                   "/no/such.stl is missing"));
  EXPECT_TRUE(says("<geometry><mesh filename='/a.stl' scale='0 1 1'/></geometry>", Kind::kWarning,
                   "scale is 0"));
  EXPECT_TRUE(says("<origin xyz='0 0 1e7'/><geometry><sphere radius='1'/></geometry>",
                   Kind::kUnreadable, "1e+07 m away"));
}

TEST(UrdfCheck, ChecksEveryJoint) {
  const auto says = [](const std::string& inner, Kind kind, const std::string& what) {
    return Says(Check(Robot({Body("a"), Body("b"), Joint("j", "a", "b", inner)})), kind, 4,
                "joint 'j'", what);
  };
  const std::string limit = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";
  EXPECT_TRUE(says("", Kind::kUnreadable, "without <limit>"));
  EXPECT_TRUE(says("<limit lower='2' upper='1' effort='1' velocity='1'/>", Kind::kWrong,
                   "lower 2 is above upper 1"));
  EXPECT_TRUE(
      says("<limit lower='2' upper='3' velocity='1'/>", Kind::kUnreadable, "effort is missing"));
  EXPECT_TRUE(says("<limit lower='2' upper='3' effort='-1' velocity='1'/>", Kind::kWrong,
                   "effort is negative"));
  EXPECT_TRUE(says("<axis xyz='0 0 0'/>" + limit, Kind::kUnreadable, "no direction"));
  EXPECT_TRUE(says("<axis xyz='0 0 2'/>" + limit, Kind::kWarning, "length 2"));
  EXPECT_TRUE(says("<axis xyz='0 0 x'/>" + limit, Kind::kUnreadable, "xyz='0 0 x'"));
  EXPECT_TRUE(says("<mimic joint='ghost'/>" + limit, Kind::kWrong, "'ghost', which does not"));
}

TEST(UrdfCheck, ReportsDocumentsThatAreNotUrdfs) {
  EXPECT_TRUE(Says(Check(""), Kind::kUnreadable, 1, "document", "no element found"));
  EXPECT_TRUE(Says(Check("<robot name='r'>\n<link name='a'>\n</robot>"), Kind::kUnreadable, 3,
                   "document", "mismatched tag"));
  EXPECT_TRUE(Says(Check("<!DOCTYPE a [<!ENTITY b 'c'>]><robot name='&b;'/>"), Kind::kUnreadable, 1,
                   "document", "DOCTYPE"));
  EXPECT_TRUE(Says(Check("<sdf version='1.6'/>"), Kind::kUnreadable, 1, "<sdf>", "SDF"));
  EXPECT_TRUE(Says(Check("<robot name='r' xmlns:xacro='x'>\n<xacro:include filename='a'/></robot>"),
                   Kind::kUnreadable, 2, "<xacro:include>", "xacro"));
}

TEST(UrdfCheck, ReportsSwappedLimitsAsWrongButReadable) {
  const UrdfReport report = Check(Robot({Body("a"), Body("b"),
                                         Joint("j", "a", "b",
                                               "<limit lower='2' "
                                               "upper='1' effort='1' velocity='1'/>")}));
  EXPECT_FALSE(report.is_usable());
  const auto is_unreadable = [](const UrdfProblem& p) { return p.kind == Kind::kUnreadable; };
  EXPECT_TRUE(std::none_of(report.problems.begin(), report.problems.end(), is_unreadable));
}

TEST(UrdfCheck, ReportsMaterialsWithoutDefinition) {
  const auto check = [](const std::string& before, const std::string& inner) {
    return Check(
        "<robot name='r'>" + before + "<link name='a'>\n<visual><geometry><box size='1 1 1'/>" +
        "</geometry><material name='paint'>" + inner + "</material></visual></link></robot>");
  };
  EXPECT_TRUE(
      Says(check("", ""), Kind::kWarning, 2, "link 'a'", "material 'paint' is not defined"));
  const std::string color = "<color rgba='1 0 0 1'/>";
  EXPECT_TRUE(check("", color).problems.empty());
  EXPECT_TRUE(check("<material name='paint'>" + color + "</material>", "").problems.empty());
  EXPECT_TRUE(
      Says(check("", "<color rgba='255 0 0 1'/>"), Kind::kWarning, 2, "link 'a'", "0 to 1"));
}

TEST(UrdfCheck, FindsOnlyMasslessLinksInTheGeneratedHuman) {
  HumanModel human;
  human.skeleton = DefaultSkeleton(1.8);
  human.body = MakeBodyParameters(BodyDescription(), human.skeleton);
  const UrdfReport report = Check(WriteUrdf(human));
  EXPECT_TRUE(report.is_usable()) << All(report);
  EXPECT_EQ(report.links, 67u);
  for (const UrdfProblem& problem : report.problems) {
    EXPECT_NE(problem.what.find("no mass"), std::string::npos) << problem.what;
  }
}

TEST(UrdfCheck, ChecksAMillionElementsInSeconds) {
  std::string xml = "<robot name='r'>";
  for (int i = 0; i < 150'000; ++i) {
    xml += "<joint name='j" + std::to_string(i) + "' type='fixed'><parent link='p'/></joint>";
  }
  const std::clock_t before = std::clock();
  const UrdfReport report = Check(xml + "</robot>");
  EXPECT_FALSE(report.is_usable());
  EXPECT_LT((std::clock() - before) / CLOCKS_PER_SEC, 20) << "CPU s; a busy machine takes longer";
}

TEST(UrdfCheck, AcceptsThePublishedHumanModelsOfOtherProjects) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-gazebo/humanSubject01_66dof.urdf");
  using kinescope::testing::ReadFile;
  using kinescope::testing::SharedData;
  for (const char* file : {"humanSubject01_66dof.urdf", "humanSubject01_48dof.urdf"}) {
    const UrdfReport report =
        Check(ReadFile(SharedData(std::string("models/human-gazebo/") + file)));
    EXPECT_TRUE(report.is_usable()) << All(report);
    EXPECT_NEAR(report.mass, 62.2, 0.1);
    EXPECT_EQ(report.roots, std::vector<std::string>{"Pelvis"});
  }
  const UrdfReport generated =
      Check(ReadFile(SharedData("models/human-model-generator/humanModelTemplate.urdf")));
  EXPECT_TRUE(generated.is_usable()) << All(generated);
}

}  // namespace
}  // namespace kinescope::urdf
