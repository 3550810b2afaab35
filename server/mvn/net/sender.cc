#include "server/mvn/net/sender.h"

#include "core/system/errors.h"
#include "server/mvn/net/transport_senders.h"

namespace kinescope::mvn {

std::unique_ptr<DatagramSender> OpenSender(const std::string& url) {
  const NetUrl parsed = ParseNetUrl(url);
  if (!parsed.from.empty()) {
    throw SourceError(url + ": from= is for receivers; remove it, or give it to the receiver");
  }
  return parsed.protocol == Protocol::kUdp ? OpenUdpSender(parsed, url)
                                           : OpenTcpSender(parsed, url);
}

}  // namespace kinescope::mvn
