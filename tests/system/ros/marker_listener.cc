// The bridge as `kinescope serve --marker_topics` has it, which says on its standard output what is
// in the scene: a line `<n> markers` and one for each, whenever that changes. A person stands
// there, whose pelvis is told by lines on the standard input: `x y z`.
//   marker_listener /topic[,/topic][,tf:frame]
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "core/system/starts_with.h"
#include "server/options/text.h"
#include "server/ros/bridge.h"
#include "tests/server/ros/test_person.h"

namespace kinescope {
namespace {

class Printer : public ros_bridge::InputSink {
 public:
  void OnHandLoad(int, const HandLoad&) override {}
  void OnMeasurements(int, const Measurements&) override {}
  void OnMarkers(const std::vector<std::shared_ptr<const SceneMarker>>& markers) override {
    fmt::print("{} markers", markers.size());
    for (const auto& marker : markers) {
      const Eigen::Vector3d& at = marker->pose.position;
      fmt::print("; {} {} at {:.3f} {:.3f} {:.3f}", Name(marker->type), IdentityOf(*marker), at.x(),
                 at.y(), at.z());
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
};

// False at the end of the input.
bool TakeLine(ros_bridge::RosBridge& bridge, SceneState& scene) {
  Eigen::Vector3d pelvis;
  if (!(std::cin >> pelvis.x() >> pelvis.y() >> pelvis.z())) return false;
  ++scene.number;
  scene.stamp_nanos += 1'000'000;
  scene.liveness = Liveness::kLive;
  const auto model = testing::MakeModel();
  scene.people = {testing::MakePerson(model, testing::Posture(0),
                                      static_cast<std::uint32_t>(scene.number), scene.stamp_nanos)};
  scene.people[0].links[urdf::kPelvis].position = pelvis;
  bridge.Publish(scene);
  return true;
}

void Listen(const std::string& topics) {
  ros_bridge::BridgeConfig config;
  for (const std::string& name : options::SplitItems(topics)) {
    const bool is_frame = StartsWith(name, "tf:");
    config.shown.topics.push_back({is_frame ? name.substr(3) : name, {}, is_frame});
  }
  const auto bridge = ros_bridge::MakeRosBridge(config, ros_bridge::RosMode::kRequired);
  Printer printer;
  SceneState scene;
  scene.stamp_nanos = 1'700'000'000'000'000'000;
  fmt::print("listening\n");
  std::fflush(stdout);
  while (true) {
    pollfd input = {STDIN_FILENO, POLLIN, 0};
    poll(&input, 1, 10);
    if (input.revents != 0 && !TakeLine(*bridge, scene)) break;
    bridge->TakeInputs(printer);
  }
  for (const auto& [topic, counters] : bridge->status().inputs) {
    if (topic.front() != '/') continue;
    fmt::print("{}: {} received, {} used, '{}'\n", topic, counters.received, counters.used,
               counters.last_problem);
  }
}

}  // namespace
}  // namespace kinescope

int main(int argc, char** argv) {
  kinescope::ros_bridge::TakeRosArguments(argc, argv, "marker_listener");
  if (argc != 2) return 2;
  kinescope::Listen(argv[1]);
}
