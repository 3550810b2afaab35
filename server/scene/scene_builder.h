/// Samples -> scene states: poses in link frames, joint angles, CoM, CoP, loads and their classes.
/// The one place where these are computed; every sink shows what comes out of here. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "core/source.h"
#include "server/body/figure_meshes.h"
#include "server/body/hand_tools.h"
#include "server/body/worn_extras.h"
#include "server/loads/exposure.h"
#include "server/loads/load_estimator.h"

namespace kinescope::app {

struct SceneOptions {
  std::string model_name =
      "skeleton";  // prefix of links and joints; a second person gets _1, _2 ...
  urdf::BodyDescription body;
  loads::LoadSettings loads;      // whose sex is that of `body`
  double height_m = 1.75;         // of the default body, until the source tells its own
  bool height_is_assumed = true;  // nobody said it
  double stale_secs = 0.5;        // this long without a sample is stale
  bool smooth_figure = true;      // mesh files; false: boxes, cylinders and spheres
  std::shared_ptr<const FigureMeshes> figure_meshes;  // instead of ours; null: ours
  std::shared_ptr<const HandTools> tools;             // in everybody's hands; null: none
};

class SceneBuilder : public SampleSink {
 public:
  using OnState = std::function<void(std::shared_ptr<const SceneState>)>;

  /// `on_state` gets every new state, on the caller's thread. The first one, "no data", comes from
  /// Start.
  SceneBuilder(SceneOptions options, std::string source, double nominal_rate_hz, OnState on_state);

  void Start();
  /// The body that the first person has until the source tells its own.
  std::shared_ptr<const PersonModel> InitialModel() const { return MakeModel(Person()); }
  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;

  /// From the next sample on. @pre FindDefect(settings) is ""
  void SetLoads(const loads::LoadSettings& settings);
  const loads::LoadSettings& loads() const { return options_.loads; }

  /// What `character` holds, instead of what the settings say; from the next sample on. Kept for a
  /// character who has not come yet. @pre loads::FindDefect(load) is ""
  void SetHandLoad(int character, const HandLoad& load);

  /// What sensors say about `character`, with stamps of the samples' clock; what is old is let go
  /// by itself. Kept for a character who has not come yet.
  void SetMeasurements(int character, const loads::Measurements& measured);

  /// What other programs want to be seen, from the next sample on; at once while none come.
  void SetMarkers(std::vector<std::shared_ptr<const SceneMarker>> markers);

  /// Call at least every 0.1 s with the monotonic clock while a live source is read: this is what
  /// notices that nothing comes any more.
  void Tick(std::int64_t monotonic_nanos);

  /// As Tick does when the stream has stopped.
  void MarkStale();

 private:
  struct Person {
    Character character;
    std::size_t index = 0;  // in the order of appearance
    std::shared_ptr<const PersonModel> model;
    urdf::JointAngles angles{};
    urdf::RigidDeviation worst_deviation;
    bool l5_is_checked = false;                    // against the first pose, see CheckL5
    std::optional<Eigen::Vector3d> l5_from_poses;  // in the pelvis' link frame
    WornExtras worn;
    loads::LoadEstimator loads;
    loads::Exposure exposure;
    bool has_legs = true;              // false: recorded without leg sensors
    std::optional<double> floor_z;     // known since the first sample
    std::optional<PersonState> state;  // of the newest sample
  };

  struct Held {
    HandLoad load;
    std::int64_t told_nanos = 0;  // stamp of the newest sample then
  };

  Person& AddPerson(const Character& character);  // who is not there yet
  void LetGoOfStoppedHands(int character);
  std::shared_ptr<const PersonModel> MakeModel(const Person& person) const;
  static bool CheckL5(const BodySample& sample, Person& person);
  PersonState StateOf(Person& person, const BodySample& sample) const;
  void Publish(Liveness liveness);
  void MeasureRate(const BodySample& sample);

  SceneOptions options_;
  std::string source_;
  double nominal_rate_hz_;
  OnState on_state_;
  std::map<int, Person> people_;                       // by character id; bounded by the source
  std::map<int, loads::Measurements> measured_;        // likewise
  std::map<int, Held> held_;                           // likewise, by who was told to hold what
  std::map<int, Character> clusters_;                  // of tracked objects, likewise
  std::map<int, std::vector<TrackedObject>> objects_;  // of the newest sample of each cluster
  SceneState current_;                                 // without its people: Publish adds those
  std::int64_t rate_window_start_ = 0;                 // monotonic
  int rate_window_samples_ = 0;
  int rate_character_ = 0;  // whose samples are counted
};

}  // namespace kinescope::app
