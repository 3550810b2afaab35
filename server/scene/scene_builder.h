/// Builds scene states from samples: tracks each person (person_tracker.h) and tracked object,
/// merges in measurements and hand loads, and publishes one state per sample. Everything about the
/// people is computed here, and only here; every sink shows the result. Writes no files. One
/// thread.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "core/scene_extent.h"
#include "core/scene_state.h"
#include "core/source.h"
#include "server/loads/load_settings.h"
#include "server/scene/held_heading.h"
#include "server/scene/model_factory.h"
#include "server/scene/model_maker.h"
#include "server/scene/person_tracker.h"
#include "server/scene/plausible_places.h"
#include "server/scene/rate_meter.h"
#include "server/scene/recorded_forces.h"
#include "server/scene/sample_smoother.h"
#include "server/wrenches/wrench_reader.h"

namespace kinescope::app {

/// To see what depends on it: of people about whom the node of their suit was told something.
struct Supposed {
  double mass_factor = 1, hand_load_factor = 1;  // of what was told
  HandLoad hand_load;                            // where nothing was told
};

struct SceneOptions : ModelSettings {
  loads::LoadSettings loads;      // with the same sex as `body`
  double stale_secs = 0.5;        // time without samples after which the stream is stale, s
  std::optional<double> floor_z;  // of the floor, world, m; absent: it is found
  Supposed supposed;
  GraphView bag;  // what SceneReader shows of a bag
  /// Of SceneState::camera_base, unless OnSurroundings() or SetCameraBase() place it: a link of a
  /// person, "skeleton_pelvis".
  CameraFrames camera_frame;
  /// Measured forces of a recording, on the first person; in place of SetMeasurements().
  std::optional<wrenches::WrenchSettings> wrenches;
  /// Changed bodies are made on a thread of their own and used when they are ready, so that they
  /// never delay a live stream. Otherwise states depend only on the samples.
  bool makes_models_aside = false;
  /// Of SceneState::view_heading.
  CameraFrame view_frame = CameraFrame::kWorld;
};

class SceneBuilder : public SampleSink, public SmoothSampleSink {
 public:
  using OnState = std::function<void(std::shared_ptr<SceneState>)>;

  /// `on_state` receives every new state, on the caller's thread, and is the first to have it: it
  /// may complete it. Start delivers the first one, "no
  /// data". @throws SourceError, UsageError if the file of measured forces is refused
  SceneBuilder(SceneOptions options, std::string source, double nominal_rate_hz, OnState on_state);

  ~SceneBuilder() override;
  SceneBuilder(const SceneBuilder&) = delete;
  SceneBuilder& operator=(const SceneBuilder&) = delete;

  void Start();
  /// The body of the first person until the source sends its own segment lengths.
  std::shared_ptr<const PersonModel> InitialModel() const { return models_.Make({}, 1); }
  void OnCharacter(const Character& character) override;
  /// Of a stream: its motion is filtered with the samples so far.
  void OnSample(const BodySample& sample) override { OnSample(sample, nullptr); }
  /// Of a recording: `motion` is filtered without lag; null: as of a stream.
  void OnSample(const BodySample& sample, const loads::BodyMotion* motion) override;
  void OnObjects(const ObjectsSample& sample) override;
  void OnSurroundings(const RecordedSurroundings& all) override;
  /// Ignored once a person has come. A live source has no moment before there is something to show.
  void OnMoment(const SourceMoment& moment) override;

  /// Valid from the next sample on. @pre FindDefect(settings) is ""
  void SetLoads(const loads::LoadSettings& settings);
  const loads::LoadSettings& loads() const { return options_.loads; }

  /// Sets the hand load of `character` from the next sample on; overrides the settings. May be
  /// called before the character appears. @pre loads::FindDefect(load) is ""
  void SetHandLoad(int character, const HandLoad& load);

  /// What `change` sets holds for `character` from the next samples on: its model is made first.
  /// May be called before the character appears. @pre FindDefect(change) is ""
  void ChangePerson(int character, const PersonChange& change);

  /// Sets the measured forces of `character`. Stamps are on the clock of the samples; expired
  /// measurements are ignored. May be called before the character appears.
  void SetMeasurements(int character, const loads::Measurements& measured);

  /// Robots whose lowest points are on z = 0: they stand on the floor from the next state on.
  void SetRobots(std::vector<RobotState> robots);

