#include "server/app/golden/accept_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include "core/system/stop_signal.h"
#include "server/app/print.h"

namespace kinescope::app {

AcceptLock::AcceptLock(const std::filesystem::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_ < 0 || ::flock(folder_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  PrintText(stderr, fmt::format("Another command accepts pictures in {}: waiting for its end\n",
                                folder.string()));
  while (::flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
    if (!StopRequested()) continue;
    ::close(folder_);
    throw std::runtime_error("interrupted");
  }
}

AcceptLock::~AcceptLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace kinescope::app
