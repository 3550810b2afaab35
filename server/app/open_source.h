/// Sources by URL, the same in every command.
#pragma once

#include <memory>
#include <string>

#include "server/core/source.h"

namespace kinescope::app {

/// As an MVN Link streams; what the built-in subject gives unless told otherwise.
inline constexpr double kSubjectRateHz = 120;

/// `demo:lift`, `file.mvnx`, `udp://:9763`. `subject_rate_hz`: samples a second of `demo:`.
/// @throws SourceError naming the URL and what would be right.
std::unique_ptr<Source> OpenSource(const std::string& url, double subject_rate_hz = kSubjectRateHz);

/// A file or the built-in subject at its true rate: samples come when they are due, stamped with
/// the time of day. `loop` starts over at the end, with counter and time going on.
/// A live source is returned as it is.
std::unique_ptr<Source> OpenAtTrueRate(const std::string& url, bool loop,
                                       double subject_rate_hz = kSubjectRateHz);

}  // namespace kinescope::app
