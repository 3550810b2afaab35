/// Sources by URL, the same in every command.
#pragma once

#include <memory>
#include <string>

#include "core/source.h"
#include "server/mvn/open.h"

namespace kinescope::app {

/// As an MVN Link streams; what the built-in subject gives unless told otherwise.
inline constexpr double kSubjectRateHz = 120;

/// What a source may be, for --help and errors.
inline constexpr const char* kSourceKinds =
    "udp://[address]:port, tcp://[address]:port, a recording (MVNX, pcap, pcapng, .bin or ROS bag, "
    "also packed with gzip or xz; - for standard input), ros: or ros:/topic, demo:lift or "
    "demo:walk";

struct SourceSettings {
  double subject_rate_hz = kSubjectRateHz;  // samples a second of `demo:`
  mvn::StreamSettings stream;               // of sources that are datagrams
};

/// `demo:lift`, `udp://:9763`, `tcp://:9763`, `file.mvnx`, `take.pcap`, `take.bin.xz`, `walk.bag`,
/// `ros:`.
/// A file is known by its content.
/// @throws SourceError naming the URL and what would be right.
std::unique_ptr<Source> OpenSource(const std::string& url, const SourceSettings& settings = {});

/// Whether a source of that URL is live: samples come when they come, and it has no end.
bool IsLiveUrl(const std::string& url);

/// A file or the built-in subject at its true rate: samples come when they are due, stamped with
/// the time of day. `loop` starts over at the end, with counters and time going on.
/// A live source is returned as it is.
std::unique_ptr<Source> OpenAtTrueRate(const std::string& url, bool loop,
                                       const SourceSettings& settings = {});

}  // namespace kinescope::app
