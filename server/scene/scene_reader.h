/// A file or the built-in subject as scene states, one after the other, as fast as they are asked
/// for. One thread at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/source.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

/// The latest time of a recording that an option may name, s after its first sample: ten days,
/// longer than any recording and far from what nanoseconds in 64 bits can hold.
inline constexpr double kLatestSecs = 864'000;

class SceneReader {
 public:
  /// @throws SourceError; UsageError for a live source, which has no end and no "frame 60".
  SceneReader(const std::string& url, const SceneOptions& options);

  /// The next sample's state; null at the end.
  std::shared_ptr<const SceneState> Next();

  /// The state before the first sample: "no data".
  std::shared_ptr<const SceneState> Empty() const { return empty_; }
  /// The newest state, as it looks when nothing more comes.
  std::shared_ptr<const SceneState> Stale();

  double rate_hz() const { return source_->nominal_rate_hz(); }
  const std::string& url() const { return url_; }

 private:
  const std::string url_;
  std::unique_ptr<Source> source_;
  std::deque<std::shared_ptr<const SceneState>> ready_;
  std::shared_ptr<const SceneState> empty_;
  SceneBuilder builder_;
  bool ended_ = false;
};

/// The scene at any time, for times that grow: states read as needed and interpolated between.
class SceneTimeline {
 public:
  using ReadNext = std::function<std::shared_ptr<const SceneState>()>;

  /// Ctrl-C ends its reading. @throws std::runtime_error then, naming the source.
  explicit SceneTimeline(SceneReader& reader);
  /// `next` gives the states, one after the other; null at the end.
  explicit SceneTimeline(ReadNext next);

  /// `secs` after the first sample; nullopt past the last one.
  /// @pre 0 <= secs <= kLatestSecs, not before the last call's.
  std::optional<SceneState> At(double secs);
  std::optional<SceneState> AtNanos(std::int64_t nanos);

 private:
  ReadNext next_;
  std::shared_ptr<const SceneState> before_, after_;
  std::int64_t start_nanos_ = 0;
};

}  // namespace kinescope::app
