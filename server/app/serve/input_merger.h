/// Passes samples on to the scene builder and applies all other inputs before each of them: hand
/// loads, measurements and markers. Reading thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/source.h"
#include "core/system/clocks.h"
#include "server/app/serve/change_mailbox.h"
#include "server/app/serve/hand_load_mailbox.h"
#include "server/app/serve/overload.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class InputMerger : public SampleSink, private ros_bridge::InputSink {
 public:
  /// Receives the number of subscribers of the ROS camera when it changes.
  using OnSubscribers = std::function<void(int count)>;
  /// Receives the texts of `~mark`.
  using OnText = std::function<void(const std::string& text)>;

  /// Receives the hand loads that came over ROS.
  using OnRosHandLoad = std::function<void(int character, const HandLoad& load)>;
  using Clock = std::function<std::int64_t()>;

  /// `ros`, `changes` and the functions may be null, but for `now`: the clock of the source.
  InputMerger(SceneBuilder& builder, Overload& overload, HandLoadMailbox& hand_loads,
              ros_bridge::RosBridge* ros, OnSubscribers on_subscribers = nullptr,
              ChangeMailbox* changes = nullptr, OnRosHandLoad on_hand_load = nullptr,
              OnText on_mark = nullptr, Clock now = MonotonicNanos)
      : builder_(builder),
        overload_(overload),
        hand_loads_(hand_loads),
        ros_(ros),
        on_subscribers_(std::move(on_subscribers)),
        changes_(changes),
        on_hand_load_(std::move(on_hand_load)),
        on_mark_(std::move(on_mark)),
        now_(std::move(now)) {}

  /// Call it also while no samples arrive, because ROS services wait for their answer.
  void TakeInputs();

  /// Call it after each Poll. If it had no sample, none waits any more: those that were skipped to
  /// catch up are the newest, and are shown.
  void AfterPoll();

  void OnCharacter(const Character& character) override { builder_.OnCharacter(character); }
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override { builder_.OnObjects(sample); }
  void OnSurroundings(const RecordedSurroundings& all) override { builder_.OnSurroundings(all); }
  void OnMoment(const SourceMoment& moment) override { builder_.OnMoment(moment); }

 private:
  void OnHandLoad(int character, const HandLoad& load) override;
  void OnMeasurements(int character, const Measurements& measured) override;
  void OnMarkers(const MarkerList& markers) override { builder_.SetMarkers(markers); }
  void OnImages(const ImageList& images) override { builder_.SetImages(images); }
  void OnRobots(const RobotList& robots) override { builder_.SetMovingRobots(robots); }
  void OnCameraBase(const urdf::Pose& pose) override { builder_.SetCameraBase(pose); }
  void OnViewListeners(int count) override;
  void OnMark(const std::string& text) override;
  void Process(const BodySample& sample, std::int64_t waited_nanos);

  SceneBuilder& builder_;
  Overload& overload_;
  HandLoadMailbox& hand_loads_;
  ros_bridge::RosBridge* const ros_;
  const OnSubscribers on_subscribers_;
  ChangeMailbox* const changes_;
  const OnRosHandLoad on_hand_load_;
  const OnText on_mark_;
  const Clock now_;
  bool has_samples_ = false;           // since the last AfterPoll
  std::map<int, BodySample> skipped_;  // the newest of each character, if it was skipped
};

}  // namespace kinescope::app
