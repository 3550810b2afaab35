// Sends what nobody should: hostile datagrams of one kind or of all, as from eight other machines
// (127.0.0.2 to 127.0.0.9), at a given rate, to a Kinescope that listens on this one. Prints how
// many it sent.
//   hostile_senders PORT KIND RATE SECONDS
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/body_sample.h"
#include "server/mvn/encode.h"
#include "server/subject/subject.h"

namespace {

using kinescope::Character;
namespace mvn = kinescope::mvn;
namespace subject = kinescope::subject;
namespace urdf = kinescope::urdf;

class Attacker {
 public:
  explicit Attacker(int port) {
    for (std::size_t i = 0; i < kMachines; ++i) {
      sockets_[i] = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
      const sockaddr_in from = Address("127.0.0." + std::to_string(2 + i), 0);
      const sockaddr_in to = Address("127.0.0.1", port);
      if (::bind(sockets_[i], reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0 ||
          ::connect(sockets_[i], reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
        std::perror("hostile_senders");
        std::exit(2);
      }
    }
  }

  // One hostile datagram, or the few that belong together.
  void Send(const std::string& kind) {
    const auto& kinds = Kinds();
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (kind == kinds[i].first) return kinds[i].second(*this);
    }
    kinds[next_++ % kinds.size()].second(*this);
  }

  std::uint64_t sent() const { return sent_; }

  using Kind = std::pair<const char*, void (*)(Attacker&)>;
  static const std::vector<Kind>& Kinds() {
    static const std::vector<Kind> kKinds = {
        {"names", [](Attacker& a) { a.SendCharacter(true, false, false); }},
        {"colors", [](Attacker& a) { a.SendCharacter(false, true, false); }},
        {"lengths", [](Attacker& a) { a.SendCharacter(false, false, true); }},
        {"poses", [](Attacker& a) { a.SendPose(0); }},
        {"far", [](Attacker& a) { a.SendPose(9e5); }},
        {"garbage", [](Attacker& a) { a.SendGarbage(); }},
        {"truncated", [](Attacker& a) { a.SendDamaged(true); }},
        {"corrupt", [](Attacker& a) { a.SendDamaged(false); }},
        {"strangers", [](Attacker& a) { a.SendStranger(); }},
        {"visitors", [](Attacker& a) { a.SendVisitor(); }},
    };
    return kKinds;
  }

 private:
  static constexpr std::size_t kMachines = 8;

  static sockaddr_in Address(const std::string& host, int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, host.c_str(), &address.sin_addr);
    return address;
  }

  // What the kernel does not take, or nobody receives, is sent all the same.
  void Give(const std::string& datagram, std::size_t machine = 0) {
    static_cast<void>(::send(sockets_[machine], datagram.data(), datagram.size(), 0));
    ++sent_;
  }

  void SendCharacter(bool name, bool color, bool lengths) {
    Character character;
    character.id = 100 + static_cast<int>(random_() % 4);
    character.name = name ? "N" + std::to_string(random_()) : "Mallory";
    character.color_rgb = color ? static_cast<std::uint32_t>(random_() & 0xffffff) : 0x808080;
    if (lengths) {
      character.skeleton = urdf::DefaultSkeleton(1.5 + 0.5 * Share());
      for (const std::string& part : mvn::EncodeCharacter(character)) Give(part);
      return;
    }
    Give(mvn::EncodeCharacter(character).front());
  }

  kinescope::BodySample Sample(double away) {
    kinescope::BodySample sample = motion_->At(static_cast<double>(counter_) / 60);
    sample.counter = counter_++;
    sample.time_code_millis = sample.counter * 1000LL / 60;
    for (auto& segment : sample.segments) segment.position.x() += away;
    sample.character = 100 + static_cast<int>(random_() % 4);
    return sample;
  }

  void SendPose(double away) { Give(mvn::EncodeSample(Sample(away)).front()); }
  void SendStranger() {
    kinescope::BodySample sample = Sample(0);
    sample.character = static_cast<int>(random_() % 256);
    Give(mvn::EncodeSample(sample).front(), sent_ % kMachines);
  }
  // 16 people at a time, who leave after 4 s: 240 in a minute.
  void SendVisitor() {
    constexpr std::uint64_t kAtOnce = 16, kSamplesEach = 120;  // of 240, then they are silent
    const std::uint64_t turn = visits_++ / kAtOnce;
    if (turn % (2 * kSamplesEach) >= kSamplesEach) return void(++sent_);
    kinescope::BodySample sample = Sample(0);
    sample.character =
        static_cast<int>((turn / (2 * kSamplesEach) * kAtOnce + visits_ % kAtOnce) % 256);
    sample.counter = static_cast<std::uint32_t>(turn);
    sample.time_code_millis = static_cast<std::int64_t>(turn) * 1000 / 60;
    Give(mvn::EncodeSample(sample).front());
  }
  void SendGarbage() {
    std::string bytes(random_() % 1400, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random_());
    Give(bytes);
  }
  void SendDamaged(bool cut) {
    const auto datagrams = mvn::EncodeSample(Sample(0));
    std::string bytes = datagrams[random_() % datagrams.size()];
    if (cut) {
      bytes.resize(random_() % bytes.size());
    } else {
      for (int i = 0; i < 4; ++i) bytes[random_() % bytes.size()] = static_cast<char>(random_());
    }
    Give(bytes);
  }

  double Share() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  std::array<int, kMachines> sockets_{};
  std::unique_ptr<subject::Motion> motion_ = subject::MakeMotion("walk");
  std::mt19937 random_{1};
  std::uint32_t counter_ = 0;
  std::size_t next_ = 0;
  std::uint64_t visits_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "hostile_senders PORT KIND RATE SECONDS\nkinds: all");
    for (const auto& kind : Attacker::Kinds()) std::fprintf(stderr, " %s", kind.first);
    std::fprintf(stderr, "\n");
    return 2;
  }
  Attacker attacker(std::atoi(argv[1]));
  const double rate = std::atof(argv[3]);
  const double seconds = std::atof(argv[4]);
  const auto start = std::chrono::steady_clock::now();
  while (true) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    if (passed.count() >= seconds) break;
    while (static_cast<double>(attacker.sent()) < rate * passed.count()) attacker.Send(argv[2]);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::printf("%llu\n", static_cast<unsigned long long>(attacker.sent()));
}
