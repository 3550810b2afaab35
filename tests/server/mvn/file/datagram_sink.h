/// Keeps datagrams, for tests of what hands them on.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "core/system/input_file.h"
#include "server/mvn/byte_order.h"
#include "server/mvn/datagram_source.h"

namespace kinescope::mvn::testing {

/// "MXTP02 #7, 760 bytes, 1f2e..." for a failing test to print; differs where the datagram does.
inline std::string Brief(const std::string& datagram) {
  std::uint32_t counter = 0;
  ByteReader in(datagram);
  if (!in.Seek(6) || !in.Read(counter)) counter = 0;
  std::ostringstream out;
  out << datagram.substr(0, 6) << " #" << counter << ", " << datagram.size() << " bytes, "
      << std::hex << std::hash<std::string>()(datagram);
  return out.str();
}

inline std::vector<std::string> Brief(const std::vector<std::string>& datagrams) {
  std::vector<std::string> brief;
  for (const std::string& datagram : datagrams) brief.push_back(Brief(datagram));
  return brief;
}

struct KeptDatagram {
  Endpoint from, to;
  std::string bytes;
  Arrival arrival;

  bool operator==(const KeptDatagram& other) const {
    return from == other.from && to == other.to && bytes == other.bytes &&
           arrival.wall_nanos == other.arrival.wall_nanos;
  }
  friend std::ostream& operator<<(std::ostream& out, const KeptDatagram& datagram) {
    return out << Brief(datagram.bytes) << " from " << Format(datagram.from) << " to "
               << Format(datagram.to) << " at " << datagram.arrival.wall_nanos;
  }
};

struct KeepingSink : DatagramSink {
  std::vector<KeptDatagram> datagrams;

  void OnDatagram(const ReceivedDatagram& datagram) override {
    datagrams.push_back(
        {datagram.from, datagram.to, std::string(datagram.bytes), datagram.arrival});
  }

  std::vector<std::string> Brief() const {
    std::vector<std::string> brief;
    for (const KeptDatagram& datagram : datagrams) brief.push_back(testing::Brief(datagram.bytes));
    return brief;
  }
};

/// All that a file has.
inline KeepingSink ReadToEnd(DatagramSource& source) {
  KeepingSink sink;
  while (source.Poll(std::chrono::nanoseconds(0), sink) != DatagramSource::State::kEnded) {
  }
  return sink;
}

/// `bytes` as an open file.
inline InputFile FileOf(const std::string& bytes) {
  std::FILE* const file = std::tmpfile();
  std::fwrite(bytes.data(), 1, bytes.size(), file);
  std::rewind(file);
  return file;
}

}  // namespace kinescope::mvn::testing
