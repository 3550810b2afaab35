// RViz's own pictures as judges: the same robots, in the same postures, seen by the same camera.
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "render/renderer.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/ros/rviz_fixture.h"
#include "tests/urdf/mesh_samples.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope {
namespace {

using testing::Process;

constexpr int kWidth = 800, kHeight = 600;                     // of RVizProgram's screen
constexpr double kRvizFov = M_PI / 4;                          // vertical, of its Orbit view
constexpr std::array<int, 3> kRvizBackground = {0, 255, 255};  // in no robot

struct Orbit {
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();
  double distance = 3, yaw = 0.5, pitch = 0.3;  // m, rad
};

// What a picture shows of a robot, and in which colours.
struct Sight {
  std::vector<bool> is_robot;  // by pixel
  std::vector<std::array<int, 3>> color;
};

struct Difference {
  int pixels = 0;         // of both together
  int shared = 0;         // of these in both
  int thick = 0;          // in one only, and so are all around: no matter of rounding
  int other_colored = 0;  // in both, of another tint
  double iou() const { return pixels > 0 ? static_cast<double>(shared) / pixels : 0; }
};

// Light differs, tint does not: the share that each channel has in the sum.
bool IsOfAnotherTint(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  const double sum_a = a[0] + a[1] + a[2], sum_b = b[0] + b[1] + b[2];
  if (sum_a < 60 || sum_b < 60) return false;  // too dark to tell
  double distance = 0;
  for (std::size_t i = 0; i < 3; ++i) distance += std::abs(a[i] / sum_a - b[i] / sum_b);
  return distance > 0.2;
}

Difference Compare(const Sight& a, const Sight& b) {
  Difference difference;
  const auto at = [](int x, int y) { return static_cast<std::size_t>(y * kWidth + x); };
  for (int y = 1; y + 1 < kHeight; ++y) {
    for (int x = 1; x + 1 < kWidth; ++x) {
      const std::size_t here = at(x, y);
      if (!a.is_robot[here] && !b.is_robot[here]) continue;
      int differing = 0, within = 0;  // of this pixel and those around it
      for (int k = 0; k < 9; ++k) {
        const std::size_t i = at(x - 1 + k % 3, y - 1 + k / 3);
        differing += a.is_robot[i] != b.is_robot[i] ? 1 : 0;
        within += a.is_robot[i] && b.is_robot[i] ? 1 : 0;
      }
      ++difference.pixels;
      difference.shared += a.is_robot[here] && b.is_robot[here] ? 1 : 0;
      difference.thick += differing == 9 ? 1 : 0;
      if (within < 9) continue;  // RViz smooths edges
      difference.other_colored += IsOfAnotherTint(a.color[here], b.color[here]) ? 1 : 0;
    }
  }
  return difference;
}

class RViz : public testing::RVizProgram {
 protected:
  void SetUp() override {
    RVizProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    joint_states_ = node_->advertise<sensor_msgs::JointState>("joint_states", 1, true);
  }

  // A package of this name, so that RViz finds what is in it.
  void WritePackage(const std::string& name) {
    Write(name + "/package.xml",
          "<package><name>" + name +
              "</name><version>1.0.0</version><description>x</description><maintainer "
              "email='a@b.c'>a</maintainer><license>x</license></package>");
  }

  void ExpectTheSamePicture(const std::string& xml, const urdf::JointPositions& positions,
                            const Orbit& orbit) {
    const auto model = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(xml));
    ros::param::set("/robot_description", xml);
    const Process publisher({KINESCOPE_ROBOT_STATE_PUBLISHER, "__name:=robot_state_publisher"});
    Write("view.rviz", Config(model->root_link, orbit));
    const auto rviz = StartRViz();
    const Sight ours = Draw(model, positions, orbit);
    Difference best;
    // RViz does not tell when it has drawn all: it has when it agrees. What a difference costs is
    // the patience.
    const auto agrees = [&] {
      Publish(positions);
      best = Compare(ours, SightOf(Grab()));
      return best.iou() > 0.95 && best.thick == 0 && best.other_colored * 50 < best.shared;
    };
    EXPECT_TRUE(Spin(agrees)) << "IoU " << best.iou() << ", " << best.thick
                              << " px apart by more than an edge, " << best.other_colored << " of "
                              << best.shared << " px in another colour\n"
                              << testing::ReadFile(folder_ / "rviz.log");
    EXPECT_GT(best.shared, 5000) << "too little to tell";
    fmt::print("IoU {:.4f} over {} px, {} px of another tint\n", best.iou(), best.pixels,
               best.other_colored);
  }

