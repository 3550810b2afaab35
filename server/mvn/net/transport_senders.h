/// The UDP and TCP senders behind OpenSender(). They have no thread: over TCP all work is done
/// within Send(). It accepts receivers (a receiver that connects while nothing is sent waits),
/// detects and restores lost connections, and continues sending to slow receivers. Opening a sender
/// waits up to a second for an existing receiver, and its destructor waits for the last bytes to be
/// sent. One thread.
#pragma once

#include <memory>
#include <string>

#include "server/mvn/net/net_url.h"
#include "server/mvn/net/sender.h"

namespace kinescope::mvn {

/// `text`: the URL as the user typed it, for errors. Over TCP a datagram counts as sent if all
/// receivers, at least one, have room for it: up to 1 MB per receiver may be queued. @throws
/// SourceError.
std::unique_ptr<DatagramSender> OpenUdpSender(const NetUrl& url, const std::string& text);
std::unique_ptr<DatagramSender> OpenTcpSender(const NetUrl& url, const std::string& text);

}  // namespace kinescope::mvn
