/// Recordings, whichever form they have: told by their content, opened. Used by open.h and by who
/// has the file open already (standard input can be opened once only).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/input_file.h"
#include "server/mvn/datagram_source.h"

namespace kinescope::mvn {

/// What a recording is, by the first bytes of its content.
enum class RecordingKind {
  kPcap,       // a capture: pcap or pcapng
  kDatagrams,  // MVN datagrams one after the other, as a TCP stream has them
  kMvnx,       // XML, at least
  kRosBag,
  kEmpty,
  kUnknown,
};
RecordingKind KindOf(std::string_view head);

/// One line for a file of a kind that nobody can read here. `wanted`: "a capture or MVN datagrams".
std::string DescribeUnfit(const std::string& path, std::string_view head,
                          const std::string& wanted);

/// The datagrams in `file`, a capture or raw datagrams; `name` is for people.
/// @throws SourceError if it is neither, or damaged where it begins.
std::unique_ptr<DatagramSource> OpenRecording(InputFile file, const std::string& name);

}  // namespace kinescope::mvn
