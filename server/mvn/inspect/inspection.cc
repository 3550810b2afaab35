#include "server/mvn/inspect/inspection.h"

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "server/mvn/inspect/character.h"

namespace kinescope::mvn {
namespace {

// The number of items of a message of any type.
struct ItemCounter {
  template <class Item>
  int Of(const PerSegment<Item>& body) const {
    return static_cast<int>(body.present.count()) + body.skipped;
  }
  int operator()(const PoseMessage& body) const { return Of(body); }
  int operator()(const EulerPoseMessage& body) const { return Of(body); }
  int operator()(const LinearMessage& body) const { return Of(body); }
  int operator()(const AngularMessage& body) const { return Of(body); }
  int operator()(const MarkersMessage& body) const { return body.count; }
  int operator()(const JointAnglesMessage& body) const {
    return static_cast<int>(body.joints_present.count() + body.ergonomic_present.count()) +
           body.skipped;
  }
  int operator()(const TrackersMessage& body) const {
    return static_cast<int>(body.present.count()) + body.skipped;
  }
  int operator()(const CenterOfMassMessage&) const { return 1; }
  int operator()(const TimeCodeMessage&) const { return 1; }
  int operator()(const MetaDataMessage&) const { return 1; }
  int operator()(const ScaleMessage& body) const {
    return static_cast<int>(body.segments.size() + body.points.size());
  }
};

// Reasons that a single datagram cannot show.
constexpr int kFirstJoinReason = static_cast<int>(Reason::kPartsContradict);

// Longer than any message waits for its rest: scale data with a lost part.
constexpr std::int64_t kLongWaitNanos = kNanosPerSecond;

std::string SenderName(const Endpoint& sender) {
  return sender == Endpoint() ? "" : Format(sender);
}

}  // namespace

std::string DialogName(int type) {
  switch (static_cast<Type>(type)) {
    case Type::kEulerPose: return "Position + Orientation (Euler)";
    case Type::kPose: return "Position + Orientation (Quaternion)";
    case Type::kMarkers: return "Virtual Optical Marker Set";
    case Type::kMetaData: return "Character Meta Data";
    case Type::kScale: return "Scaling Data";
    case Type::kJointAngles: return "Joint Angles";
    case Type::kLinear: return "Linear Segment Kinematics";
    case Type::kAngular: return "Angular Segment Kinematics";
    case Type::kTrackers: return "Tracker Kinematics";
    case Type::kCenterOfMass: return "Center of Mass";
    case Type::kTimeCode: return "Time Code";
  }
  return "";
}

bool InspectionReport::CanBeShown() const {
  return std::any_of(characters.begin(), characters.end(),
                     [](const CharacterReport& character) { return character.samples > 0; });
}

// One (sender, character) pair, assembled separately, so that the counts are its own.
class Inspection::Stream {
 public:
  Stream(const Endpoint& sender, int character) : sender_(sender), character_(character) {}

  const Endpoint& sender() const { return sender_; }
  int character() const { return character_; }
  std::uint64_t datagrams() const { return datagrams_; }

  void Add(const Header& header, const Message* message, const ReceivedDatagram& datagram) {
    ++datagrams_;
    bytes_ += datagram.bytes.size();
    if (header.payload_bytes == 0 && datagram.bytes.size() > kHeaderBytes) has_old_header_ = true;
    if (message != nullptr) {
      CountType(*message, datagram);
      if (BelongsToSample(header.type)) {
        frames_.Add(static_cast<int>(header.type), header.sample_counter, header.time_code_millis,
                    datagram.arrival);
      }
    }
    assembler_.Add(sender_, datagram.bytes, datagram.arrival, tally_);
  }

  void Expire(std::int64_t now) { assembler_.Expire(now, tally_); }
  /// End of the stream. A frame cut off by the end does not count as incomplete.
  void Close(std::int64_t now) {
    incomplete_ = assembler_.tally().incomplete;
    assembler_.Expire(now, tally_);
    assembler_.Flush(tally_);
  }