  /// Sets the markers of other nodes, beside those of the recording, from the next sample on; at
  /// once while no samples arrive.
  void SetMarkers(MarkerList markers);

  /// Sets the pictures of cameras of other nodes, beside those of the recording, from the next
  /// sample on.
  void SetImages(ImageList images);

  /// Sets the robots that other nodes move, in the world frame; as SetMarkers().
  void SetMovingRobots(RobotList robots);

  /// Sets where the frame is that the camera goes with, in place of that of the recording; as
  /// SetMarkers().
  void SetCameraBase(const urdf::Pose& pose);

  /// How long the next samples waited in this machine before they were processed, ns; part of the
  /// states.
  void SetWaited(std::int64_t nanos) { waited_nanos_ = nanos; }

  /// Nothing waits any more: what is shown is the newest. A state that said it was late is made
  /// anew.
  void OnCaughtUp();

  /// Call it at least every 0.1 s with the monotonic clock while a live source is read: it detects
  /// that no samples arrive.
  void Tick(std::int64_t monotonic_nanos);

  /// Publishes the newest state as stale, as Tick does when the stream has stopped.
  void MarkStale();

 private:
  /// What was set for one person beside the samples.
  struct PersonInputs {
    std::optional<HandLoad> hand_load;  // overrides the settings
    std::int64_t hand_load_nanos = 0;   // stamp of the newest sample when it was set
    loads::Measurements measured;
    PersonChange stated;
  };

  PersonTracker& TrackerOf(int id);
  PersonChange StatedOf(int id) const;
  HandLoad ToldHandLoadOf(int id) const;
  void ReplaceImpossible(const Character& before, Character& character);
  bool IsPlausible(const BodySample& sample);
  void TakeTime(const BodySample& sample);
  bool IsWithin(std::int64_t nanos, std::int64_t moment) const;
  /// Null: has no state yet, or sent nothing for so long that the person has left.
  const PersonState* StateOfPresent(const PersonTracker& person) const;
  void ForgetThoseGone();
  static void ForgetStoppedHands(PersonInputs& inputs);
  void Publish(Liveness liveness);
  void PublishIfIdle();
  void FollowExtent();
  bool HasSurroundings() const;
  void PlaceMarkers();
  void PlaceImages();
  void PlaceRobots();
  void PlaceCamera(SceneState& scene);
  void WarnOfCamera() const;

  struct TrackedGroup {
    std::vector<TrackedObject> objects;
    std::int64_t moment = 0;  // MomentOf its sample
  };
  struct LeftOut {
    PlausiblePlaces::Doubt doubt;
    std::int64_t moment = 0;  // MomentOf its sample
  };

  SceneOptions options_;
  const ModelFactory models_;
  std::unique_ptr<ModelMaker> maker_;  // null: models are made at once
  std::string source_;
  OnState on_state_;
  std::optional<RecordedForces> recorded_forces_;
  PlausiblePlaces places_;
  // By character id, of which a source has a few hundred at most:
  std::map<int, PersonTracker> people_;      // with a sample in the last minute
  std::map<int, PersonTracker::Past> past_;  // of all people so far
  std::map<int, Character> characters_;      // as the source described them; people and groups of
                                             // tracked objects
  std::map<int, PersonInputs> inputs_;
  std::map<int, LeftOut> left_out_;        // now
  std::set<int> left_out_once_;            // said once
  std::set<std::string> impossible_once_;  // of what another node was told; the same
  std::map<int, TrackedGroup> objects_;    // of the newest sample of each group
  std::int64_t waited_nanos_ = 0;          // see SetWaited()
  HeldHeading view_heading_;
  HeldExtent extent_;
  std::int64_t extent_nanos_ = 0;  // stamp of the state when it was looked at last
  std::int64_t time_origin_ = 0;   // stamp at which the time code is 0; 0: not known yet
  RateMeter rate_;
  SceneState current_;  // without its people, which Publish adds
  RecordedSurroundings recorded_;
  std::optional<std::int64_t> camera_since_nanos_;  // stamp of the first state without its frame
  bool misses_camera_ = false;                      // that was told
  MarkerList node_markers_;
  ImageList node_images_;
  RobotList node_robots_;
  std::vector<RobotState> robots_;  // on z = 0
  double robots_floor_z_ = 0;       // where those of current_ stand
};

}  // namespace kinescope::app
