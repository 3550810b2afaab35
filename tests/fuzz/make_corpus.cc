// Writes the saved corpus: `make_corpus tests/fuzz/corpus`. Everything in it is made by our own
// encoder, from seeded values, so that it can be made again.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "server/mvn/byte_order.h"
#include "server/mvn/encode.h"
#include "tests/server/mvn/file/capture_builder.h"
#include "tests/server/mvn/file/synthetic_mvnx.h"
#include "tests/server/mvn/mvn_testing.h"

namespace {

using namespace kinescope;
using mvn::testing::RandomFullSample;
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

const mvn::TypeSet& EveryType() {
  using mvn::Type;
  static const mvn::TypeSet types = mvn::MakeTypeSet(
      {Type::kEulerPose, Type::kPose, Type::kMarkers, Type::kJointAngles, Type::kLinear,
       Type::kAngular, Type::kTrackers, Type::kCenterOfMass, Type::kTimeCode});
  return types;
}

// One record of a session: see assembler_fuzz.cc and scale_fuzz.cc.
void AddRecord(std::string& out, int first, int wait, const std::string& bytes) {
  mvn::ByteWriter writer(out);
  writer.Write(static_cast<std::uint8_t>(first));
  writer.Write(static_cast<std::uint8_t>(wait));
  writer.Write(static_cast<std::uint16_t>(bytes.size()));
  out += bytes;
}

void WriteDatagrams(const fs::path& folder, RandomValues& random) {
  const BodySample sample = RandomSample(random, 1200);
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  for (const std::string& datagram :
       mvn::EncodeSample(sample, EveryType(), urdf::LandmarksOf(skeleton))) {
    Write(folder / ("type" + datagram.substr(4, 2)), datagram);
  }
  for (const std::string& datagram : mvn::EncodeSample(RandomFullSample(random, 1200), EveryType(),
                                                       urdf::LandmarksOf(skeleton))) {
    const std::string type = datagram.substr(4, 2);
    if (type == "01" || type == "02")
      Write(folder / ("type" + type + "_gloves_and_props"), datagram);
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
  raw.payload = mvn::testing::Items(1, 17, 10, 1, 0);
  Write(folder / "type23_short", raw.Bytes());
  raw.type = "24";
  raw.items = 1;
  raw.payload = mvn::testing::Items(0, 1, 3, 1).substr(4);
  Write(folder / "type24_short", raw.Bytes());
  raw.type = "20";
  raw.items = 2;  // Pelvis_T8 and Vertical_T8
  raw.payload.clear();
  for (int i = 0; i < 2; ++i)
    raw.payload += mvn::testing::Items(0x100, 1, 0, 0) + mvn::testing::Items(0x500, 1, 3, 10);
  Write(folder / "type20_twins", raw.Bytes());
  Write(folder / "json", R"({"sync":"start"})");
}

void WriteSessions(const fs::path& folder, RandomValues& random) {
  std::string good, bad;
  for (const auto& datagram : mvn::EncodeCharacter(Ines())) AddRecord(good, 0, 0, datagram);
  for (std::uint32_t counter = 100; counter < 108; ++counter) {
    for (const auto& datagram : mvn::EncodeSample(RandomSample(random, counter))) {
      AddRecord(good, 0, datagram[5] == '2' ? 4 : 0, datagram);
      if (random.Coin(0.2)) continue;
      const int sender = random.Coin(0.5) ? 1 : 0x11;
      AddRecord(bad, sender, random.Integer(0, 12), datagram);
      if (random.Coin(0.2)) AddRecord(bad, sender, 0, datagram);
    }
    if (counter == 104) AddRecord(bad, 1, 255, "<sync/>");
  }
  Write(folder / "good", good);
  Write(folder / "bad_network", bad);

  // Every type with gloves and props, beside a cluster of objects; then the sender starts over.
  std::string full;
  for (const std::uint32_t counter : {50U, 51U, 52U, 53U, 54U, 0U, 1U}) {
    for (const auto& datagram : mvn::EncodeSample(RandomFullSample(random, counter), EveryType())) {
      AddRecord(full, 0, datagram[5] == '1' ? 4 : 0, datagram);
    }
    RawDatagram objects;
    objects.counter = counter;
    objects.character = 1;
    objects.items = objects.body_segments = 3;
    objects.payload = mvn::testing::PoseItems(1, 3);
    AddRecord(full, 0, 0, objects.Bytes());
  }
  Write(folder / "every_type", full);
}

// Groups of type 13: whole, with a part lost, begun again half-way; a body and tracked objects.
void WriteScaleGroups(const fs::path& folder) {
  Character person = Ines();
  person.scaled_segments.resize(kFingerAndPropCount);
  for (int i = 1; i < kFingerAndPropCount; ++i) {
    if (i >= 2 && i < kMaxProps) continue;
    person.scaled_segments[static_cast<std::size_t>(i)] = {FingerOrPropName(i),
                                                           {0.1, 0.01 * i, 1.4}};
  }
  Character objects;
  objects.scaled_segments = {{"Tracker 1", {0, 0, 1}}, {"Tracker 2", {1, 0, 1}}};
  std::string whole, lost, again, things;
  for (const std::string& datagram : mvn::EncodeCharacter(person)) {
    if (datagram.substr(4, 2) != "13") continue;
    const int counter = static_cast<unsigned char>(datagram[10]);
    const std::string payload = datagram.substr(mvn::kHeaderBytes);
    AddRecord(whole, counter, 0, payload);
    AddRecord(again, counter, 1, payload);
    if (counter == 0) {
      AddRecord(lost, counter, 0, payload);
      AddRecord(again, counter, 1, payload);
    }
  }
  for (const std::string& datagram : mvn::EncodeCharacter(objects)) {
    if (datagram.substr(4, 2) != "13") continue;
    AddRecord(things, static_cast<unsigned char>(datagram[10]), 0,
              datagram.substr(mvn::kHeaderBytes));
  }
  Write(folder / "whole", whole);
  Write(folder / "part_lost", lost);
  Write(folder / "begun_again", again);
  Write(folder / "objects_then_body", things + whole);
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
  Write(folder / "cooked", PcapBuilder(kLinkCooked, false).Add(5, LinuxCooked(udp)).bytes());
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

// Texts of what is held and worn, and numbers for four samples.
void WriteLoads(const fs::path& folder) {
  Write(folder / "hand_load", "right:5;left:2.5@0,0.01,-0.2");
  Write(folder / "extra_mass", "head:1.5@0,0,0.12");
  Write(folder / "both", "both:10");
  std::mt19937 random(22);
  const auto numbers = [&](std::size_t count, const std::vector<double>& choices) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) {
      const double number = choices.empty() ? std::uniform_real_distribution<>(-1, 1)(random)
                                            : choices[random() % choices.size()];
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    return bytes;
  };
  const double infinite = std::numeric_limits<double>::infinity();
  Write(folder / "moving", numbers(438, {}));
  Write(folder / "huge", numbers(97, {1e300, -1e200, 1e8, 0}));
  Write(folder / "not_finite", numbers(193, {0.1, 1, std::nan(""), infinite}));
  Write(folder / "tiny", numbers(31, {1e-300, 0, 5e-324}));
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
  WriteScaleGroups(folder / "scale");
  WriteFiles(folder / "mvnx");
  WriteCaptures(folder / "pcap");
  RandomValues streams(21);
  WriteStreams(folder / "framing", streams);
  WriteLoads(folder / "loads");
  return 0;
}
