/// What `kinescope stream` sends: any source as datagrams with the times at which they are due,
/// before faults and pacing. One thread.
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
  double rate_hz = 0;  // of `demo:`
  int characters = 1;  // copies of everybody, side by side
  std::optional<mvn::TypeSet>
      types;             // none: the usual ones with 12 and 13, or all that a source has
  double stream_hz = 0;  // most samples a second of each character; 0: all
  double speed = 1;      // 2: twice as fast as it was captured
  bool loop = false;
  bool gloves = false;  // made up; not for sources that are datagrams
  int props = 0;        // likewise
};

struct FeedDatagram {
  std::int64_t due_nanos = 0;  // since the beginning; never goes back
  std::string bytes;
  bool begins_sample = false;
};

class Feed {
 public:
  virtual ~Feed() = default;
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  enum class State { kMore, kEnded };

  /// Appends what comes next to `out`: of a file at once, of a live source what comes within
  /// `timeout`; maybe nothing.
  /// @throws SourceError when the source cannot go on.
  virtual State Read(std::chrono::nanoseconds timeout, std::vector<FeedDatagram>& out) = 0;

  virtual bool is_live() const = 0;
  virtual std::string description() const = 0;  // of the source, with the real port

 protected:
  Feed() = default;
};

/// `settings.source`, whatever it is. Datagrams (a socket, a capture) are passed on byte for byte,
/// apart from the character's id of copies and, after the first round of a loop, counter and time
/// code. Everything else is encoded.
/// @throws SourceError naming the source and what is wrong with it; UsageError for settings that do
/// not go with it.
std::unique_ptr<Feed> OpenFeed(const FeedSettings& settings);

// For the feeds.

std::unique_ptr<Feed> MakeSampleFeed(const FeedSettings& settings);
std::unique_ptr<Feed> MakeDatagramFeed(const FeedSettings& settings,
                                       std::unique_ptr<mvn::DatagramSource> source);

/// The ids of copies: 0 to `copies` - 1 for the first character that is met, then on. Without
/// copies everybody keeps his own.
class CopyIds {
 public:
  explicit CopyIds(int copies) : copies_(copies) {}

  /// Nothing where there are more than a header can tell apart.
  std::optional<int> Find(int character, int copy);

 private:
  const int copies_;
  std::map<int, int> first_;  // by original id
};

/// Which samples of one character a slower stream keeps: one in each period of `stream_hz`, as
/// evenly as captured frames allow.
class Thinner {
 public:
  /// Whether to keep the sample `counter`, taken at `time_nanos` of the sender's clock; the same
  /// answer for every datagram of it, also when they come out of order. `clock_step_nanos`: the
  /// clock's resolution. `stream_hz` 0: all.
  [[nodiscard]] bool Keeps(double stream_hz, std::uint32_t counter, std::int64_t time_nanos,
                           std::int64_t clock_step_nanos);

 private:
  struct Decision {
    std::uint32_t counter = 0;
    bool keep = true;
  };
  std::vector<Decision> latest_;  // a ring
  std::size_t next_ = 0;
  std::int64_t slot_ = 0;
  std::int64_t time_nanos_ = 0;
};

}  // namespace kinescope::app
