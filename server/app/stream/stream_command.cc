// `kinescope stream`: a suit in a box. Sends any source as MVN does, with faults if asked for.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/extra_segments.h"
#include "core/json_text.h"
#include "server/app/commands.h"
#include "server/app/stream/stream_feed.h"
#include "server/app/stream/stream_transmission.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

constexpr int kMostCopies = 16;

struct StreamOptions {
  FeedSettings feed;
  std::string to = "udp://127.0.0.1:9763";
  std::string types;
  double rate_hz = kSubjectRateHz;
  bool rate_is_given = false;
  double seconds = 0;
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  bool as_json = false;
};

constexpr const char* kMore = R"(
Types (--types), as MVN numbers its messages:
  01 Euler pose  02 quaternion pose  03 virtual markers  12 meta data  13 scale data
  20 joint angles  21 linear and 22 angular kinematics  23 trackers  24 centre of mass  25 time code
  Sources of samples are encoded: 02 12 13 20 21 22 24 unless told otherwise. Sources that are
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

// "02,20": the numbers of types.
mvn::TypeSet ParseTypes(const std::string& text) {
  mvn::TypeSet types;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string digits = text.substr(at, end - at);
    // A header of that type tells whether there is one.
    const std::string datagram = "MXTP" + digits + std::string(mvn::kHeaderBytes - 6, '\0');
    const auto header = mvn::ParseHeader(datagram);
    if (digits.size() != 2 || !header) {
      throw UsageError(fmt::format(
          "--types={}: '{}' is no type; expected some of 01,02,03,12,13,20,21,22,23,24,25", text,
          digits));
    }
    types.set(static_cast<std::size_t>(header->type));
    at = end + 1;
  }
  return types;
}

template <class Number>
void RequireRange(const char* flag, Number value, Number low, Number high,
                  const char* also = nullptr) {
  if (value >= low && value <= high) return;
  throw UsageError(fmt::format("{}={}: expected {} to {}{}", flag, value, low, high,
                               also == nullptr ? "" : also));
}

// Options as settings. Nothing is opened before all of them are known to be right.
mvn::FaultSettings Check(StreamOptions& o) {
  RequireRange("--characters", o.feed.characters, 1, kMostCopies);
  RequireRange("--props", o.feed.props, 0, kMostProps);
  RequireRange("--rate_hz", o.rate_hz, 1.0, 1000.0);
  RequireRange("--speed", o.feed.speed, 0.01, 100.0);
  if (o.feed.stream_hz != 0) {
    RequireRange("--stream_hz", o.feed.stream_hz, 0.1, 1000.0, ", or 0 for every sample");
  }
  if (!(o.seconds >= 0 && o.seconds <= 1e9)) {
    throw UsageError(fmt::format("--seconds={}: expected 0 (no end) or more", o.seconds));
  }
  if (o.rate_is_given && o.feed.source.rfind("demo:", 0) != 0) {
    throw UsageError(
        fmt::format("--rate_hz={}: '{}' has its own rate; only demo: is made at any (to send fewer "
                    "samples: --stream_hz)",
                    o.rate_hz, o.feed.source));
  }
  o.feed.rate_hz = o.rate_hz;
  if (!o.types.empty()) o.feed.types = ParseTypes(o.types);
  mvn::FaultSettings faults;
  for (const std::string& text : o.faults) mvn::SetFault(text, faults);
  return faults;
}

nlohmann::json ToJson(const mvn::FaultCount& count, mvn::Fault fault) {
  nlohmann::json json = {{"injected", count.injected}, {"datagrams", count.datagrams}};
  if (fault == mvn::Fault::kTruncate || fault == mvn::Fault::kCorrupt) {
    json["refused"] = count.refused;
    json["silent"] = count.silent;
  }
  return json;
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
                            {"seed", o.seed},
                            {"faults", nlohmann::json::object()}};
  for (int i = 0; i < mvn::kFaultCount; ++i) {
    const auto fault = static_cast<mvn::Fault>(i);
    if (settings[fault] > 0) summary["faults"][Name(fault)] = ToJson(faults.count(fault), fault);
  }
  return summary;
}

