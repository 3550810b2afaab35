// Sample in -> WebSocket client: connects N viewers to a running `kinescope serve` and prints how
// long after its arrival at the server's socket each sample reached them. Same machine, same clock.
//   page_viewers PORT VIEWERS SECONDS [pictures] [stalled=N] [back=N]
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/http/test_client.h"

namespace {

using kinescope::http::testing::WsClient;

double NowMicros() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Arrival of the sample, docs/http.md: state at byte 24, picture at byte 16.
double ArrivalMicros(const WsClient::Message& message) {
  double micros = 0;
  std::memcpy(&micros, message.bytes.data() + (message.IsState() ? 24 : 16), sizeof micros);
  return micros;
}

// What the page does while it plays five seconds back (web/held_run.js): it asks for half a second
// at a time, the next one when half of that has been shown.
class PlayingViewer {
 public:
  explicit PlayingViewer(WsClient& client) : client_(client) {
    client.Send("{\"few_states\":true}");
  }

  void AskIfDue() {
    const double now = NowMicros();
    if (is_waiting_ || now < due_) return;
    from_ = std::max(until_, now - kBehindMicros);
    client_.Send("{\"look\":{\"id\":1,\"micros\":" + std::to_string(std::llround(from_)) +
                 ",\"until_micros\":" + std::to_string(std::llround(from_ + kRunMicros)) +
                 ",\"every_micros\":12000}}");
    is_waiting_ = true;
  }

  // The number of former states in it.
  std::uint64_t OnPast(const WsClient::Message& message) {
    std::uint16_t count = 0;
    std::memcpy(&count, message.bytes.data() + 2, sizeof count);
    std::memcpy(&until_, message.bytes.data() + 8, sizeof until_);
    due_ = (from_ + until_) / 2 + kBehindMicros;
    is_waiting_ = false;
    return count;
  }

 private:
  static constexpr double kBehindMicros = 5e6, kRunMicros = 5e5;
  WsClient& client_;
  bool is_waiting_ = false;
  double from_ = 0, until_ = 0;  // of the run that is held: times of the server
  double due_ = 0;               // when to ask for the next one
};

void Print(const char* what, std::vector<double>& millis, double seconds, int viewers) {
  if (millis.empty()) return;
  std::sort(millis.begin(), millis.end());
  const auto at = [&](double part) {
    return millis[static_cast<std::size_t>(part * static_cast<double>(millis.size() - 1))];
  };
  std::printf("%s: %.1f a second and viewer; ms after arrival: p50 %.2f, p95 %.2f, p99 %.2f\n",
              what, static_cast<double>(millis.size()) / seconds / viewers, at(0.5), at(0.95),
              at(0.99));
}

int Usage() {
  std::fprintf(stderr,
               "page_viewers PORT VIEWERS SECONDS [pictures] [stalled=N] [back=N]\n"
               "stalled, back: so many of the viewers stop reading, or play five seconds back\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return Usage();
  const int port = std::atoi(argv[1]), viewers = std::atoi(argv[2]);
  const double seconds = std::atof(argv[3]);
  int stalled = 0, back = 0;
  bool with_pictures = false;
  for (int i = 4; i < argc; ++i) {
    if (std::strcmp(argv[i], "pictures") == 0) {
      with_pictures = true;
    } else if (std::sscanf(argv[i], "stalled=%d", &stalled) != 1 &&
               std::sscanf(argv[i], "back=%d", &back) != 1) {
      return Usage();
    }
  }
  std::mutex mutex;
  std::vector<double> states, pictures;  // ms, guarded by mutex
  std::atomic<std::uint64_t> past{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < viewers; ++i) {
    const bool is_stalled = i < stalled, looks_back = !is_stalled && i < stalled + back;
    threads.emplace_back([&, is_stalled, looks_back] {
      const double end = NowMicros() + seconds * 1e6;
      if (is_stalled) {
        constexpr int kSmallBufferBytes = 4096;
        const WsClient client(port, "/api/v1/ws", {}, kSmallBufferBytes);
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        return;
      }
      WsClient client(port);
      if (with_pictures) client.Send("{\"pictures\":true}");
      std::optional<PlayingViewer> playing;
      if (looks_back) playing.emplace(client);
      std::uint64_t last_state = 0;
      std::uint64_t seen_states = 0, seen_pictures = 0;
      client.Send("{\"seen_states\":0,\"seen_pictures\":0}");
      while (NowMicros() < end) {
        if (playing) playing->AskIfDue();
        const auto message = client.Receive();
        if (message.is_text) continue;
        if (message.IsPast()) {
          past += playing->OnPast(message);
          continue;
        }
        const double late = (NowMicros() - ArrivalMicros(message)) / 1e3;
        // As the page does (web/client.js), so that the server goes on sending.
        if (!message.IsState()) {
          client.Send("{\"seen_pictures\":" + std::to_string(++seen_pictures) + "}");
        } else if (++seen_states % 4 == 0) {
          client.Send("{\"seen_states\":" + std::to_string(seen_states) + "}");
        }
        if (message.IsState() && message.state_number() == last_state) continue;  // a heartbeat
        if (message.IsState()) last_state = message.state_number();
        if (looks_back) continue;
        const std::lock_guard<std::mutex> lock(mutex);
        (message.IsState() ? states : pictures).push_back(late);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  Print("states", states, seconds, viewers - stalled - back);
  Print("pictures", pictures, seconds, viewers - stalled - back);
  if (back > 0) {
    std::printf("past: %.1f a second and viewer\n",
                static_cast<double>(past) / seconds / static_cast<double>(back));
  }
  return 0;
}
