/// The senders behind OpenSender(), by protocol. They have no thread of their own: over TCP all
/// progress is made within Send(). There receivers are accepted (who connects while nothing is sent
/// waits), a lost connection is noticed and made again, and what a slow receiver could not take yet
/// is sent on. Making one waits up to a second for a receiver that is there, and destroying one for
/// the last bytes to leave.
#pragma once

#include <memory>
#include <string>

#include "server/mvn/net/net_url.h"
#include "server/mvn/net/sender.h"

namespace kinescope::mvn {

/// `text` is the URL as the user wrote it, for errors. Over TCP a datagram counts as sent when all
/// receivers, at least one, have room for it: up to 1 MB waits for each. @throws SourceError.
std::unique_ptr<DatagramSender> OpenUdpSender(const NetUrl& url, const std::string& text);
std::unique_ptr<DatagramSender> OpenTcpSender(const NetUrl& url, const std::string& text);

}  // namespace kinescope::mvn
