/// The parameters that this node sets at a master for others: the URDF of each person, and what it
/// publishes (running.h). Used by one thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/ros/bridge.h"
#include "server/ros/master_client.h"
#include "server/ros/running.h"

namespace kinescope::ros_bridge {

class DescriptionParameters {
 public:
  /// By prefix: "" is the first person, "<model>/" another one.
  using Models = std::map<std::string, std::shared_ptr<const PersonModel>>;

  /// `config` and `master` must outlive it.
  DescriptionParameters(const BridgeConfig& config, MasterClient& master)
      : config_(config), master_(master) {}

  /// The master knows none of them any more.
  void Forget();

  /// Sets those that have changed. Stops at the first that the master does not accept; the rest is
  /// tried again next time. Without a person so far that of config.initial_model is set.
  void Set(const Models& models, bool has_met_nobody);

 private:
  struct Description {
    std::uint64_t revision = 0;              // 0: of the initial model
    std::int64_t set_nanos = 0;              // monotonic clock
    std::shared_ptr<const MeshFiles> files;  // RViz reads them whenever it likes
  };

  bool IsOthers(const std::string& parameter, bool& answers);
  static std::string OwnerOf(const std::string& parameter);
  static std::vector<RunningNode> OtherNodes();
  std::optional<std::string> DescriptionOf(const std::string& prefix);
  std::string UrdfOf(const PersonModel& model) const;
  void TellWhatIsPublished(const std::map<std::string, std::string>& models);
  void WarnOfTheSameFrames(const std::map<std::string, std::string>& models);

  const BridgeConfig& config_;
  MasterClient& master_;
  std::map<std::string, std::string> names_;      // of the parameters, by prefix, at this master
  std::map<std::string, Description> described_;  // by name of the parameter
  std::set<std::string> twins_;  // nodes with the same frames, of which it was warned
  std::string told_;             // content of `~published` at this master
};

}  // namespace kinescope::ros_bridge
