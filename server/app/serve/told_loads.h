/// Forces from outside on their way to the scene builder. Whoever is told what a hand holds (the
/// page's thread, ROS) says it here, any thread; the thread that reads samples hands it on before
/// the next sample, so that one thread alone touches the builder.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/force_inputs.h"
#include "core/source.h"
#include "server/app/serve/view_loop.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class ToldLoads {
 public:
  /// "", or what is wrong with the load, which then changes nothing. Any thread.
  [[nodiscard]] std::string Tell(int character, const HandLoad& load);

  /// All that was told since the last call, by character.
  [[nodiscard]] std::map<int, HandLoad> Take();

 private:
  std::mutex mutex_;
  std::map<int, HandLoad> told_;  // guarded by mutex_; bounded: callers know who is there
};

/// Passes samples on to `builder`, each after everything that was told or measured before it. The
/// reading thread's. `ros` may be null.
class InputsFirst : public SampleSink, private ros_bridge::InputSink {
 public:
  /// `view` may be null, and is told who listens to it.
  InputsFirst(SceneBuilder& builder, ToldLoads& told, ros_bridge::RosBridge* ros,
              ViewLoop* view = nullptr)
      : builder_(builder), told_(told), ros_(ros), view_(view) {}

  /// Also to be called while no samples come: services wait for their answer.
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
  ViewLoop* const view_;
};

}  // namespace kinescope::app
