#include "server/mvn/net/sender.h"

#include "server/mvn/net/transport_senders.h"

namespace kinescope::mvn {

std::unique_ptr<DatagramSender> OpenSender(const std::string& url) {
  const NetUrl parsed = ParseNetUrl(url);
  return parsed.protocol == Protocol::kUdp ? OpenUdpSender(parsed, url)
                                           : OpenTcpSender(parsed, url);
}

}  // namespace kinescope::mvn
