/// What is in a stream: who sends, which messages, how regularly, what is lost, what is wrong, and
/// what to switch on in MVN. Feed it whatever comes, then ask for the report. It keeps at most 64
/// (sender, character) pairs and counts what else comes, its percentiles come from histograms of a
/// fixed size, so its memory does not grow with the stream. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/source.h"
#include "server/mvn/assembler.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/inspect/frames.h"

namespace kinescope::mvn {

/// The name of a message type in MVN's dialog of the network streamer: "Position + Orientation
/// (Quaternion)". "" for one that Kinescope does not know.
std::string DialogName(int type);

struct TypeReport {
  int type = 2;  // MXTP02
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  double rate_hz = 0;    // datagrams a second, while it was sent; 0: one only
  int fewest_items = 0;  // in one datagram
  int most_items = 0;
  /// Of all frames, those that have it, 0 to 1; none for 12 and 13, which belong to no frame.
  std::optional<double> share;
};

struct DelayReport {  // ns, against the fastest frames of the last seconds
  std::int64_t median = 0;
  std::int64_t p95 = 0;
  std::int64_t p99 = 0;
  std::int64_t longest = 0;
};

enum class CharacterKind { kUnknown, kPerson, kObjects };

/// What one sender says of one character, or a file of one person.
struct CharacterReport {
  std::string sender;  // "192.168.1.20:9763"; "" where there are no datagrams or nobody knows
  int id = 0;          // as sent
  std::string name;
  std::optional<std::uint32_t> color_rgb;
  CharacterKind kind = CharacterKind::kUnknown;
  std::optional<double> height_m;  // from scale data
  int body_segments = 0;           // of a sample: 23, or 0 without one
  int objects = 0;
  int left_fingers = 0;
  int right_fingers = 0;
  int props = 0;
  std::vector<std::string> names;  // of props or objects, where scale data tell them

  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  bool has_old_header = false;  // without payload size: MVN before 2018
  std::vector<TypeReport> types;

  std::uint64_t frames = 0;  // different sample counters
  std::optional<std::uint32_t> first_counter;
  std::optional<std::uint32_t> last_counter;
  double usual_step = 1;
  std::uint32_t smallest_step = 0;
  std::uint32_t largest_step = 0;
  std::optional<std::uint64_t> lost;  // frames; none: the steps are too irregular to tell
  double rate_hz = 0;
  double capture_rate_hz = 0;
  std::optional<DelayReport> delays;  // where arrival is known
  std::int64_t longest_silence_nanos = 0;
  std::int64_t longest_silence_at_nanos = 0;  // since the beginning of the stream
  std::uint64_t samples = 0;                  // frames of which a sample could be made
  std::uint64_t incomplete = 0;
  std::uint64_t duplicates = 0;  // datagrams
  std::uint64_t late = 0;        // datagrams
  std::uint64_t outliers = 0;    // datagrams
  std::uint64_t restarts = 0;
  std::uint64_t odd_ids = 0;
  /// How many samples have what: "velocity", "joint angles", "gloves".
  std::map<std::string, std::uint64_t> quantities;
  std::vector<std::string> advice;  // what is missing, and what to switch on
};

struct ErrorReport {
  std::string reason;
  std::uint64_t count = 0;
  // The first of them:
  std::int64_t at_nanos = 0;  // since the beginning of the stream
  std::string sender;
  std::optional<ParseError> where;  // none: found when joining, or told by a file
};

struct InspectionReport {
  std::string source;
  std::string format;  // for people: "MVNX version 4"; whoever opened it knows
  bool is_live = false;
  bool has_datagrams = true;          // false: a file of samples
  bool has_arrival_times = true;      // false: a file of datagrams without
  std::int64_t begin_wall_nanos = 0;  // first and last datagram or sample; 0: none came
  std::int64_t end_wall_nanos = 0;
  double secs = 0;  // between them
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  std::optional<TransportCounters> transport;
  std::vector<CharacterReport> characters;
  std::uint64_t datagrams_not_kept = 0;  // of characters beyond the 64
  std::vector<ErrorReport> errors;       // most frequent first
  std::map<std::string, std::uint64_t> ignored;
  std::vector<std::string> advice;  // about the stream as a whole

  /// Whether there is anybody, or anything, to show.
  bool CanBeShown() const;
};

/// Of datagrams.
class Inspection : public DatagramSink {
 public:
  static constexpr std::size_t kMostCharacters = 64;

  explicit Inspection(bool is_live);
  ~Inspection() override;

  void OnDatagram(const ReceivedDatagram& datagram) override;

  /// Live: gives on what has waited long enough. Call when all that has come was handed over.
  void Expire(std::int64_t now_monotonic_nanos);

  /// Closes what is still open. `source`: what was read.
  InspectionReport Report(const DatagramSource& source);

 private:
  class Stream;

  Stream* FindStream(const Endpoint& sender, int character);
  void NoteError(Reason reason, std::uint64_t count, const Endpoint& sender,
                 const std::optional<ParseError>& where);
  void NoteJoinErrors(Stream& stream);

  const bool is_live_;
  std::vector<std::unique_ptr<Stream>> streams_;  // at most kMostCharacters
  std::uint64_t not_kept_ = 0;
  std::map<Reason, ErrorReport> errors_;
  std::uint64_t datagrams_ = 0;
  std::uint64_t bytes_ = 0;
  bool has_arrival_times_ = true;
  Arrival first_;
  Arrival last_;
};

/// Of samples, where there are no datagrams: MVNX, a bag, the built-in subject.
class SampleInspection : public SampleSink {
 public:
  static constexpr std::size_t kMostCharacters = 64;

  SampleInspection();
  ~SampleInspection() override;

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;

  InspectionReport Report(const Source& source) const;

 private:
  class Person;

  Person* Find(int id);
  void NoteTime(std::int64_t stamp_nanos);

  std::vector<std::unique_ptr<Person>> people_;
  std::uint64_t samples_ = 0;
  std::int64_t first_stamp_ = 0;
  std::int64_t last_stamp_ = 0;
};

}  // namespace kinescope::mvn