void LogSummary(const nlohmann::json& summary) {
  spdlog::info("sent {} samples in {} datagrams, {:.1f} MB, in {:.1f} s",
               summary["samples"].get<std::uint64_t>(), summary["datagrams"].get<std::uint64_t>(),
               summary["bytes"].get<double>() * 1e-6, summary["seconds"].get<double>());
  for (const auto& [name, fault] : summary["faults"].items()) {
    std::string line = fmt::format("fault {}: {} times, {} datagrams", name,
                                   fault["injected"].get<std::uint64_t>(),
                                   fault["datagrams"].get<std::uint64_t>());
    if (fault.contains("silent")) {
      line +=
          fmt::format("; {} can be told from their bytes, {} cannot",
                      fault["refused"].get<std::uint64_t>(), fault["silent"].get<std::uint64_t>());
    }
    spdlog::info("{}", line);
  }
  const auto unsent = summary["unsent"].get<std::uint64_t>();
  if (unsent > 0) {
    spdlog::warn("{} datagrams found no receiver: nobody was connected, or read too slowly",
                 unsent);
  }
}

void Stream(StreamOptions& o) {
  const mvn::FaultSettings settings = Check(o);
  const auto feed = OpenFeed(o.feed);
  const auto sender = mvn::OpenSender(o.to);
  mvn::FaultInjector faults(settings, o.seed);
  spdlog::info("streaming {} to {}", feed->description(), sender->description());
  Transmission transmission(*feed, faults, *sender);
  transmission.Run(o.seconds);
  const nlohmann::json summary = Summary(o, *feed, transmission, *sender, settings, faults);
  LogSummary(summary);
  if (o.as_json) fmt::print("{}\n", JsonText(summary, 2));
}

}  // namespace

void AddStream(CommandLine line) {
  CLI::App* command = line.app.add_subcommand(
      "stream", "Send any source as a suit would, over UDP or TCP, with faults if asked for");
  const auto o = std::make_shared<StreamOptions>();
  command->add_option("source", o->feed.source, kSourceKinds)->required();
  command
      ->add_option("--to", o->to,
                   "receiver: udp://host:port; tcp://host:port connects; tcp://:port?listen waits "
                   "for receivers")
      ->capture_default_str();
  command
      ->add_option("--characters", o->feed.characters,
                   "1 to 16: so many of everybody, 1 m apart along y, ids from 0")
      ->capture_default_str();
  command->add_option("--types", o->types, "message types to send, such as 02,20,24 (see below)");
  const CLI::Option* const rate =
      command->add_option("--rate_hz", o->rate_hz, "samples a second of demo:, 1 to 1000")
          ->capture_default_str();
  command->add_option("--stream_hz", o->feed.stream_hz,
                      "send only so many of the samples captured in a second; the counter goes on "
                      "counting all; 0: every sample");
  command->add_option("--speed", o->feed.speed, "times as fast as captured, 0.01 to 100")
      ->capture_default_str();
  command->add_flag("--loop", o->feed.loop,
                    "start a file over at its end; counters and time codes go on");
  command->add_option("--seconds", o->seconds, "stop after so long; 0: at the end, or never");
  command->add_flag("--gloves", o->feed.gloves,
                    "add moving fingers: 40 segments (sources of samples only)");
  command->add_option("--props", o->feed.props, "add so many props, 0 to 4 (likewise)");
  command->add_option("--fault", o->faults, "NAME=SHARE[:SECONDS], such as loss=0.05 (see below)")
      ->allow_extra_args(false);
  command->add_option("--seed", o->seed, "of the faults")->capture_default_str();
  command->add_flag("--json", o->as_json, "print what was sent as JSON");
  command->footer(kMore);
  command->callback([o, rate] {
    o->rate_is_given = rate->count() > 0;
    Stream(*o);
  });
}

}  // namespace kinescope::app
