#include "server/recording/stream_description.h"

#include <algorithm>
#include <utility>

#include "server/mvn/datagram.h"

namespace kinescope::recording {

void StreamDescription::OnDatagram(const mvn::ReceivedDatagram& datagram) {
  const auto header = mvn::ParseHeader(datagram.bytes);
  if (!header || mvn::BelongsToSample(header->type)) return;
  Kept kept{datagram.from,     datagram.to,  static_cast<int>(header->type),
            header->character, header->part, std::string(datagram.bytes)};
  const auto same = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& other) {
    return other.from == kept.from && other.type == kept.type &&
           other.character == kept.character && other.part == kept.part;
  });
  if (same != kept_.end()) {
    *same = std::move(kept);
    return;
  }
  kept_.push_back(std::move(kept));
  if (kept_.size() > kMost) kept_.pop_front();
}

void StreamDescription::PassTo(mvn::DatagramSink& sink, const mvn::Arrival& arrival) const {
  for (const Kept& kept : kept_) sink.OnDatagram({kept.from, kept.to, kept.bytes, arrival});
}

}  // namespace kinescope::recording
