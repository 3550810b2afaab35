/// What the panel of controls shows, and its JSON (docs/http.md). Values and pure functions, any
/// thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/force_inputs.h"
#include "core/person_change.h"
#include "core/scene_state.h"
#include "server/app/serve/workshop.h"
#include "server/recording/folder.h"
#include "server/recording/raw_recorder.h"
#include "server/recording/trial.h"

namespace kinescope::app {

/// The load that a person holds, and since when.
struct HeldLoad {
  HandLoad load;
  std::int64_t since_micros = 0;  // wall clock
  std::string by;                 // "operator", "ROS", "option", "bridge"
};

struct ControlStatus {
  std::string why_no_recording, why_no_clips, why_no_trials;  // "": possible
  recording::RawRecorder::Status recording;
  std::optional<std::uintmax_t> free_bytes;  // of the disk, without what is kept for marks
  std::optional<recording::Trial> trial;     // that runs
  std::vector<Workshop::Job> jobs;
  std::shared_ptr<const SceneState> state;             // null: none yet
  std::map<int, PersonChange> stated;                  // by character
  std::map<int, HeldLoad> held;                        // by character
  HeldLoad first_held;                                 // of the others
  bool mass_is_option = false, sex_is_option = false;  // of this server
  std::array<double, 2> class_limits = kDefaultClassLimits;
  bool class_limits_are_set = false;  // by an operator
  std::uint64_t files_revision = 0;
};

std::string ToJson(const ControlStatus& status);

/// Of /api/v1/files. `folder`: "" leaves it out. `run_micros`: of the trials whose moments may be
/// kept.
std::string FilesToJson(const std::string& folder, std::uint64_t revision, std::int64_t run_micros,
                        const std::vector<recording::FileEntry>& files,
                        const std::vector<recording::Trial>& trials);

/// "5 kg right, 2 kg left", "empty", "unknown".
std::string TextOf(const HandLoad& load);

}  // namespace kinescope::app
