// One shown value behind number, colour and size: everything that people and programs see of a load
// says the same in every sample.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/palette.h"
#include "render/camera/camera.h"
#include "render/camera/spheres.h"
#include "server/http/api.h"
#include "server/http/protocol.h"
#include "server/loads/load_settings.h"
#include "server/picture/backend.h"
#include "server/scene/scene_reader.h"
#include "server/table/load_rows.h"
#include "tests/shared_data.h"
#ifdef KINESCOPE_WITH_ROS
#include "server/ros/joint_loads.h"
#include "server/ros/markers.h"
#endif

namespace kinescope {
namespace {

using urdf::At;

// What a sink says of one joint.
struct Said {
  LoadClass load_class = LoadClass::kUnknown;
  double shown_ratio = 0;  // NaN: it says none
};
using ByJoint = std::map<int, Said>;  // by urdf::Joint

ByJoint OfPage(const SceneState& scene) {
  const http::Bytes bytes = http::EncodeState(scene, {0, 1, {}});
  const PersonState& person = scene.people.front();
  // The loads stand before the corners, solids and objects that follow them.
  ByJoint said;
  std::size_t at = http::kStateHeaderBytes + http::kPersonHeaderBytes;
  const auto links = std::to_integer<std::size_t>(std::byte{bytes.at(http::kStateHeaderBytes + 5)});
  at += links * http::kLinkBytes;
  for (std::size_t i = 0; i < person.loads.size(); ++i, at += http::kLoadBytes) {
    float ratio = 0;
    std::memcpy(&ratio, &bytes.at(at + 16), sizeof ratio);
    said[bytes.at(at)] = {static_cast<LoadClass>(bytes.at(at + 1)), ratio};
  }
  return said;
}

ByJoint OfTable(const PersonState& person) {
  class Cells : public app::CellSink {
   public:
    Said said;
    void Number(const std::string& name, double value) override {
      if (name == "shown_ratio") said.shown_ratio = value;
    }
    void Whole(const std::string&, long long) override {}
    void Text(const std::string& name, std::string_view value) override {
      if (name != "class") return;
      for (const LoadClass each : kLoadClassesOfTables) {
        if (value == Name(each)) said.load_class = each;
      }
    }
  };
  ByJoint all;
  for (const JointLoad& load : person.loads) {
    Cells cells;
    app::VisitJoint(person, load.joint, "", app::Columns(), cells);
    all[load.joint] = cells.said;
  }
  return all;
}

ByJoint OfDetails(const SceneState& scene) {
  const auto json = nlohmann::json::parse(http::StateJson(&scene, 0));
  ByJoint said;
  for (const auto& load : json.at("people").at(0).at("loads")) {
    const std::string name = load.at("joint");
    for (const int joint : urdf::kScoredJoints) {
      if (name != urdf::kJoints[At(joint)].ros_name) continue;
      const auto& ratio = load.at("shown_ratio");
      said[joint].shown_ratio = ratio.is_null() ? std::nan("") : ratio.get<double>();
      for (const LoadClass each : kLoadClassesOfTables) {
        if (load.at("class") == Name(each)) said[joint].load_class = each;
      }
    }
  }
  return said;
}

LoadClass ClassOfColor(const Rgb& color) {
  LoadClass nearest = LoadClass::kUnknown;
  double least = 1e9;
  for (const LoadClass each : kLoadClassesOfTables) {
    double distance = 0;
    for (std::size_t i = 0; i < 3; ++i) distance += std::pow(color[i] - ColorOf(each)[i], 2);
    if (distance < least) {
      least = distance;
      nearest = each;
    }
  }
  return nearest;
}

#ifdef KINESCOPE_WITH_ROS
ByJoint OfMarkers(const PersonState& person) {
  visualization_msgs::MarkerArray message;
  ros_bridge::FillMarkers(person, ros_bridge::PersonNames("skeleton"), "world",
                          ros_bridge::MarkerFrames::kReference, 0, message);
  ByJoint said;
  for (const auto& marker : message.markers) {
    if (marker.ns != "loads") continue;
    const LoadClass by_color = ClassOfColor({marker.color.r, marker.color.g, marker.color.b});
    EXPECT_DOUBLE_EQ(marker.scale.x, 2 * SphereRadius(marker.id, by_color, *person.model))
        << "size and colour differ";
    said[marker.id] = {by_color, std::nan("")};
  }
  return said;
}

ByJoint OfTopic(const PersonState& person) {
  kinescope_ros::JointLoadArray message;
  ros_bridge::FillJointLoads(person, "world", message);
  ByJoint said;
  for (std::size_t i = 0; i < message.loads.size(); ++i) {
    said[person.loads.at(i).joint] = {static_cast<LoadClass>(message.loads[i].load_class),
                                      message.loads[i].shown_ratio};
  }
  return said;
}
#endif

// Those that stand alone in the picture from the front or from behind.
ByJoint OfPicture(const SceneState& scene, render::Renderer& renderer) {
  const render::PictureSpec view = {960, 540, 1, {}, false};
  ByJoint said;
  for (const char* name : {"front", "back"}) {
    const render::Camera camera = render::NamedCamera(name, scene);
    const render::Image image = renderer.Render(scene, camera, view);
    const auto spheres = render::LocateSpheres(scene, camera, view.width, view.height);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const render::Reading reading = render::ReadSphere(image, spheres, i);
      if (!reading.is_readable || !reading.shown) continue;  // something stands before it
      said[scene.people.front().loads.at(i).joint] = {*reading.shown, std::nan("")};
    }
  }
  return said;
}

void ExpectSame(const ByJoint& said, const PersonState& person, const std::string& sink) {
  for (const JointLoad& load : person.loads) {
    const auto found = said.find(load.joint);
    if (found == said.end()) continue;
    ASSERT_STREQ(Name(found->second.load_class), Name(load.load_class))
        << sink << ": " << urdf::kJoints[At(load.joint)].ros_name << " of sample "
        << person.sample.counter;
    if (std::isnan(found->second.shown_ratio)) continue;
    ASSERT_NEAR(found->second.shown_ratio, load.shown_ratio, 1e-6) << sink;
  }
}

// No percent outside its class by more than the hysteresis.
void ExpectRatioInItsClass(const JointLoad& load) {
  constexpr double kHysteresis = 0.05 + 1e-9;
  const double shown = load.shown_ratio;
  switch (load.load_class) {
    case LoadClass::kUnknown: ASSERT_TRUE(std::isnan(shown)); break;
    case LoadClass::kLow: ASSERT_LE(shown, kDefaultClassLimits[0] + 1e-9); break;
    case LoadClass::kMedium:
      ASSERT_GE(shown, kDefaultClassLimits[0] - kHysteresis);
      ASSERT_LE(shown, kDefaultClassLimits[1] + 1e-9);
      break;
    case LoadClass::kHigh: ASSERT_GE(shown, kDefaultClassLimits[1] - kHysteresis); break;
  }
}

struct Motion {
  std::string source;
  double rate_hz;
  double secs;
};

void ExpectSinksToAgree(const Motion& motion, bool with_pictures) {
  SCOPED_TRACE(motion.source + " at " + std::to_string(motion.rate_hz));
  app::SceneOptions options;
  options.loads.hands = loads::ParseHandLoad("both:10");
  app::SourceSettings settings;
  settings.subject_rate_hz = motion.rate_hz;
  auto reader = app::SceneReader::OfAnySource(motion.source, options, settings);
  const auto renderer = with_pictures ? app::StartRenderer({}) : nullptr;
  std::int64_t begin = 0;
  std::array<std::uint64_t, kLoadClassCount> seen{};
  for (long k = 0; const auto scene = reader.Next(); ++k) {
    if (k == 0) begin = scene->stamp_nanos;
    if (Secs(scene->stamp_nanos - begin) > motion.secs) break;
    const PersonState& person = scene->people.at(0);
    for (const JointLoad& load : person.loads) {
      ExpectRatioInItsClass(load);
      ++seen[static_cast<std::size_t>(load.load_class)];
    }
    ExpectSame(OfPage(*scene), person, "page");
    ExpectSame(OfTable(person), person, "CSV");
#ifdef KINESCOPE_WITH_ROS
    ExpectSame(OfMarkers(person), person, "RViz");
    ExpectSame(OfTopic(person), person, "topic");
#endif
    const long every = std::lround(motion.rate_hz / 2);
    if (k % every == 0) ExpectSame(OfDetails(*scene), person, "/api/v1/state");
    if (renderer && k % every == every / 2) {
      const ByJoint drawn = OfPicture(*scene, *renderer);
      EXPECT_GE(drawn.size(), 5U) << "most spheres are alone in their place";
      ExpectSame(drawn, person, "picture");
    }
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(seen[static_cast<std::size_t>(LoadClass::kHigh)] +
                seen[static_cast<std::size_t>(LoadClass::kMedium)],
            0U);
}

TEST(Sinks, AgreeOnTheClassOfEveryJointInEverySample) {
  for (const double rate_hz : {60.0, 240.0}) {
    ExpectSinksToAgree({"demo:walk", rate_hz, 4}, true);
    ExpectSinksToAgree({"demo:lift", rate_hz, 8}, true);
  }
}

TEST(Sinks, AgreeOverAMinuteOfWalkingAndLifting) {
  ExpectSinksToAgree({"demo:walk", 60, 30}, false);
  ExpectSinksToAgree({"demo:lift", 60, 30}, false);
}

TEST(Sinks, AgreeOnARealRecording) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  ExpectSinksToAgree({testing::SharedData("mvnx/test_mocap.mvnx"), 60, 60}, true);
}

}  // namespace
}  // namespace kinescope
