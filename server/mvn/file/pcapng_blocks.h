/// Blocks of a pcapng capture with one interface (raw IP, nanoseconds), which libpcap reads and
/// does not write. Format: draft-ietf-opsawg-pcapng, sections 3 and 4. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::mvn {

/// Appends the blocks that a file begins with: section and interface.
void AppendPcapngHead(std::string& out);

/// Appends a packet. `comments`: Wireshark shows them with it; cut at 65,535 bytes, between
/// characters. @pre packet.size() < 2^18
void AppendPcapngPacket(std::int64_t wall_nanos, std::string_view packet,
                        const std::vector<std::string>& comments, std::string& out);

/// Appends comments without a packet, with the statistics of the interface.
void AppendPcapngEnd(std::int64_t wall_nanos, const std::vector<std::string>& comments,
                     std::string& out);

}  // namespace kinescope::mvn
