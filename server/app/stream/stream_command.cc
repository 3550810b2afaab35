// `kinescope stream`: a suit in a box. Sends any source as MVN does, with faults if asked for.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/finger_and_prop_segments.h"
#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/stream/stream_feed.h"
#include "server/app/stream/stream_transmission.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

constexpr int kMaxCopies = 16;

// The numbers of message types, as MVN writes them: "02,20".
class TypesValue : public options::ValueOf<std::optional<mvn::TypeSet>> {
 public:
  TypesValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  bool IsGiven() const override { return value_.has_value(); }
  std::string Expected() const override {
    return "some of 01,02,03,12,13,20,21,22,23,24,25, as listed by kinescope stream --help";
  }

 private:
  std::string text_;
};

// NAME=SHARE[:SECONDS], once or several times.
class FaultsValue : public options::ValueOf<mvn::FaultSettings> {
 public:
  FaultsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override { ParseAll(options::SplitItems(text)); }
  void ParseAll(const std::vector<std::string>& texts) override;
  bool is_repeatable() const override { return true; }
  std::string ToText() const override { return text_; }
  std::string Expected() const override {
    return "NAME=SHARE or NAME=SHARE:SECONDS, such as loss=0.05, as listed by kinescope stream "
           "--help";
  }
  std::vector<std::string> Names() const override { return mvn::FaultNames(); }

 private:
  std::string text_;
};

struct StreamOptions {
  options::Text source;
  options::Text to{"udp://127.0.0.1:9763"};
  options::Whole characters{1, {1, kMaxCopies}};
  TypesValue types;
  options::Optional<options::Number> rate_hz{options::Number(kSubjectRateHz, {1, 1000, "Hz"})};
  options::Number stream_hz{0, {0, 1000, "Hz", false, "0: every sample"}};
  options::Number speed{1, {0.01, 100}};
  options::Flag loop;
  options::Number seconds{0, {0, 1e9, "s", false, "0: to the end, or without end"}};
  options::Flag gloves;
  options::Whole props{0, {0, kMaxProps}};
  FaultsValue fault;
  options::Whole seed{1, {0, 4294967295.0}};
  options::Flag json;

  void List(options::OptionList& option) {
    option("source", source, "source of the samples to send: " + SourceKinds());
    option("to", to,
           "receiver: udp://host:port; tcp://host:port connects; tcp://:port?listen waits for "
           "receivers");
    option("characters", characters,
           "number of copies of each person, 1 m apart along y, ids from 0");
    option("types", types, "message types to send");
    option("rate_hz", rate_hz, "sample rate of the built-in subject; default: 120 Hz");
    option("stream_hz", stream_hz,
           "highest rate at which samples are sent; sample counters still count all samples");
    option("speed", speed, "speed of playing, relative to the recording");
    option("loop", loop, "start a file again at its end; counters and time codes continue");
    option("seconds", seconds, "length of the stream");
    option("gloves", gloves, "add moving fingers, 40 segments; only for sources of samples");
    option("props", props, "number of props to add; only for sources of samples");
    option("fault", fault, "fault to inject, with its share; may be repeated");
    option("seed", seed, "random seed of the faults");
    option("json", json, "print a summary of what was sent, as JSON");
    option.HasNoEffect("seed", "without --fault", [this] { return fault.ToText().empty(); });
  }
};

constexpr const char* kMore = R"(
Types (--types), as MVN numbers its messages:
  01 Euler pose  02 quaternion pose  03 virtual markers  12 meta data  13 scale data
  20 joint angles  21 linear and 22 angular kinematics  23 trackers  24 centre of mass  25 time code
  Sources of samples are encoded: 02 12 13 20 21 22 24 by default. Sources that are
  datagrams already (udp:, tcp:, pcap, .bin) are sent on byte for byte, those of --types only.

Faults (--fault NAME=SHARE, SHARE from 0 to 1; may be given several times; all=SHARE for every one):
  loss       of datagrams: gone
  duplicate  of datagrams: the same bytes again, up to 3 places later
  reorder    of datagrams: put back by 1 to 3 places
  jitter     of datagrams: delayed by up to 5 ms, in order; another delay: jitter=SHARE:SECONDS
  burst      of time: held back and sent at once after 0.1 s; longer: burst=SHARE:SECONDS
  truncate   of datagrams: cut short anywhere
  corrupt    of datagrams: 1 to 4 random bytes changed
  foreign    of datagrams: JSON, XML, other text or random bytes sent before it
  silence    of time: nothing is sent for 1 s; longer: silence=SHARE:SECONDS
  reset      of seconds: the character's sample counter and time code start over at 0
  The same --seed does the same to the same stream.

Examples:
  kinescope stream demo:lift
  kinescope stream demo:walk --characters 4 --rate_hz 240 --gloves --to tcp://192.168.1.20:9763
  kinescope stream take.pcap --loop --fault loss=0.05 --fault silence=0.1:3 --seed 7
  kinescope stream udp://:9763 --to udp://10.0.0.5:9763)";

void TypesValue::Parse(const std::string& text) {
  mvn::TypeSet types;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string digits = text.substr(at, end - at);
    // A header of that type tells whether there is one.
    const std::string datagram = "MXTP" + digits + std::string(mvn::kHeaderBytes - 6, '\0');
    const auto header = mvn::ParseHeader(datagram);
    if (digits.size() != 2 || !header) RefuseText();
    types.set(static_cast<std::size_t>(header->type));
    at = end + 1;
  }
  value_ = types;
  text_ = text;
}

