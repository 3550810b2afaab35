/// Writes the JSON of the server (docs/http.md) from SceneState. Pure functions, any thread.
/// Metres, kilograms, N·m, world frame with z up; quaternions are [x, y, z, w]. Invalid UTF-8 is
/// replaced, never rejected. `state` may be null: nothing was published yet.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/http/server.h"

namespace kinescope::http {

/// /api/v1/state: the newest state without poses. `now_nanos`: current time of the monotonic clock,
/// for the age.
std::string StateJson(const SceneState* state, std::int64_t now_nanos);

/// /api/v1/model: the data needed to render each person at the streamed link poses, and the names
/// and colours that the page shows. Skins and meshes are given by their URL on this server. A skin
/// has no parts but what the person holds and wears.
std::string ModelJson(const SceneState* state, const PageLook& look);

/// /api/v1/cameras.
std::string CamerasJson(const std::vector<CameraView>& cameras, const CameraFraming& framing,
                        const std::string& live_camera, bool has_pictures);

/// What does not belong to a state.
struct DetailsExtras {
  std::shared_ptr<const Playback> playback;     // null: the stream is live
  std::optional<std::uint64_t> marks_revision;  // nullopt: nothing can be marked
  std::optional<std::uint64_t> surroundings;    // their revision; nullopt: none
};

/// The WebSocket message "details": texts and values that change seldom. Equal inputs give equal
/// text.
std::string DetailsJson(const SceneState* state, const std::string& live_camera, bool has_pictures,
                        const DetailsExtras& extras = {});

/// The person's model for /api/v1/skin/{person}/{revision}. Null unless the revision is the current
/// one and the model has a skin.
std::shared_ptr<const PersonModel> FindModelWithSkin(const SceneState* state, int character,
                                                     std::uint64_t revision);

/// The person's newest revision, if it is later: of a client that asks for what it was told before
/// a change.
std::optional<std::uint64_t> LaterRevision(const SceneState* state, int character,
                                           std::uint64_t revision);

/// The STL file for /api/v1/mesh/{person}/{revision}/{number}: the n-th mesh visual of that
/// person's model, from memory. Null unless it is one of the model's own meshes and the revision is
/// the current one.
std::shared_ptr<const std::string> FindMesh(const SceneState* state, int character,
                                            std::uint64_t revision, std::size_t n);

}  // namespace kinescope::http
