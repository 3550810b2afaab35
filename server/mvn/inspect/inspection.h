/// Analyses a stream: senders, messages, regularity, losses, errors, and the settings to change in
/// MVN. Feed it all datagrams, then request the report. It keeps at most 64 (sender, character)
/// pairs and counts the datagrams of others; percentiles come from histograms of fixed size. So its
/// memory does not grow with the stream. One thread.
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

/// The name of a message type in MVN's network streamer dialog: "Position + Orientation
/// (Quaternion)". "" for an unknown type.
std::string DialogName(int type);

struct TypeReport {
  int type = 2;  // MXTP02
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  double rate_hz = 0;    // datagrams per second while it was sent; 0: only one datagram
  int fewest_items = 0;  // in one datagram
  int most_items = 0;
  /// Share of all frames that have this type, 0 to 1; absent for 12 and 13, which belong to no
  /// frame.
  std::optional<double> share;
};

struct DelayReport {  // ns, relative to the fastest frames of the last seconds
  std::int64_t median = 0;
  std::int64_t p95 = 0;
  std::int64_t p99 = 0;
  std::int64_t longest = 0;
};

/// The level on which the feet of a person rest.
struct FloorReport {
  double height_m = 0;  // world
  std::string why_not;  // why it was not found; "" otherwise
};

enum class CharacterKind { kUnknown, kPerson, kObjects };

/// One character of one sender, or the person in a file.
struct CharacterReport {
  std::string sender;  // "192.168.1.20:9763"; "" without datagrams or if unknown
  int id = 0;          // as sent
  std::string name;
  std::optional<std::uint32_t> color_rgb;
  CharacterKind kind = CharacterKind::kUnknown;
  std::optional<double> height_m;  // from the scale data
  int body_segments = 0;           // per sample: 23, or 0 without a body
  int objects = 0;
  int left_fingers = 0;
  int right_fingers = 0;
  int props = 0;
  std::vector<std::string> names;  // of props or objects, from the scale data

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
  std::optional<std::uint64_t> lost;  // missing frames; absent: steps too irregular
  double rate_hz = 0;
  double capture_rate_hz = 0;
  std::optional<DelayReport> delays;  // if receive times are known
  std::int64_t longest_silence_nanos = 0;
  std::int64_t longest_silence_at_nanos = 0;  // since the beginning of the stream
  std::uint64_t samples = 0;                  // frames that made a sample
  std::uint64_t incomplete = 0;
  std::uint64_t duplicates = 0;  // datagrams
  std::uint64_t late = 0;        // datagrams
  std::uint64_t outliers = 0;    // datagrams
  std::uint64_t restarts = 0;
  std::uint64_t mismatched_ids = 0;
  /// Number of samples per quantity: "velocity", "joint angles", "gloves".
  std::map<std::string, std::uint64_t> quantities;
  std::optional<FloorReport> floor;  // of a person in a file; set by the code that opened it
  std::vector<std::string> advice;   // what is missing, and what to switch on in MVN
};

struct ErrorReport {
  std::string reason;
  std::uint64_t count = 0;
  // The first occurrence:
  std::int64_t at_nanos = 0;  // since the beginning of the stream
  std::string sender;
  std::optional<ParseError> where;  // absent: detected when assembling, or in a file
};

struct InspectionReport {
  std::string source;
  std::string format;  // "MVNX version 4"; set by the code that opened it
  bool is_live = false;
  bool has_datagrams = true;          // false: a file of samples
  bool has_arrival_times = true;      // false: a file of datagrams without receive times
  std::int64_t begin_wall_nanos = 0;  // first and last datagram or sample; 0: none
  std::int64_t end_wall_nanos = 0;
  double secs = 0;  // between them
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  std::optional<TransportCounters> transport;
  std::vector<CharacterReport> characters;
  std::uint64_t datagrams_not_kept = 0;  // of characters beyond kMaxCharacters
  std::vector<ErrorReport> errors;       // most frequent first
  std::map<std::string, std::uint64_t> ignored;
  std::vector<std::string> advice;  // about the stream as a whole

  /// Whether there is a person or an object to show.
  bool CanBeShown() const;
};

/// Inspects datagrams.
class Inspection : public DatagramSink {
 public:
  static constexpr std::size_t kMaxCharacters = 64;

  explicit Inspection(bool is_live);
  ~Inspection() override;

  void OnDatagram(const ReceivedDatagram& datagram) override;

  /// Live: delivers the samples whose waiting time is over. Call it when all received datagrams
  /// were added.
  void Expire(std::int64_t now_monotonic_nanos);

  /// Closes all open samples and returns the report. `source`: the inspected source.
  InspectionReport Report(const DatagramSource& source);

 private:
  class Stream;

  Stream* FindStream(const Endpoint& sender, int character);
  void NoteError(Reason reason, std::uint64_t count, const Endpoint& sender,
                 const std::optional<ParseError>& where);
  void NoteJoinErrors(Stream& stream);

  const bool is_live_;
  std::vector<std::unique_ptr<Stream>> streams_;  // at most kMaxCharacters
  std::uint64_t not_kept_ = 0;
  std::map<Reason, ErrorReport> errors_;
  std::uint64_t datagrams_ = 0;
  std::uint64_t bytes_ = 0;
  bool has_arrival_times_ = true;
  Arrival first_;
  Arrival last_;
};

/// Inspects samples where there are no datagrams: MVNX, a bag, the built-in subject.
class SampleInspection : public SampleSink {
 public:
  static constexpr std::size_t kMaxCharacters = 64;

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
