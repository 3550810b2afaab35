// `kinescope stream`: a suit without a suit. Sends a recording or the subject as MVN datagrams.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <optional>
#include <string>

#include "server/app/clocks.h"
#include "server/app/commands.h"
#include "server/app/open_source.h"
#include "server/app/stop_signal.h"
#include "server/core/errors.h"
#include "server/mvn/sender.h"

namespace kinescope::app {
namespace {

struct StreamOptions {
  std::string source;
  std::string to = "udp://127.0.0.1:9763";
  double rate_hz = kSubjectRateHz;
  double seconds = 0;
  bool loop = false;
};

// Scale and meta data go out again this often, so that a receiver may start at any time.
constexpr std::int64_t kCharacterEveryNanos = 1'000'000'000;

class SendingSink : public SampleSink {
 public:
  explicit SendingSink(mvn::Sender& sender) : sender_(sender) {}

  void OnCharacter(const Character& character) override {
    character_ = character;
    sender_.SendCharacter(character);
    sent_character_nanos_ = MonotonicNanos();
  }

  void OnSample(const BodySample& sample) override {
    if (character_ && MonotonicNanos() - sent_character_nanos_ > kCharacterEveryNanos) {
      OnCharacter(Character(*character_));
    }
    sender_.SendSample(sample);
    ++samples_;
  }

  std::uint64_t samples() const { return samples_; }

 private:
  mvn::Sender& sender_;
  std::optional<Character> character_;
  std::int64_t sent_character_nanos_ = 0;
  std::uint64_t samples_ = 0;
};

void Stream(const StreamOptions& options) {
  if (!(options.rate_hz >= 1 && options.rate_hz <= 1000)) {
    throw UsageError(fmt::format("--rate_hz={}: expected 1 to 1000", options.rate_hz));
  }
  if (!(options.seconds >= 0)) {
    throw UsageError(fmt::format("--seconds={}: expected 0 (no end) or more", options.seconds));
  }
  const auto source = OpenAtTrueRate(options.source, options.loop, options.rate_hz);
  const auto sender = mvn::OpenUdpSender(options.to);
  SendingSink sink(*sender);
  spdlog::info("streaming {} to {} at {:g} samples a second", options.source, options.to,
               source->nominal_rate_hz());
  const std::int64_t end =
      options.seconds > 0 ? MonotonicNanos() + static_cast<std::int64_t>(options.seconds * 1e9) : 0;
  while (!StopRequested() && (end == 0 || MonotonicNanos() < end)) {
    if (source->Poll(std::chrono::milliseconds(20), sink) == Source::State::kEnded) break;
  }
  spdlog::info("sent {} samples in {} datagrams", sink.samples(), sender->datagrams_sent());
}

}  // namespace

void AddStream(CommandLine line) {
  CLI::App* command = line.app.add_subcommand(
      "stream", "Send a recording or the built-in subject as a suit would, over UDP");
  const auto o = std::make_shared<StreamOptions>();
  command->add_option("source", o->source, "file.mvnx, demo:lift, demo:walk")->required();
  command->add_option("--to", o->to, "udp://host:port of the receiver")->capture_default_str();
  command->add_option("--rate_hz", o->rate_hz, "samples a second of demo:; files have their own")
      ->capture_default_str();
  command->add_option("--seconds", o->seconds, "stop after so long; 0: at the end, or never");
  command->add_flag("--loop", o->loop, "start a file over when it ends");
  command->callback([o] { Stream(*o); });
}

}  // namespace kinescope::app
