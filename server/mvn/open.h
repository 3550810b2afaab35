/// Sources by URL, the same everywhere: `udp://:9763`, `tcp://:9763`, `tcp://host:9763`,
/// `motion.mvnx`, `take.pcap`, `take.bin`; files also with `.gz` or `.xz`.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/source.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/stamps.h"

namespace kinescope::mvn {

struct StreamSettings {
  Stamps stamps = Stamps::kFitted;
};

/// The datagrams of `url`, or null where it is no stream of datagrams (an MVNX file, demo:lift,
/// ros:).
/// A file is known by its first bytes, not by its name.
/// @throws SourceError naming the URL, what is wrong and what would be right (port taken, file
/// missing, not a capture).
std::unique_ptr<DatagramSource> OpenDatagrams(const std::string& url);

/// `datagrams` joined to samples.
std::unique_ptr<Source> OpenStream(std::unique_ptr<DatagramSource> datagrams,
                                   const StreamSettings& settings = {});

/// An MVNX file. @throws SourceError as above.
std::unique_ptr<Source> OpenMvnx(const std::string& path);

}  // namespace kinescope::mvn
