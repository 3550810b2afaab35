/// Opens streams and recordings by URL, in the same way for all commands: `udp://:9763`,
/// `tcp://:9763`, `tcp://host:9763`, `motion.mvnx`, `take.pcap`, `take.bin`; files may be
/// compressed (core/system/input_file.h). Any thread.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/source.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/stream_settings.h"

namespace kinescope::mvn {

/// The datagrams of `url`, or null if it is not a stream of datagrams (an MVNX file, demo:lift,
/// ros:).
/// The format of a file is detected by its first bytes, not by its name.
/// @throws SourceError with the URL, the error and the remedy (port in use, missing file, not a
/// capture).
std::unique_ptr<DatagramSource> OpenDatagrams(const std::string& url);

/// `url` with the restriction of --from: only these machines may send ("192.168.1.20,10.0.0.0/8").
/// Unchanged if `from` is "". @throws UsageError naming --from and what was expected; also if `url`
/// does not receive from a network
std::string ReceivingFrom(const std::string& url, const std::string& from);

/// For the start of a receiver: "reached from every network of this machine, accepts every sender
/// (--from admits only some)". "" for a URL that does not listen.
std::string DescribeReach(const std::string& url);

/// The samples that are assembled from `datagrams`.
std::unique_ptr<Source> OpenStream(std::unique_ptr<DatagramSource> datagrams,
                                   const StreamSettings& settings = {});

/// Opens an MVNX file. @throws SourceError with the file, the error and the remedy.
std::unique_ptr<Source> OpenMvnx(const std::string& path);

}  // namespace kinescope::mvn
