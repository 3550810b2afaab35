#include "server/app/serve/hand_load_mailbox.h"

#include <utility>

#include "server/loads/hand_loads.h"

namespace kinescope::app {

std::string HandLoadMailbox::Put(int character, const HandLoad& load) {
  std::string defect = loads::FindDefect(load);
  if (!defect.empty()) return defect;
  const std::lock_guard<std::mutex> lock(mutex_);
  loads_[character] = load;
  return "";
}

std::map<int, HandLoad> HandLoadMailbox::TakeAll() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(loads_, {});
}

}  // namespace kinescope::app
