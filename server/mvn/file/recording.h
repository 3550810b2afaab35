/// Detects the format of a recording by its content and opens it. Used by open.h and by callers
/// that have opened the file already (standard input can be opened only once). Any thread.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/system/input_file.h"
#include "server/mvn/datagram_source.h"

namespace kinescope::mvn {

/// Format of a recording, detected by the first bytes of its content.
enum class RecordingKind {
  kPcap,       // a capture: pcap or pcapng
  kDatagrams,  // MVN datagrams one after the other, as in a TCP stream
  kMvnx,       // XML; not necessarily MVNX
  kRosBag,
  kEmpty,
  kUnknown,
};
RecordingKind KindOf(std::string_view head);

/// One line for a file of an unsupported format. `wanted`: "a capture or MVN datagrams".
std::string DescribeUnfit(const std::string& path, std::string_view head,
                          const std::string& wanted);

/// The datagrams of `file`, a capture or raw datagrams; `name` is for messages.
/// @throws SourceError if it is neither, or damaged at its beginning.
std::unique_ptr<DatagramSource> OpenRecording(InputFile file, const std::string& name);

}  // namespace kinescope::mvn