void FaultsValue::ParseAll(const std::vector<std::string>& texts) try {
  mvn::FaultSettings settings;
  for (const std::string& text : texts) mvn::SetFault(text, settings);
  value_ = settings;
  text_ = fmt::format("{}", fmt::join(texts, ";"));
} catch (const UsageError& error) {
  throw options::BadValue(error.what());
}

// Nothing is opened before all options are known to fit together.
FeedSettings ToFeed(const StreamOptions& o) {
  if (*o.stream_hz != 0 && *o.stream_hz < 0.1) {
    throw UsageError(fmt::format("--stream_hz={}: expected 0.1 to 1000 Hz, or 0 for every sample",
                                 *o.stream_hz));
  }
  if (o.rate_hz && !IsSubjectUrl(*o.source)) {
    throw UsageError(fmt::format(
        "--rate_hz={}: only the built-in subject (demo:, pose:) has a free rate, not '{}'; use "
        "--stream_hz to send fewer samples",
        *o.rate_hz, *o.source));
  }
  FeedSettings feed;
  feed.source = *o.source;
  feed.rate_hz = o.rate_hz.value_or(kSubjectRateHz);
  feed.characters = static_cast<int>(*o.characters);
  feed.types = *o.types;
  feed.stream_hz = *o.stream_hz;
  feed.speed = *o.speed;
  feed.loop = *o.loop;
  feed.gloves = *o.gloves;
  feed.props = static_cast<int>(*o.props);
  return feed;
}

nlohmann::json FaultJson(const mvn::FaultCount& count, mvn::Fault fault) {
  nlohmann::json out = {{"injected", count.injected}, {"datagrams", count.datagrams}};
  if (fault == mvn::Fault::kTruncate || fault == mvn::Fault::kCorrupt) {
    out["detectable"] = count.detectable;
    out["undetectable"] = count.undetectable;
  }
  return out;
}

nlohmann::json Summary(const StreamOptions& o, const Feed& feed, const Transmission& sent,
                       const mvn::DatagramSender& sender, const mvn::FaultSettings& settings,
                       const mvn::FaultInjector& faults) {
  nlohmann::json summary = {{"source", feed.description()},
                            {"to", sender.description()},
                            {"seconds", sent.secs()},
                            {"samples", sent.samples()},
                            {"datagrams", sent.datagrams()},
                            {"bytes", sent.bytes()},
                            {"unsent", sender.datagrams_unsent()},
                            {"types", sent.types()},
                            {"seed", *o.seed},
                            {"faults", nlohmann::json::object()}};
  for (int i = 0; i < mvn::kFaultCount; ++i) {
    const auto fault = static_cast<mvn::Fault>(i);
    if (settings[fault] > 0) summary["faults"][Name(fault)] = FaultJson(faults.count(fault), fault);
  }
  return summary;
}

void LogSummary(const nlohmann::json& summary) {
  const auto unsent = summary["unsent"].get<std::uint64_t>();
  const auto datagrams = summary["datagrams"].get<std::uint64_t>();
  if (unsent > 0 && unsent == datagrams) {
    spdlog::error("sent nothing: no receiver took one of {} datagrams", datagrams);
    return;
  }
  spdlog::info("sent {} samples in {} datagrams, {:.1f} MB, in {:.1f} s",
               summary["samples"].get<std::uint64_t>(), datagrams,
               summary["bytes"].get<double>() * 1e-6, summary["seconds"].get<double>());
  for (const auto& [name, fault] : summary["faults"].items()) {
    std::string line = fmt::format("fault {}: {} times, {} datagrams", name,
                                   fault["injected"].get<std::uint64_t>(),
                                   fault["datagrams"].get<std::uint64_t>());
    if (fault.contains("undetectable")) {
      line += fmt::format("; {} detectable, {} not detectable from their content",
                          fault["detectable"].get<std::uint64_t>(),
                          fault["undetectable"].get<std::uint64_t>());
    }
    spdlog::info("{}", line);
  }
  if (unsent > 0) {
    spdlog::warn("{} datagrams not sent: no receiver connected, or receiver too slow", unsent);
  }
}

// @return whether anything was sent.
bool Stream(const StreamOptions& o) {
  const FeedSettings settings = ToFeed(o);
  const auto feed = OpenFeed(settings);
  const auto sender = mvn::OpenSender(*o.to);
  mvn::FaultInjector faults(*o.fault, static_cast<std::uint64_t>(*o.seed));
  spdlog::info("streaming {} to {}", feed->description(), sender->description());
  Transmission transmission(*feed, faults, *sender);
  transmission.Run(*o.seconds);
  const nlohmann::json summary = Summary(o, *feed, transmission, *sender, *o.fault, faults);
  LogSummary(summary);
  if (*o.json) Print("{}\n", JsonText(summary));
  return transmission.datagrams() == 0 || sender->datagrams_unsent() < transmission.datagrams();
}

}  // namespace

Command StreamCommand() {
  const auto values = std::make_shared<StreamOptions>();
  Command command = CommandNamed("stream");
  command.shows_progress = true;
  values->List(command.options);
  command.positionals = {"source"};
  command.required = {"source"};
  command.footer = kMore;
  command.run = [values](options::OptionList&) { return Stream(*values) ? 0 : 1; };
  return command;
}

}  // namespace kinescope::app