  /// Number of errors with `reason` found when assembling, since the last call.
  std::uint64_t TakeJoinErrors(Reason reason) {
    const std::uint64_t count = assembler_.tally().rejected[static_cast<std::size_t>(reason)];
    std::uint64_t& seen = join_errors_seen_[static_cast<std::size_t>(reason)];
    return count - std::exchange(seen, count);
  }

  CharacterReport Report(std::int64_t begin_monotonic, bool has_arrival_times) const;

 private:
  struct TypeTally {
    TypeReport report;
    std::int64_t first_nanos = 0;
    std::int64_t last_nanos = 0;
  };

  void CountType(const Message& message, const ReceivedDatagram& datagram) {
    TypeTally& tally = types_[message.header.type];
    const int items = std::visit(ItemCounter(), message.body);
    TypeReport& report = tally.report;
    if (report.datagrams++ == 0) {
      report.type = static_cast<int>(message.header.type);
      report.fewest_items = items;
      tally.first_nanos = datagram.arrival.monotonic_nanos;
    }
    report.bytes += datagram.bytes.size();
    report.fewest_items = std::min(report.fewest_items, items);
    report.most_items = std::max(report.most_items, items);
    tally.last_nanos = datagram.arrival.monotonic_nanos;
  }

  const Endpoint sender_;
  const int character_;
  std::uint64_t datagrams_ = 0;
  std::uint64_t bytes_ = 0;
  bool has_old_header_ = false;
  std::map<Type, TypeTally> types_;
  FrameTrack frames_;
  Assembler assembler_{{Stamps::kFitted, Delivery::kPrompt}};  // as the server assembles it
  CharacterTally tally_;
  std::uint64_t incomplete_ = 0;
  std::array<std::uint64_t, kReasonCount> join_errors_seen_{};
};

CharacterReport Inspection::Stream::Report(std::int64_t begin_monotonic,
                                           bool has_arrival_times) const {
  CharacterReport report;
  report.sender = SenderName(sender_);
  report.id = character_;
  tally_.Fill(report);
  report.datagrams = datagrams_;
  report.bytes = bytes_;
  report.has_old_header = has_old_header_;
  for (const auto& [type, tally] : types_) {
    TypeReport filled = tally.report;
    const std::int64_t nanos = tally.last_nanos - tally.first_nanos;
    if (nanos > 0) {
      filled.rate_hz = static_cast<double>(filled.datagrams - 1) * 1e9 / static_cast<double>(nanos);
    }
    if (BelongsToSample(type) && frames_.frames() > 0) {
      filled.share = static_cast<double>(frames_.frames_with(filled.type)) /
                     static_cast<double>(frames_.frames());
    }
    report.types.push_back(filled);
  }
  FillFrames(frames_, begin_monotonic, report);
  const DurationHistogram& delays = frames_.delays();
  if (has_arrival_times && delays.total() > 0) {
    report.delays = DelayReport{delays.PercentileNanos(0.5), delays.PercentileNanos(0.95),
                                delays.PercentileNanos(0.99), delays.longest_nanos()};
  }
  const Tally& joined = assembler_.tally();
  report.incomplete = incomplete_;
  report.duplicates = joined.duplicates;
  report.late = joined.late;
  report.outliers = joined.outliers;
  report.restarts = std::max(joined.restarts, frames_.restarts());
  report.mismatched_ids = joined.mismatched_ids;
  report.advice = AdviceFor(report, tally_.has_scale(), tally_.has_name());
  return report;
}

Inspection::Inspection(bool is_live) : is_live_(is_live) {}
Inspection::~Inspection() = default;

void Inspection::OnDatagram(const ReceivedDatagram& datagram) {
  if (datagrams_++ == 0) first_ = datagram.arrival;
  last_ = datagram.arrival;
  bytes_ += datagram.bytes.size();
  if (!is_live_ && datagram.from == Endpoint()) has_arrival_times_ = false;

  const auto message = ParseDatagram(datagram.bytes);
  if (!message) NoteError(message.error().reason, 1, datagram.from, message.error());
  // Also for a corrupt message, so that it counts for the character in its header.
  const auto header = message ? message->header : ParseHeader(datagram.bytes);
  if (!header) return;
  Stream* const stream = FindStream(datagram.from, header->character);
  if (stream == nullptr) {
    ++not_kept_;
    return;
  }
  // In a capture the packets define the time, so samples that fall due between two packets are
  // delivered now.
  if (!is_live_) stream->Expire(datagram.arrival.monotonic_nanos);
  stream->Add(*header, message ? &*message : nullptr, datagram);
  NoteJoinErrors(*stream);
}

Inspection::Stream* Inspection::FindStream(const Endpoint& sender, int character) {
  for (const auto& stream : streams_) {
    if (stream->character() == character && stream->sender() == sender) return stream.get();
  }
  if (streams_.size() < kMaxCharacters) {
    streams_.push_back(std::make_unique<Stream>(sender, character));
    return streams_.back().get();
  }
  // Corrupt headers contain characters that do not exist: the oldest one with a single datagram
  // makes room.
  for (auto& stream : streams_) {
    if (stream->datagrams() > 1) continue;
    not_kept_ += stream->datagrams();
    stream = std::make_unique<Stream>(sender, character);
    return stream.get();
  }
  return nullptr;
}

void Inspection::NoteError(Reason reason, std::uint64_t count, const Endpoint& sender,
                           const std::optional<ParseError>& where) {
  ErrorReport& error = errors_[reason];
  if (error.count == 0) {
    error.reason = Text(reason);
    error.at_nanos = last_.monotonic_nanos - first_.monotonic_nanos;
    error.sender = SenderName(sender);
    error.where = where;
  }
  error.count += count;
}

void Inspection::NoteJoinErrors(Stream& stream) {
  for (int i = kFirstJoinReason; i < kReasonCount; ++i) {
    const auto reason = static_cast<Reason>(i);
    const std::uint64_t count = stream.TakeJoinErrors(reason);
    if (count > 0) NoteError(reason, count, stream.sender(), std::nullopt);
  }
}

void Inspection::Expire(std::int64_t now_monotonic_nanos) {
  for (const auto& stream : streams_) {
    stream->Expire(now_monotonic_nanos);
    NoteJoinErrors(*stream);
  }
}

InspectionReport Inspection::Report(const DatagramSource& source) {
  InspectionReport report;
  report.source = source.description();
  report.is_live = is_live_;
  report.has_arrival_times = has_arrival_times_;
  report.begin_wall_nanos = first_.wall_nanos;
  report.end_wall_nanos = last_.wall_nanos;
  report.secs = static_cast<double>(last_.monotonic_nanos - first_.monotonic_nanos) * 1e-9;
  report.datagrams = datagrams_;
  report.bytes = bytes_;
  report.transport = source.counters();
  for (const auto& stream : streams_) {
    stream->Close(last_.monotonic_nanos + kLongWaitNanos);
    NoteJoinErrors(*stream);
    report.characters.push_back(stream->Report(first_.monotonic_nanos, has_arrival_times_));
  }
  // A character in a single corrupt header, in a stream of others, does not exist.
  const auto is_one_datagram = [](const auto& character) { return character.datagrams == 1; };
  auto& all = report.characters;
  if (!std::all_of(all.begin(), all.end(), is_one_datagram)) {
    const auto ghosts = std::remove_if(all.begin(), all.end(), is_one_datagram);
    not_kept_ += static_cast<std::uint64_t>(all.end() - ghosts);
    all.erase(ghosts, all.end());
  }
  report.datagrams_not_kept = not_kept_;
  for (const auto& [reason, error] : errors_) report.errors.push_back(error);
  std::stable_sort(report.errors.begin(), report.errors.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  report.advice = AdviceFor(report);
  return report;
}

}  // namespace kinescope::mvn