 private:
  static std::string Config(const std::string& frame, const Orbit& orbit) {
    return fmt::format(
        R"(Panels: []
Visualization Manager:
  Class: ""
  Displays:
    - {{Class: rviz/RobotModel, Name: Robot, Enabled: true, Value: true, Alpha: 1,
       Robot Description: robot_description, Visual Enabled: true, Collision Enabled: false}}
  Enabled: true
  Global Options: {{Background Color: {}; {}; {}, Fixed Frame: {}, Frame Rate: 10}}
  Tools: [{{Class: rviz/Interact}}]
  Value: true
  Views:
    Current:
      Class: rviz/Orbit
      Name: Current View
      Target Frame: <Fixed Frame>
      Distance: {}
      Yaw: {}
      Pitch: {}
      Near Clip Distance: 0.01
      Focal Point: {{X: {}, Y: {}, Z: {}}}
      Focal Shape Fixed Size: false
      Focal Shape Size: 0.0001
    Saved: ~
Window Geometry: {{Height: {}, Width: {}, X: 0, Y: 0, Hide Left Dock: true, Hide Right Dock: true}}
)",
        kRvizBackground[0], kRvizBackground[1], kRvizBackground[2], frame, orbit.distance,
        orbit.yaw, orbit.pitch, orbit.focus.x(), orbit.focus.y(), orbit.focus.z(), kHeight, kWidth);
  }

  void Publish(const urdf::JointPositions& positions) {
    sensor_msgs::JointState message;
    message.header.stamp = ros::Time::now();
    for (const auto& [joint, position] : positions) {
      message.name.push_back(joint);
      message.position.push_back(position);
    }
    joint_states_.publish(message);
  }

  static Sight SightOf(const Pixels& pixels) {
    Sight sight;
    sight.color = pixels;
    sight.color.resize(kWidth * kHeight);
    for (const std::array<int, 3>& color : sight.color) {
      bool is_background = true;
      for (std::size_t k = 0; k < 3; ++k) {
        is_background = is_background && std::abs(color[k] - kRvizBackground[k]) <= 2;
      }
      sight.is_robot.push_back(!pixels.empty() && !is_background);
    }
    return sight;
  }

  Sight Draw(const std::shared_ptr<urdf::RobotModel>& model, const urdf::JointPositions& positions,
             const Orbit& orbit) const {
    RobotState robot;
    robot.model = model;
    robot.meshes = std::make_shared<urdf::MeshSearch>(
        urdf::MakeMeshSearch(folder_ / "r.urdf", {folder_.path().string()}));
    robot.world_from_link = urdf::PlaceLinks(*model, positions);
    SceneState without;
    without.liveness = Liveness::kLive;
    without.floor_z = -50;  // out of sight, and so is the shadow
    SceneState with = without;
    with.robots = {robot};
    render::Camera camera;
    camera.target = orbit.focus;
    camera.position =
        orbit.focus + orbit.distance * Eigen::Vector3d(std::cos(orbit.yaw) * std::cos(orbit.pitch),
                                                       std::sin(orbit.yaw) * std::cos(orbit.pitch),
                                                       std::sin(orbit.pitch));
    camera.vertical_fov_rad = kRvizFov;
    render::PictureSpec spec;
    spec.width = kWidth;
    spec.height = kHeight;
    spec.overlays = false;
    const auto renderer = render::MakeRenderer();
    const render::Image empty = renderer->Render(without, camera, spec);
    const render::Image full = renderer->Render(with, camera, spec);
    EXPECT_TRUE(renderer->problems().empty()) << renderer->problems().front();
    Sight sight;
    for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
      const std::uint8_t *a = &full.rgba[4 * i], *b = &empty.rgba[4 * i];
      sight.is_robot.push_back(!std::equal(a, a + 3, b));
      sight.color.push_back({a[0], a[1], a[2]});
    }
    return sight;
  }

  ros::Publisher joint_states_;
};

