// Writes the saved corpus: `make_corpus tests/fuzz/corpus`. Everything in it is made by our own
// encoder, from seeded values, so that it can be made again.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "server/mvn/byte_order.h"
#include "server/mvn/encode.h"
#include "tests/server/mvn/capture_builder.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/server/mvn/synthetic_mvnx.h"

namespace {

using namespace kinescope;
using mvn::testing::RandomSample;
using mvn::testing::RandomValues;
using mvn::testing::RawDatagram;
namespace fs = std::filesystem;

void Write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

Character Ines() {
  Character character;
  character.name = "Ines";
  character.color_rgb = 0x3C78A0;
  character.skeleton = urdf::DefaultSkeleton(1.7);
  return character;
}

void WriteDatagrams(const fs::path& folder, RandomValues& random) {
  for (const std::string& datagram : mvn::EncodeSample(RandomSample(random, 1200))) {
    Write(folder / ("type" + datagram.substr(4, 2)), datagram);
  }
  int part = 0;
  for (const std::string& datagram : mvn::EncodeCharacter(Ines())) {
    Write(folder / ("type" + datagram.substr(4, 2) + "_" + std::to_string(part++)), datagram);
  }
  RawDatagram raw;
  raw.items = 63;
  raw.payload = mvn::testing::PoseItems(1, 63);
  Write(folder / "type02_gloves", raw.Bytes());
  raw.items = 0;
  raw.announced_payload = 0;
  Write(folder / "type02_old_header", raw.Bytes());
  raw = RawDatagram();
  raw.type = "23";
  raw.items = 17;
  raw.payload = mvn::testing::Items(1, 17, 16, 1);
  Write(folder / "type23", raw.Bytes());
  raw.type = "20";
  raw.items = 2;  // Pelvis_T8 and Vertical_T8
  raw.payload.clear();
  for (int i = 0; i < 2; ++i)
    raw.payload += mvn::testing::Items(0x100, 1, 0, 0) + mvn::testing::Items(0x500, 1, 3, 10);
  Write(folder / "type20_twins", raw.Bytes());
  Write(folder / "json", R"({"sync":"start"})");
}

void WriteSessions(const fs::path& folder, RandomValues& random) {
  const auto record = [](std::string& out, int sender, int wait, const std::string& datagram) {
    mvn::ByteWriter writer(out);
    writer.Write(static_cast<std::uint8_t>(sender));
    writer.Write(static_cast<std::uint8_t>(wait));
    writer.WriteText(datagram);
    out.erase(out.size() - datagram.size() - 4, 2);  // the length is 2 bytes here
  };
  std::string good, bad;
  for (const auto& datagram : mvn::EncodeCharacter(Ines())) record(good, 0, 0, datagram);
  for (std::uint32_t counter = 100; counter < 108; ++counter) {
    for (const auto& datagram : mvn::EncodeSample(RandomSample(random, counter))) {
      record(good, 0, datagram[5] == '2' ? 4 : 0, datagram);
      if (random.Coin(0.2)) continue;
      const int sender = random.Coin(0.5) ? 1 : 0x11;
      record(bad, sender, random.Integer(0, 12), datagram);
      if (random.Coin(0.2)) record(bad, sender, 0, datagram);
    }
    if (counter == 104) record(bad, 1, 255, "<sync/>");
  }
  Write(folder / "good", good);
  Write(folder / "bad_network", bad);
}

// Datagrams one after the other, as TCP has them, and what can be wrong with that.
void WriteStreams(const fs::path& folder, RandomValues& random) {
  constexpr std::size_t kPayloadSizeAt = 22;
  std::vector<std::string> datagrams = mvn::EncodeSample(RandomSample(random, 1200));
  Character character = Ines();
  for (const std::string& datagram : mvn::EncodeCharacter(character)) datagrams.push_back(datagram);
  character.name = "MXTP02 MXTP13";
  datagrams.push_back(mvn::EncodeCharacter(character).front());
  std::string good, old, cut, lying, foreign;
  for (std::string datagram : datagrams) {
    good += datagram;
    const auto size = static_cast<int>(datagram.size());
    cut += datagram.substr(0, static_cast<std::size_t>(random.Integer(1, size)));
    foreign += datagram + (random.Coin(0.5) ? R"({"sync":"start"})" : std::string(5, '\0'));
    datagram[kPayloadSizeAt] = datagram[kPayloadSizeAt + 1] = 0;
    old += datagram;
    datagram[kPayloadSizeAt] = static_cast<char>(random.Integer(0, 255));
    lying += datagram;
  }
  Write(folder / "good", good);
  Write(folder / "old_headers", old);
  Write(folder / "cut_short", cut + good);
  Write(folder / "lying_sizes", lying + good);
  Write(folder / "foreign", foreign);
}

void WriteFiles(const fs::path& folder) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  for (const int version : {3, 4}) {
    const std::string text =
        mvn::testing::WriteMvnx(version, 60, skeleton, mvn::testing::SwingingArms(skeleton, 2));
    const std::string name = "version" + std::to_string(version);
    Write(folder / (name + ".mvnx"), text);
    Write(folder / (name + "_cut.mvnx"), text.substr(0, text.size() * 3 / 4));
  }
  Write(folder / "doctype.mvnx",
        "<!DOCTYPE mvnx [<!ENTITY a \"b\">]><mvnx version=\"4\">&a;</mvnx>");
}

