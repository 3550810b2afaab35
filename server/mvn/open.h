/// Opens streams and recordings by URL, in the same way for all commands: `udp://:9763`,
/// `tcp://:9763`, `tcp://host:9763`, `motion.mvnx`, `take.pcap`, `take.bin`; files may be
/// compressed (core/system/input_file.h). Any thread.
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

/// The datagrams of `url`, or null if it is not a stream of datagrams (an MVNX file, demo:lift,
/// ros:).
/// The format of a file is detected by its first bytes, not by its name.
/// @throws SourceError with the URL, the error and the remedy (port in use, missing file, not a
/// capture).
std::unique_ptr<DatagramSource> OpenDatagrams(const std::string& url);

/// The samples that are assembled from `datagrams`.
std::unique_ptr<Source> OpenStream(std::unique_ptr<DatagramSource> datagrams,
                                   const StreamSettings& settings = {});

/// Opens an MVNX file. @throws SourceError with the file, the error and the remedy.
std::unique_ptr<Source> OpenMvnx(const std::string& path);

}  // namespace kinescope::mvn
