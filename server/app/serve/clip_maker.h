/// Renders clips of former moments as `kinescope render` would of a recording. For the workshop's
/// thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "server/app/serve/workshop.h"
#include "server/history/history.h"
#include "server/marks/mark_book.h"
#include "server/marks/mark_track.h"
#include "server/picture/backend.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

struct ClipSettings {
  ViewOptions view;        // its camera and title are those of the order
  std::string own_camera;  // as --camera has it: http::kOwnCamera
  BackendOptions backend;
  SceneOptions scene;
};

/// Of SceneState::made_nanos.
struct ClipSpan {
  std::int64_t from_nanos = 0, to_nanos = 0;
};

struct ClipMakerOrder {
  ClipSpan span;
  std::string camera;  // by name
  std::string title;
  std::filesystem::path file;  // .mp4
};

class ClipMaker {
 public:
  static constexpr int kFramesPerSecond = 30;

  /// `history` and `book` are borrowed. `book`: of the marks that are shown; null: none.
  ClipMaker(ClipSettings settings, RendererFactory make_renderer, const history::History& history,
            const marks::MarkBook* book)
      : settings_(std::move(settings)),
        make_renderer_(std::move(make_renderer)),
        history_(history),
        book_(book) {}

  /// Waits for moments that have not come yet, and then makes the clip.
  /// @throws std::exception: the moments are gone, a full disk, ...
  void Make(const ClipMakerOrder& order, Workshop::Progress& progress) const;

 private:
  bool Await(std::int64_t nanos, const Workshop::Progress& progress) const;
  SceneState StateAt(std::int64_t nanos) const;
  marks::MarkTrack TrackOfThisRun() const;

  const ClipSettings settings_;
  const RendererFactory make_renderer_;
  const history::History& history_;
  const marks::MarkBook* book_;
};

}  // namespace kinescope::app