using testing::BoxDae;
using testing::BoxObj;
using testing::BoxStl;
using testing::DaeOptions;

// One link for each visual, in rows, every second one turned.
std::string Shelf(const std::vector<std::string>& visuals) {
  std::string xml =
      "<robot name='r'><material name='green'><color rgba='0.1 0.8 0.2 1'/></material>"
      "<link name='base'/>";
  for (std::size_t i = 0; i < visuals.size(); ++i) {
    xml += fmt::format(
        "<link name='l{0}'><visual>{1}</visual></link><joint name='j{0}' type='{2}'><parent "
        "link='base'/><child link='l{0}'/><origin xyz='0 {3} {4}' rpy='{5}'/><axis xyz='0.6 0 "
        "0.8'/>"
        "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>",
        i, visuals[i], i % 3 == 0 ? "revolute" : "fixed", -1.25 + 0.5 * static_cast<double>(i % 6),
        -0.6 + 0.6 * static_cast<double>(i / 6), i % 2 == 0 ? "0 0 0" : "0.3 -0.2 0.5");
  }
  return xml + "</robot>";
}

TEST_F(RViz, ShowsTheSameMeshesOfEveryFormat) {
  WritePackage("meshes");
  const auto with_nodes = [](const std::string& transform) {
    DaeOptions options;
    options.nodes =
        "<node id='a'><translate>0.5 0 0</translate><rotate>0 0 1 90</rotate><node "
        "id='b'>" +
        transform + DaeOptions().nodes + "</node></node>";
    return BoxDae(options);
  };
  DaeOptions told;
  Write("meshes/z.dae", BoxDae(told));
  told.up = "Y_UP";
  Write("meshes/y.dae", BoxDae(told));
  told.unit = "0.01";
  Write("meshes/y_cm.dae", BoxDae(told));
  told = DaeOptions();
  told.up = "X_UP";
  Write("meshes/x.dae", BoxDae(told));
  Write("meshes/nodes.dae", with_nodes("<scale>0.5 0.5 1.2</scale><translate>0 0 0.3</translate>"));
  Write("meshes/matrix.dae", with_nodes("<matrix>1 0.4 0 0 0 1 0 0 0 0 1 -0.5 0 0 0 1</matrix>"));
  Write("meshes/box.stl", BoxStl());
  Write("meshes/box.obj", BoxObj("mtllib box.mtl\n"));
  Write("meshes/box.mtl", "newmtl paint\nKd 0.9 0.6 0.1\n");
  const auto mesh = [](const std::string& file, const std::string& scale) {
    return "<geometry><mesh filename='package://meshes/" + file + "' scale='" + scale +
           "'/></geometry>";
  };
  const std::string green = "<material name='green'/>";
  const std::string plain = "0.1 0.1 0.1";
  const std::string blue = "<material name='b'><color rgba='0.1 0.2 0.9 1'/></material>";
  const std::string xml = Shelf(
      {mesh("z.dae", plain), mesh("y.dae", plain), mesh("x.dae", plain),
       mesh("y_cm.dae", "10 10 10"), mesh("nodes.dae", plain), mesh("matrix.dae", plain),
       mesh("z.dae", plain) + green, mesh("y.dae", "0.05 0.1 -0.1") + blue,
       mesh("box.stl", plain) + green, mesh("box.stl", "-0.1 0.1 0.1") + blue,
       mesh("box.stl", "0.2 0.05 0.1") + green,
       "<origin xyz='0.05 0.1 0' rpy='0.5 0.3 0.8'/>" + mesh("box.stl", "0.1 -0.1 0.05") + blue,
       mesh("box.obj", plain), mesh("box.obj", "-0.1 -0.1 -0.1") + green,
       "<geometry><box size='0.1 0.2 0.3'/></geometry>" + green,
       "<origin xyz='0 0.05 0.1' rpy='1 0.5 -0.7'/><geometry><cylinder radius='0.05' "
       "length='0.3'/></geometry>" +
           blue,
       "<geometry><sphere radius='0.12'/></geometry>" + green});
  ExpectTheSamePicture(
      xml, {{"j0", 0.4}, {"j3", -0.7}, {"j6", 0.2}, {"j9", 0.9}, {"j12", -0.3}, {"j15", 0.5}},
      {{0, 0, 0}, 3.4, 0.5, 0.35});
}