// Every way in which a datagram may lie in a capture.
void WriteCaptures(const fs::path& folder) {
  using namespace mvn::testing;
  const mvn::Endpoint suit = Ipv4(20, 50'001);
  const mvn::Endpoint us = Ipv4(10, 9763);
  RawDatagram raw;
  raw.type = "24";
  raw.payload = std::string(36, '\0');
  const std::string small = raw.Bytes();
  raw = RawDatagram();
  raw.items = 23;
  raw.payload = PoseItems(1, 23);
  const std::string pose = raw.Bytes();
  const std::string udp = Udp(suit, us, small);
  const std::string udp6 = Udp(Ipv6(1, 7), Ipv6(2, 9763), small);
  Write(folder / "ethernet",
        PcapBuilder(kLinkEthernet).Add(5, Ethernet(udp)).Add(4, Ethernet(udp6, 2)).bytes());
  Write(folder / "cooked",
        PcapBuilder(kLinkCooked, false).Add(5, LinuxCooked(udp)).bytes());
  Write(folder / "cooked2", PcapBuilder(kLinkCooked2).Add(5, LinuxCooked2(udp6)).bytes());
  Write(folder / "loopback", PcapBuilder(kLinkNull).Add(5, Loopback(udp)).bytes());
  Write(folder / "pcapng", PcapNgBuilder(kLinkRaw).AddOther("x").Add(5, udp).bytes());
  PcapBuilder pieces(kLinkRaw);
  for (const mvn::Endpoint& to : {us, Ipv6(2, 9763)}) {
    const mvn::Endpoint from = mvn::IsIpv4(to) ? suit : Ipv6(1, 7);
    for (const std::string& piece : Fragments(Udp(from, to, pose), 400, 3)) pieces.Add(6, piece);
  }
  Write(folder / "fragments", pieces.bytes());
  PcapBuilder tcp(kLinkRaw);
  tcp.Add(1, Tcp(suit, us, 99, kSyn, ""));
  tcp.Add(2, Tcp(suit, us, 200, kAck, pose.substr(100)));
  tcp.Add(3, Tcp(suit, us, 100, kAck, pose.substr(0, 150)));
  const auto next = static_cast<std::uint32_t>(100 + pose.size());
  tcp.Add(4, Tcp(suit, us, next + 30, kAck, small));
  tcp.Add(3'000'000'000, Tcp(suit, us, next + 99, kAck | kFin, small));
  Write(folder / "tcp", tcp.bytes());
  Write(folder / "tcp_cut", tcp.bytes().substr(0, tcp.bytes().size() - 9));
  Write(folder / "raw", small + "<sync/>" + pose);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_corpus <folder>\n");
    return 2;
  }
  const fs::path folder = argv[1];
  RandomValues random(20);
  WriteDatagrams(folder / "datagram", random);
  WriteSessions(folder / "assembler", random);
  WriteFiles(folder / "mvnx");
  WriteCaptures(folder / "pcap");
  RandomValues streams(21);
  WriteStreams(folder / "framing", streams);
  return 0;
}
