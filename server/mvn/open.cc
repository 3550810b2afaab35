#include "server/mvn/open.h"

#include <utility>

#include "server/mvn/file/recording.h"
#include "server/mvn/net/tcp_datagrams.h"
#include "server/mvn/net/udp_datagrams.h"

namespace kinescope::mvn {
namespace {

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

std::unique_ptr<DatagramSource> OpenDatagrams(const std::string& url) {
  if (StartsWith(url, "udp:")) return OpenUdpDatagrams(url);
  if (StartsWith(url, "tcp:")) return OpenTcpDatagrams(url);
  if (StartsWith(url, "demo:")) return nullptr;
  InputFile file = OpenInputFile(url);
  const RecordingKind kind = KindOf(file.head());
  if (kind == RecordingKind::kMvnx || kind == RecordingKind::kRosBag) return nullptr;
  return OpenRecording(std::move(file), NameOfInput(url));
}

}  // namespace kinescope::mvn
