#include "server/mvn/net/allowed_senders.h"

#include <spdlog/spdlog.h>

namespace kinescope::mvn {

void WarnOfStranger(const std::string& description, const Endpoint& sender) {
  spdlog::warn("{}: rejects {}, which --from does not admit, and all others like it", description,
               Format(sender));
}

}  // namespace kinescope::mvn
