#include "server/mvn/assembler.h"

#include <algorithm>
#include <functional>

#include "server/mvn/giving_way.h"

namespace kinescope::mvn {
namespace {

// The restart of a sender takes longer than this. A running sender is silent for this long only if
// the network is.
constexpr std::int64_t kTakeOverNanos = 100'000'000;
constexpr std::int64_t kForgetNanos = 3'000'000'000;

}  // namespace

void Assembler::Add(const Endpoint& sender, std::string_view datagram, const Arrival& arrival,
                    SampleSink& sink) {
  ++tally_.datagrams;
  tally_.bytes += datagram.size();
  const auto message = ParseDatagram(datagram);
  if (!message) return tally_.Reject(message.error().reason);
  tally_.CountType(message->header.type);
  const auto stream = FindStream(
      {sender, message->header.character, HasWholeBody(*message), arrival.monotonic_nanos}, sink);
  if (!stream) return tally_.Reject(stream.error());
  const std::size_t hash = std::hash<std::string_view>()(datagram);
  (*stream)->state.Add(*message, static_cast<std::uint32_t>(hash), arrival, sink);
}

tl::expected<Assembler::Stream*, Reason> Assembler::FindStream(const Newcomer& newcomer,
                                                               SampleSink& sink) {
  const auto& [sender, character, has_whole_body, now] = newcomer;
  for (const auto& stream : streams_) {
    if (stream->sender == sender && stream->sent_character == character) return stream.get();
  }
  bool has_rival = false;  // still sending, and perhaps the same sender before its restart
  for (const auto& stream : streams_) {
    const bool same_machine = stream->sender.address == sender.address;
    if (!same_machine || stream->sent_character != character) continue;
    if (now - stream->state.last_heard_nanos() <= kTakeOverNanos) {
      has_rival = true;
      continue;
    }
    stream->sender = sender;
    stream->state.SenderRestarted(sink);
    ++tally_.restarts;
    return stream.get();
  }
  if (has_rival && IsOnTrial(sender, character, now)) {
    return tl::make_unexpected(Reason::kSecondSender);
  }
  Stream* const added = AddStream(newcomer, sink);
  if (added == nullptr) return tl::make_unexpected(Reason::kTooManyStreams);
  return added;
}

bool Assembler::IsOnTrial(const Endpoint& sender, int character, std::int64_t now) {
  const auto is_old = [now](const Trial& trial) { return now - trial.since_nanos > kForgetNanos; };
  trials_.erase(std::remove_if(trials_.begin(), trials_.end(), is_old), trials_.end());
  for (const Trial& trial : trials_) {
    if (trial.sender == sender && trial.sent_character == character) {
      return now - trial.since_nanos <= kTakeOverNanos;
    }
  }
  if (trials_.size() < kMaxStreams) trials_.push_back({sender, character, now});
  return true;
}

Assembler::Stream* Assembler::AddStream(const Newcomer& newcomer, SampleSink& sink) {
  if (!MakeRoom(newcomer, sink)) return nullptr;
  streams_.push_back(std::make_unique<Stream>(
      Stream{newcomer.sender, newcomer.character, newcomer.now,
             CharacterStream(FreeId(newcomer.character), settings_, tally_)}));
  return streams_.back().get();
}

// The stream that gives way, if there is one.
Assembler::Streams::iterator Assembler::VictimOf(const Newcomer& newcomer) {
  const auto is_silent = [&](const auto& stream) {
    return newcomer.now - stream->state.last_heard_nanos() > kForgetNanos;
  };
  const auto has_its_id = [&](const auto& stream) {
    return is_silent(stream) && stream->state.id() == newcomer.character;
  };
  const auto namesake = std::find_if(streams_.begin(), streams_.end(), has_its_id);
  if (namesake != streams_.end() || streams_.size() < kMaxStreams) return namesake;
  const auto silent = std::find_if(streams_.begin(), streams_.end(), is_silent);
  if (silent != streams_.end()) return silent;
  std::vector<PlaceHolder> holders;
  for (const auto& stream : streams_) {
    const bool has_body = newcomer.now - stream->state.last_given_nanos() <= kForgetNanos;
    holders.push_back(
        {stream->sender, has_body, stream->state.is_confirmed(), stream->since_nanos});
  }
  const auto victim = WhoGivesWay(holders, newcomer.sender, newcomer.has_whole_body);
  // Asked twice: a thousand false senders may send one datagram each.
  if (!victim || !HasKnocked(newcomer)) return streams_.end();
  return streams_.begin() + static_cast<std::ptrdiff_t>(*victim);
}

// Whether the newcomer was turned away before, of late.
bool Assembler::HasKnocked(const Newcomer& newcomer) {
  const Knock knock{newcomer.sender, newcomer.character};
  const bool is_known = std::find(knocks_.begin(), knocks_.end(), knock) != knocks_.end();
  if (!is_known) {
    if (knocks_.size() < kMaxKnocks) knocks_.emplace_back();
    knocks_[next_knock_++ % kMaxKnocks] = knock;
  }
  return is_known;
}

bool Assembler::MakeRoom(const Newcomer& newcomer, SampleSink& sink) {
  const auto victim = VictimOf(newcomer);
  if (victim == streams_.end()) return streams_.size() < kMaxStreams;
  if ((*victim)->state.is_confirmed()) {
    (*victim)->state.SenderRestarted(sink);  // delivers its open samples
  } else {
    (*victim)->state.Discard();
  }
  streams_.erase(victim);
  return true;
}

int Assembler::FreeId(int wanted) const {
  const auto taken = [this](int id) {
    return std::any_of(streams_.begin(), streams_.end(),
                       [id](const auto& stream) { return stream->state.id() == id; });
  };
  if (!taken(wanted)) return wanted;
  int id = 0;
  while (taken(id)) ++id;
  return id;
}

void Assembler::DiscardUnconfirmed(std::int64_t now) {
  const auto is_stray = [now](const std::unique_ptr<Stream>& stream) {
    if (stream->state.is_confirmed() || now - stream->state.last_heard_nanos() < kForgetNanos) {
      return false;
    }
    stream->state.Discard();
    return true;
  };
  streams_.erase(std::remove_if(streams_.begin(), streams_.end(), is_stray), streams_.end());
}

void Assembler::Flush(SampleSink& sink) {
  for (const auto& stream : streams_) stream->state.Flush(sink);
}

void Assembler::Expire(std::int64_t now_monotonic_nanos, SampleSink& sink) {
  DiscardUnconfirmed(now_monotonic_nanos);
  for (const auto& stream : streams_) stream->state.Expire(now_monotonic_nanos, sink);
}

std::optional<std::int64_t> Assembler::deadline_nanos() const {
  std::optional<std::int64_t> earliest;
  for (const auto& stream : streams_) {
    auto deadline = stream->state.deadline_nanos();
    if (!stream->state.is_confirmed()) {
      const std::int64_t discard = stream->state.last_heard_nanos() + kForgetNanos;
      deadline = deadline ? std::min(*deadline, discard) : discard;
    }
    if (deadline && (!earliest || *deadline < *earliest)) earliest = deadline;
  }
  return earliest;
}

}  // namespace kinescope::mvn