TEST_F(RViz, ShowsTheExportedPersonIdentically) {
  WritePackage("person");
  const auto result =
      testing::RunProgram({testing::KinescopePath(), "urdf", "--height", "1.75", "--package",
                           "person", "--out", (folder_ / "person").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string xml = testing::ReadFile(folder_ / "person/person.urdf");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> bend(-0.3, 0.3);
  urdf::JointPositions positions;
  for (const urdf::RobotJoint& joint : urdf::ParseUrdf(xml).joints) {
    if (joint.HasPosition()) positions[joint.name] = bend(random);
  }
  ExpectTheSamePicture(xml, positions, {{0, 0, -0.1}, 2.6, 0.6, 0.25});
}

TEST_F(RViz, IsNotStartedWithoutADisplayAndStopsWaitingQuietly) {
  const auto nowhere =
      testing::RunProgram({"/usr/bin/env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", "-u",
                           "QT_QPA_PLATFORM", testing::KinescopePath(), "rviz", "--start"});
  EXPECT_NE(nowhere.exit_code, 0);
  EXPECT_THAT(nowhere.err, HasSubstr("DISPLAY is not set"));
  const auto waiting = Start("rviz --start --node /later");
  WaitForLine(*waiting, "waiting: ");
  waiting->Signal(SIGINT);
  EXPECT_EQ(waiting->WaitForEnd(), 0);
}

// RViz 1.14 subscribes to the topic of a display that is off, and the server would render for it.
TEST_F(RViz, DoesNotAskForTheViewUnlessToldTo) {
  const auto program = Start("serve demo:n_pose --ros required --http_port 0");
  WaitForLine(*program, "page at ");
  const auto listeners = [](const std::string& topic) {
    XmlRpc::XmlRpcValue request, response, payload;
    request[0] = "/listening_test";
    if (!ros::master::execute("getSystemState", request, response, payload, false)) return 0;
    for (int i = 0; i < payload[1].size(); ++i) {
      if (static_cast<std::string>(payload[1][i][0]) == topic) return payload[1][i][1].size();
    }
    return 0;
  };
  const auto start = [&](const std::string& more) {
    EXPECT_TRUE(Spin([&] {
      const auto written =
          testing::RunProgram({"/bin/bash", "-c",
                               "exec '" + testing::KinescopePath() + "' rviz " + more + " --out '" +
                                   (folder_ / "view.rviz").string() + "'"});
      return written.exit_code == 0;
    }));
    return StartRViz("");  // a full screen hides the panel of the view, which switches it off
  };
  {
    const auto rviz = start("");
    ASSERT_TRUE(Spin([&] { return listeners("/kinescope/markers") > 0; }));
    EXPECT_EQ(listeners("/kinescope/view/image_raw"), 0);
  }
  const auto rviz = start("--view");
  EXPECT_TRUE(Spin([&] { return listeners("/kinescope/view/image_raw") > 0; }))
      << testing::ReadFile(folder_ / "rviz.log");
}

TEST_F(RViz, ShowsTheSamePublishedHumanModels) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-gazebo/humanSubject01_66dof.urdf");
  // Nearly black, which would tell nothing of colours.
  std::string xml =
      testing::ReadFile(testing::SharedData("models/human-gazebo/humanSubject01_66dof.urdf"));
  const std::string black = "rgba=\"0.1 0.1 0.1 1\"";
  ASSERT_NE(xml.find(black), std::string::npos);
  xml.replace(xml.find(black), black.size(), "rgba=\"0.2 0.4 0.9 1\"");
  std::mt19937 random(4);
  std::uniform_real_distribution<double> bend(-0.5, 0.5);
  urdf::JointPositions positions;
  for (const urdf::RobotJoint& joint : urdf::ParseUrdf(xml).joints) {
    if (joint.HasPosition()) positions[joint.name] = bend(random);
  }
  ExpectTheSamePicture(xml, positions, {{0, 0, -0.1}, 2.8, -0.7, 0.2});
}

}  // namespace
}  // namespace kinescope
