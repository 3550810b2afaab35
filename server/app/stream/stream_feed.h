/// Reads the data that `kinescope stream` sends: any source as datagrams with the times at which
/// they are due, before faults and pacing. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/mvn/datagram_source.h"
#include "server/mvn/encode.h"

namespace kinescope::app {

struct FeedSettings {
  std::string source;
  double rate_hz = 0;  // samples per second of `demo:` and `pose:`
  int characters = 1;  // copies of each character, side by side
  std::optional<mvn::TypeSet>
      types;             // absent: the usual ones with 12 and 13, or all that a source has
  double stream_hz = 0;  // maximum samples per second of each character; 0: all
  double speed = 1;      // 2: twice the original speed
  bool loop = false;
  bool gloves = false;  // generated; not for sources of datagrams
  int props = 0;        // generated; not for sources of datagrams
};

struct FeedDatagram {
  std::int64_t due_nanos = 0;  // ns since the beginning; never goes back
  std::string bytes;
  bool begins_sample = false;
};

class Feed {
 public:
  virtual ~Feed() = default;
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  enum class State { kMore, kEnded };

  /// Appends the next datagrams to `out`: of a file at once, of a live source those that arrive
  /// within `timeout`; possibly none.
  /// @throws SourceError if the source cannot continue.
  virtual State Read(std::chrono::nanoseconds timeout, std::vector<FeedDatagram>& out) = 0;

  virtual bool is_live() const = 0;
  virtual std::string description() const = 0;  // of the source, with the actual port

 protected:
  Feed() = default;
};

/// Opens `settings.source` of any kind. Datagrams (a socket, a capture) are passed on unchanged,
/// except for the character id of copies and, after the first round of a loop, counter and time
/// code. All other sources are encoded.
/// @throws SourceError with the source and the reason; UsageError for settings that the source does
/// not support.
std::unique_ptr<Feed> OpenFeed(const FeedSettings& settings);

// The two kinds of feeds, for OpenFeed().

std::unique_ptr<Feed> MakeSampleFeed(const FeedSettings& settings);
std::unique_ptr<Feed> MakeDatagramFeed(const FeedSettings& settings,
                                       std::unique_ptr<mvn::DatagramSource> source);

/// Assigns the character ids of copies: 0 to `copies` - 1 for the first character, then the next
/// ones. Without copies every character keeps its id.
class CharacterIds {
 public:
  explicit CharacterIds(int copies) : copies_(copies) {}

  /// nullopt if there are more characters than a header can distinguish.
  std::optional<int> Find(int character, int copy);

 private:
  const int copies_;
  std::map<int, int> first_;  // first id, by original id
};

/// Selects the samples of one character for a slower stream: one per period of `stream_hz`, as
/// evenly as the samples allow.
class Decimator {
 public:
  /// Whether to keep the sample `counter`, taken at `time_nanos` on the sender's clock. All
  /// datagrams of a sample get the same answer, also out of order. `clock_step_nanos`: resolution
  /// of that clock. `stream_hz` 0: all.
  [[nodiscard]] bool Keeps(double stream_hz, std::uint32_t counter, std::int64_t time_nanos,
                           std::int64_t clock_step_nanos);

 private:
  struct Decision {
    std::uint32_t counter = 0;
    bool keep = true;
  };
  std::vector<Decision> latest_;  // ring buffer
  std::size_t next_ = 0;
  std::int64_t slot_ = 0;
  std::int64_t time_nanos_ = 0;
};

}  // namespace kinescope::app
