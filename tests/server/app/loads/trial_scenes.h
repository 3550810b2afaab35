/// Scenes for what writes loads down: of the built-in subject, through the real pipeline, and by
/// hand with loads of our choice.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/system/clocks.h"
#include "server/app/loads/load_trial.h"
#include "server/loads/joint_score.h"
#include "server/scene/scene_reader.h"

namespace kinescope::testing {

using Scenes = std::vector<std::shared_ptr<const SceneState>>;

/// The first `secs` seconds of `source`, both ends included.
inline Scenes ReadScenes(const std::string& source, double secs, const app::SceneOptions& options) {
  constexpr double kRounding = 1e-6;  // s, of stamps
  app::SceneReader reader(source, options);
  Scenes scenes;
  while (auto scene = reader.Next()) {
    const std::int64_t begin = scenes.empty() ? scene->stamp_nanos : scenes.front()->stamp_nanos;
    if (Secs(scene->stamp_nanos - begin) > secs + kRounding) break;
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

/// A quarter of a second of demo:lift with 5 kg in the right hand; without mesh files.
inline const Scenes& ShortLift() {
  static const Scenes scenes = [] {
    app::SceneOptions options;
    options.loads.hands.is_known = true;
    options.loads.hands.mass_kg[urdf::kRight] = 5;
    return ReadScenes("demo:lift", 0.25, options);
  }();
  return scenes;
}

/// One person, all of whose ratios are `ratio`; NaN: unknown because of `why`.
inline SceneState SceneWithRatio(double secs, double ratio, std::string_view why = "") {
  SceneState scene;
  scene.stamp_nanos = std::llround(secs * 1e9);
  PersonState person;
  person.model = std::make_shared<PersonModel>();
  person.sample.stamp_nanos = scene.stamp_nanos;
  for (const int joint : urdf::kScoredJoints) {
    JointLoad load;
    load.joint = joint;
    load.ratio = load.shown_ratio = ratio;
    load.load_class = load.band = loads::BandOf(ratio, kDefaultClassLimits);
    load.reason = why;
    person.loads.push_back(load);
  }
  scene.people.push_back(person);
  return scene;
}

/// The next sample of the scene's first person.
inline void AddTo(app::LoadTrial& trial, SceneState scene) {
  const auto shared = std::make_shared<const SceneState>(std::move(scene));
  trial.Add(shared, shared->people[0]);
}

/// A known answer: of 100 samples at 10 Hz, the right knee has 50 at 0.2, 30 at 0.5, 15 at 0.9 and
/// 5 unknown, in this order; all other joints have 0.1. Compression `newtons`, at most in
/// sample 70.
inline app::LoadTrial CountedTrial(double newtons = 2000, bool has_names = true) {
  constexpr std::size_t kRightKnee = 11;
  app::LoadTrial trial(true, 0);
  for (int i = 0; i < 100; ++i) {
    const bool is_known = i < 95;
    const double ratio = i < 50 ? 0.2 : i < 80 ? 0.5 : is_known ? 0.9 : std::nan("");
    SceneState scene = SceneWithRatio(0.1 * i, 0.1);
    PersonState& person = scene.people[0];
    if (has_names) person.name = "Anna";
    JointLoad& knee = person.loads[kRightKnee];
    knee.ratio = knee.shown_ratio = ratio;
    knee.load_class = knee.band = loads::BandOf(ratio, kDefaultClassLimits);
    if (!is_known) knee.reason = "no foot contact";
    for (JointLoad& load : person.loads) {
      load.channel = "flexion";
      load.deciding_moment = -100 * load.ratio;
      load.capacity = 100;
    }
    person.forces.is_dynamic = person.forces.is_zero_phase = true;
    person.forces.lumbar = LumbarLoad{i == 70 ? newtons : 0.5 * newtons, 0};
    AddTo(trial, scene);
  }
  trial.Finish();
  return trial;
}

/// A trial that keeps its curves, of all that is in `scenes`.
inline app::LoadTrial TrialOf(const Scenes& scenes) {
  app::LoadTrial trial(true, scenes.front()->stamp_nanos);
  for (const auto& scene : scenes) trial.Add(scene, scene->people[0]);
  trial.Finish();
  return trial;
}

}  // namespace kinescope::testing
