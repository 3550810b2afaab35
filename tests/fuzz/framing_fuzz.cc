// Any bytes as a TCP stream, in one piece and in pieces whose sizes the bytes themselves choose:
// what comes out is the same, it is the input in its order, and nothing of it is lost uncounted.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/system/check.h"
#include "server/mvn/stream_framer.h"

namespace framing_fuzz {
namespace {

using kinescope::mvn::StreamFramer;

constexpr std::size_t kLargestPending = 24 + 65535 + 6;

// Where in the stream the pieces are that `framer` has so far.
struct Places {
  std::vector<std::size_t> ends;

  void Take(StreamFramer& framer, std::string_view stream) {
    while (const auto piece = framer.Next()) {
      KINESCOPE_CHECK(!piece->empty());
      handed_out += piece->size();
      // All before its end was handed out, passed over, or both ends of a step back.
      const std::size_t end = handed_out + framer.skipped_bytes() - framer.reread_bytes();
      KINESCOPE_CHECK(end <= stream.size() && piece->size() <= end);
      KINESCOPE_CHECK(*piece == stream.substr(end - piece->size(), piece->size()));
      ends.push_back(end);
    }
  }
  std::size_t handed_out = 0;
};

template <class NextSize>
Places Frame(std::string_view stream, const NextSize& next_size) {
  StreamFramer framer;
  Places places;
  for (std::size_t at = 0; at < stream.size();) {
    const std::string_view chunk = stream.substr(at, next_size(at));
    framer.Append(chunk);
    at += chunk.size();
    places.Take(framer, stream);
    KINESCOPE_CHECK(framer.pending_bytes() <= kLargestPending);
    KINESCOPE_CHECK(places.handed_out + framer.skipped_bytes() + framer.pending_bytes() ==
                    at + framer.reread_bytes());
  }
  framer.End();
  places.Take(framer, stream);
  KINESCOPE_CHECK(framer.pending_bytes() == 0);
  KINESCOPE_CHECK(places.handed_out + framer.skipped_bytes() ==
                  stream.size() + framer.reread_bytes());
  places.ends.push_back(framer.resyncs());
  places.ends.push_back(framer.skipped_bytes());
  return places;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view stream(reinterpret_cast<const char*>(data), size);
  const Places whole = Frame(stream, [size](std::size_t) { return size; });
  const Places cut = Frame(stream, [data](std::size_t at) { return 1 + data[at] % 40U; });
  KINESCOPE_CHECK(whole.ends == cut.ends);
  return 0;
}

}  // namespace framing_fuzz
