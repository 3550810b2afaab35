/// Queues hand loads for the scene builder. Any thread may add them (HTTP, ROS). The reading thread
/// applies them before the next sample, so only that thread uses the builder.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/force_inputs.h"
#include "core/source.h"
#include "server/app/serve/ros_camera_loop.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class ToldLoads {
 public:
  /// Adds a hand load. Returns "", or why it was rejected. Any thread.
  [[nodiscard]] std::string Tell(int character, const HandLoad& load);

  /// All hand loads since the last call, by character. Any thread.
  [[nodiscard]] std::map<int, HandLoad> Take();

 private:
  std::mutex mutex_;
  std::map<int, HandLoad> told_;  // guarded by mutex_; bounded: callers pass existing characters
                                  // only
};

/// Passes samples on to `builder`, after applying all earlier hand loads and measurements. Reading
/// thread only. `ros` may be null.
class InputsFirst : public SampleSink, private ros_bridge::InputSink {
 public:
  /// `view` may be null; it receives the number of its subscribers.
  InputsFirst(SceneBuilder& builder, ToldLoads& told, ros_bridge::RosBridge* ros,
              RosCameraLoop* view = nullptr)
      : builder_(builder), told_(told), ros_(ros), view_(view) {}

  /// Call it also while no samples arrive, because ROS services wait for their answer.
  void TakeInputs();

  void OnCharacter(const Character& character) override { builder_.OnCharacter(character); }
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override { builder_.OnObjects(sample); }

 private:
  void OnHandLoad(int character, const HandLoad& load) override;
  void OnMeasurements(int character, const Measurements& measured) override;
  void OnMarkers(const std::vector<std::shared_ptr<const SceneMarker>>& markers) override;
  void OnViewListeners(int count) override;

  SceneBuilder& builder_;
  ToldLoads& told_;
  ros_bridge::RosBridge* const ros_;
  RosCameraLoop* const view_;
};

}  // namespace kinescope::app
