#include "server/mvn/open.h"

#include <utility>

#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/mvn/file/recording.h"
#include "server/mvn/net/net_url.h"
#include "server/mvn/net/socket.h"
#include "server/mvn/net/tcp_datagrams.h"
#include "server/mvn/net/udp_datagrams.h"

namespace kinescope::mvn {

std::unique_ptr<DatagramSource> OpenDatagrams(const std::string& url) {
  if (IsNetUrl(url)) return url[0] == 'u' ? OpenUdpDatagrams(url) : OpenTcpDatagrams(url);
  for (const char* other : {"demo:", "pose:", "ros:"}) {
    if (StartsWith(url, other)) return nullptr;
  }
  InputFile file = OpenInputFile(url);
  const RecordingKind kind = KindOf(file.head());
  if (kind == RecordingKind::kMvnx || kind == RecordingKind::kRosBag) return nullptr;
  return OpenRecording(std::move(file), NameOfInput(url));
}

std::string ReceivingFrom(const std::string& url, const std::string& from) {
  if (from.empty()) return url;
  if (!IsNetUrl(url)) {
    throw UsageError("--from=" + from + ": " + url +
                     " does not receive from a network; expected a source such as udp://:9763");
  }
  const char sign = url.find('?') == std::string::npos ? '?' : '&';
  std::string restricted = url + sign + "from=" + from;
  try {
    if (!ParseNetUrl(url).from_text.empty()) {
      throw UsageError("--from=" + from + ": " + url + " says from= already; use one of them");
    }
    ParseNetUrl(restricted);
  } catch (const SourceError& error) {
    throw UsageError(std::string("--from: ") + error.what());
  }
  return restricted;
}

std::string DescribeReach(const std::string& url) {
  if (!IsNetUrl(url)) return "";
  const NetUrl parsed = ParseNetUrl(url);
  if (parsed.mode != NetUrl::Mode::kListen) return "";
  const SocketAddress address = ResolveToListen(parsed, url);
  const std::string senders = parsed.from.empty()
                                  ? "every sender (--from ADDRESS/n admits only some)"
                                  : "senders of " + parsed.from_text + " only";
  return (IsLoopback(address)      ? "reached from this machine only, accepts "
          : IsUnspecified(address) ? "reached through every network of this machine, accepts "
                                   : "reached through the network of this address, accepts ") +
         senders;
}

}  // namespace kinescope::mvn
