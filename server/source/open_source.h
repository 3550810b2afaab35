/// Opens sources by URL, in the same way for all commands. Any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/graph_view.h"
#include "core/source.h"
#include "server/mvn/open.h"
#include "server/source/scheme.h"
#include "urdf/skeleton.h"

namespace kinescope::app {

/// Default rate of the built-in subject: that of an MVN Link stream.
inline constexpr double kSubjectRateHz = 120;

struct SourceSettings {
  double subject_rate_hz = kSubjectRateHz;  // samples per second of `demo:` and `pose:`
  double subject_height_m = urdf::kDefaultHeight;
  mvn::StreamSettings stream;        // for sources of datagrams
  GraphView bag;                     // for bags
  mvn::DatagramSink* tap = nullptr;  // receives the datagrams of a live stream, too; borrowed
};

/// `demo:lift`, `pose:right_elbow=90`, `udp://:9763`, `tcp://:9763`, `file.mvnx`, `take.pcap`,
/// `take.bin.xz`, `walk.bag`, `ros:`. The format of a file is detected by its content.
/// @throws SourceError with the URL and the expected form or the remedy; also where `settings.bag`
/// asks for what only a bag has.
std::unique_ptr<Source> OpenSource(const std::string& url, const SourceSettings& settings = {});

/// What keeps a source from data, with the way out: of a ROS graph, that no master answers
/// (`is_for_long`), or that no node publishes its topic. `text` is "" if nothing is known to.
struct Hindrance {
  std::string text;
  bool is_for_long = false;
};
[[nodiscard]] Hindrance HindranceOf(const std::string& url, const Source& source);

/// Whether `url` names a file that is a ROS bag. A pipe is none.
[[nodiscard]] bool IsBag(const std::string& url);
/// Whether it is a graph of ROS or a bag, which keep stamps and no time codes of a suit.
[[nodiscard]] bool IsOfRos(const std::string& url);

/// Opens a file or the built-in subject at its true rate: samples are delivered when they are due,
/// stamped with the current time. `loop` starts over at the end; counters and time continue.
/// `start_at`: as that of PacedSource. A live source is returned unchanged.
std::unique_ptr<Source> OpenAtTrueRate(const std::string& url, bool loop,
                                       const SourceSettings& settings = {},
                                       std::int64_t start_at = 0);

/// Opens a file or the built-in subject to be read at once up to `stop_at` (ns after the first
/// sample), as PacedSource::UpTo() does it. @pre the source is not live
std::unique_ptr<Source> OpenUpTo(const std::string& url, std::int64_t stop_at,
                                 const SourceSettings& settings = {});

}  // namespace kinescope::app
