/// Builds scene states from samples: link poses, joint angles, CoM, CoP, loads and their classes.
/// All of them are computed only here; every sink shows the result. One thread.
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
  std::string model_name = "skeleton";  // prefix of links and joints; further people get _1, _2 ...
  urdf::BodyDescription body;
  loads::LoadSettings loads;      // with the same sex as `body`
  double height_m = 1.75;         // of the default body, until the source sends segment lengths, m
  bool height_is_assumed = true;  // the default value
  double stale_secs = 0.5;        // time without samples after which the stream is stale, s
  bool smooth_figure = true;      // meshes; false: boxes, cylinders and spheres
  std::shared_ptr<const FigureMeshes> figure_meshes;  // custom meshes; null: the built-in ones
  std::shared_ptr<const HandTools> tools;             // in the hands of all people; null: none
};

class SceneBuilder : public SampleSink {
 public:
  using OnState = std::function<void(std::shared_ptr<const SceneState>)>;

  /// `on_state` receives every new state, on the caller's thread. Start delivers the first one, "no
  /// data".
  SceneBuilder(SceneOptions options, std::string source, double nominal_rate_hz, OnState on_state);

  void Start();
  /// The body of the first person until the source sends its own segment lengths.
  std::shared_ptr<const PersonModel> InitialModel() const { return MakeModel(Person()); }
  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;

  /// Valid from the next sample on. @pre FindDefect(settings) is ""
  void SetLoads(const loads::LoadSettings& settings);
  const loads::LoadSettings& loads() const { return options_.loads; }

  /// Sets the hand load of `character` from the next sample on; overrides the settings. May be
  /// called before the character appears. @pre loads::FindDefect(load) is ""
  void SetHandLoad(int character, const HandLoad& load);

  /// Sets the measured forces of `character`. Stamps are on the clock of the samples; expired
  /// measurements are ignored. May be called before the character appears.
  void SetMeasurements(int character, const loads::Measurements& measured);

  /// Sets the external markers from the next sample on; at once while no samples arrive.
  void SetMarkers(std::vector<std::shared_ptr<const SceneMarker>> markers);

  /// Call it at least every 0.1 s with the monotonic clock while a live source is read: it detects
  /// that no samples arrive.
  void Tick(std::int64_t monotonic_nanos);

  /// Publishes the newest state as stale, as Tick does when the stream has stopped.
  void MarkStale();

 private:
  struct Person {
    Character character;
    std::size_t index = 0;  // in the order of appearance
    std::shared_ptr<const PersonModel> model;
    urdf::JointAngles angles{};
    urdf::RigidDeviation worst_deviation;
    bool l5_is_checked = false;                    // against the first pose; see CheckL5
    std::optional<Eigen::Vector3d> l5_from_poses;  // m, in the pelvis' link frame
    WornExtras worn;
    loads::LoadEstimator loads;
    loads::Exposure exposure;
    bool has_legs = true;              // false: recorded without leg sensors
    std::optional<double> floor_z;     // m; set with the first sample
    std::optional<PersonState> state;  // of the newest sample
  };

  struct Held {
    HandLoad load;
    std::int64_t told_nanos = 0;  // stamp of the newest sample when it was set
  };

  Person& AddPerson(const Character& character);  // a character without samples before
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
  std::map<int, Person> people_;                 // by character id; bounded by the source
  std::map<int, loads::Measurements> measured_;  // by character id; bounded by the source
  std::map<int, Held> held_;  // hand loads that were set, by character id; bounded by the source
  std::map<int, Character> clusters_;  // groups of tracked objects, by character id; bounded by the
                                       // source
  std::map<int, std::vector<TrackedObject>> objects_;  // of the newest sample of each group
  SceneState current_;                                 // without its people, which Publish adds
  std::int64_t rate_window_start_ = 0;                 // monotonic clock
  int rate_window_samples_ = 0;
  int rate_character_ = 0;  // the character whose samples are counted
};

}  // namespace kinescope::app
