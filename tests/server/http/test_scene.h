/// A person who moves, with loads of every class: made from the default skeleton, a smooth function
/// of time, the same each time it is asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/http/server.h"

namespace kinescope::http::testing {

/// `mesh_folder`: as HumanModel's; the page gets the files that are there.
std::shared_ptr<const PersonModel> MakePersonModel(std::uint64_t revision = 1,
                                                   const std::string& mesh_folder = "");

/// A live state at `seconds`, with `people` persons side by side. stamp, counter and time code
/// follow from `seconds` at 60 samples a second; arrival is `arrival_nanos`.
SceneState MakeScene(std::uint64_t number, double seconds, std::int64_t arrival_nanos,
                     const std::shared_ptr<const PersonModel>& model, int people = 1);

inline constexpr char kOperatorToken[] = "0perator-of-the-lab",
                      kViewerToken[] = "v1ewer-of-the-lab";

/// The names of render/camera/camera.h, with numbers like its own.
std::vector<CameraView> MakeCameras();
CameraFraming MakeFraming();

}  // namespace kinescope::http::testing
