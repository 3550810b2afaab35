/// A source of datagrams that shows each of them to a second reader, too: a recording while the
/// stream is read. One thread.
#pragma once

#include <memory>

#include "server/mvn/datagram_source.h"

namespace kinescope::mvn {

/// `source`, of which `tap` receives each datagram before the one who polls. `tap` is borrowed; it
/// must not throw, nor wait. Null: `source` as it is.
std::unique_ptr<DatagramSource> Tapped(std::unique_ptr<DatagramSource> source, DatagramSink* tap);

}  // namespace kinescope::mvn
