/// Finds how long a recording is: reads it a second time, on a thread of its own, because only its
/// end tells. Any thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>

#include "core/source.h"

namespace kinescope::app {

class RecordingLength {
 public:
  /// `open` is called on the thread. If it or the source throws SourceError, the length is that of
  /// what could be read: playing ends there, too.
  explicit RecordingLength(std::function<std::unique_ptr<Source>()> open);
  ~RecordingLength();  // gives up
  RecordingLength(const RecordingLength&) = delete;
  RecordingLength& operator=(const RecordingLength&) = delete;

  /// From the first sample to the last, ns; nullopt: not known yet, or there is no sample.
  std::optional<std::int64_t> nanos() const;
  /// The same, once it is known.
  std::optional<std::int64_t> Wait() const { return length_.get(); }

 private:
  using Length = std::optional<std::int64_t>;
  Length Read(const std::function<std::unique_ptr<Source>()>& open) const;

  std::atomic<bool> is_ending_{false};
  const std::shared_future<Length> length_;  // its thread uses all of the above
};

}  // namespace kinescope::app
