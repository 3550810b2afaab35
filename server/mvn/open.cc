#include "server/mvn/open.h"

#include <utility>

#include "core/system/starts_with.h"
#include "server/mvn/file/recording.h"
#include "server/mvn/net/net_url.h"
#include "server/mvn/net/tcp_datagrams.h"
#include "server/mvn/net/udp_datagrams.h"

namespace kinescope::mvn {

std::unique_ptr<DatagramSource> OpenDatagrams(const std::string& url) {
  if (IsNetUrl(url)) return url[0] == 'u' ? OpenUdpDatagrams(url) : OpenTcpDatagrams(url);
  if (StartsWith(url, "demo:") || StartsWith(url, "ros:")) return nullptr;
  InputFile file = OpenInputFile(url);
  const RecordingKind kind = KindOf(file.head());
  if (kind == RecordingKind::kMvnx || kind == RecordingKind::kRosBag) return nullptr;
  return OpenRecording(std::move(file), NameOfInput(url));
}

}  // namespace kinescope::mvn
