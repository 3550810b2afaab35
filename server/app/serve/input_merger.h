/// Passes samples on to the scene builder and applies all other inputs before each of them: hand
/// loads, measurements and markers. Reading thread only.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/source.h"
#include "server/app/serve/hand_load_mailbox.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class InputMerger : public SampleSink, private ros_bridge::InputSink {
 public:
  /// Receives the number of subscribers of the ROS camera when it changes.
  using OnSubscribers = std::function<void(int count)>;

  /// `ros` and `on_subscribers` may be null.
  InputMerger(SceneBuilder& builder, HandLoadMailbox& hand_loads, ros_bridge::RosBridge* ros,
              OnSubscribers on_subscribers = nullptr)
      : builder_(builder),
        hand_loads_(hand_loads),
        ros_(ros),
        on_subscribers_(std::move(on_subscribers)) {}

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
  HandLoadMailbox& hand_loads_;
  ros_bridge::RosBridge* const ros_;
  const OnSubscribers on_subscribers_;
};

}  // namespace kinescope::app
