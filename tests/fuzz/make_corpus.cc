// Writes the saved corpus: `make_corpus tests/fuzz/corpus`. Everything in it is made by our own
// encoder, from seeded values, so that it can be made again.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "server/mvn/byte_order.h"
#include "server/mvn/encode.h"
#include "tests/fuzz/bag_builder.h"
#include "tests/server/mvn/file/capture_builder.h"
#include "tests/server/mvn/file/synthetic_mvnx.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/urdf/rig/rig_samples.h"

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

// Each value that is read by a parser of its own, and what such a parser may trip over.
void WriteOptions(const fs::path& folder) {
  const std::pair<const char*, const char*> texts[] = {
      {"background", "#1A2b3C"},
      {"body_model", "primitive"},
      {"camera", "1,2,3:0,0,1;front;keys.yaml"},
      {"class_limits", "0.3,0.6"},
      {"end", "864000"},
      {"extra_mass", "head:1.5@0,0,0.12"},
      {"fps", "30000/1001"},
      {"ghost", "demo:lift@2.5"},
      {"hand_load", "right:5;left:2.5@0,0.01,-0.2"},
      {"orbit", "turn"},
      {"overlay", "+plot,-legend"},
      {"plot", "l5_s1,right_knee"},
      {"quantities", "poses,loads"},
      {"robot", "a.urdf@1,-2,90;b@c.urdf"},
      {"sample", "864000000"},
      {"show", "scale"},
      {"size", "1280x720"},
      {"tool", "right:hammer.stl@0,0,0"},
      {"views", "2x2:front,left,top,1,2,3:0,0,1"},
      {"wrench_bodies", "1:LeftFoot,2:RightFoot"},
      {"wrench_place", "1,2,90"},
      {"time", "1e-320"},
      {"fov", "+-30"},
      {"hand_load", "right:1e999@,,"},
      {"views", "99999999999x1:"},
      {"size", "0x99999999999999999999"},
      {"robot", "@@;;@1,2,3,4"},
      {"out", ";a;;b;;"},
      {"views", "time:0,0.5/1,1e-320"},
  };
  int number = 0;
  for (const auto& [name, text] : texts) {
    Write(folder / (std::to_string(number++) + "_" + name), std::string(name) + "=" + text);
  }
}

void WritePoses(const fs::path& folder) {
  const std::pair<const char*, const char*> texts[] = {
      {"base", "squat"},
      {"folded", "t_pose,\n  right_elbow = 90,\n\tleft_knee=4.5e1 \n"},
      {"joints",
       "right_shoulder_abduction=150,right_shoulder_rotation=-30,l5_s1_lateral_bending=12"},
      {"feet", "left_hip=90,left_knee=90,right_ankle=-40,right_ballfoot=-40,right_knee_rotation=5"},
      {"place",
       "sit,heading=-270,x=-99.5,y=.25,vertical_pelvis=20,vertical_pelvis_lateral_bending=-85"},
      {"end_of_range", "right_elbow_abduction=90,left_elbow_rotation=-110,t1_c7=-60"},
      {"out_of_range", "right_knee=1e308"},
      {"not_finite", "right_knee=nan"},
      {"no_number", "right_knee=9O,left_knee=-"},
      {"nearest", "rigth_elbow=90"},
      {"axis", "right_elbow_flexoin=90"},
      {"twice", "left_wrist=9,left_wrist_flexion=9"},
      {"base_last", "left_wrist=9,t_pose"},
      {"motion", "walk"},
      {"commas", ",,=,"},
      {"signs", "x==1,=x=,="},
      {"controls", "\x1b[2J=\xff\xfe"},
  };
  for (const auto& [name, text] : texts) Write(folder / name, text);
}

void WriteYaml(const fs::path& options, const fs::path& keys) {
  Write(options / "case",
        "source: demo:lift\ntime: 2.5\nstate: no data\ncamera: front\nsize: 640x360\n"
        "overlay: [a]\n");
  Write(options / "good",
        "source: demo:lift\ntime: 2.5\nstate: no data\ncamera: front\nsize: 640x360\nfov: 40\n");
  Write(options / "alias", "time: &a [1]\nsize: *a\n");
  Write(options / "deep", "time: " + std::string(2000, '['));
  Write(options / "twice", "time: 1\ntime: 2\n? [a]\n: b\n");
  Write(keys / "every_field",
        "keys:\n- {time: 0, camera: front}\n- {time: 1.5, camera: top, fov: 45, ease: linear}\n"
        "- {time: 2, position: [3, -2, 1.5], target: [0, 0, 1], fov: 60, ease: hold}\n");
  Write(keys / "laughs", "a: &a [x, x]\nb: &b [*a, *a]\nkeys: [*b, *b]\n");
  Write(keys / "deep", "keys: " + std::string(2000, '['));
  Write(keys / "not_finite", "keys: [{time: .inf, position: [.nan, 1e999, 0], target: [0, 0, 0]}]");
}

void WriteRviz(const fs::path& folder) {
  const std::string begin = "Visualization Manager:\n";
  Write(
      folder / "every_kind",
      begin +
          "  Global Options: {Background Color: 177; 255; 255, Fixed Frame: /odom, Default "
          "Light: 0}\n"
          "  Displays:\n"
          "    - {Class: rviz/Grid, Enabled: true, Name: Grid}\n"
          "    - {Class: rviz/TF, Enabled: true, Name: TF}\n"
          "    - {Class: rviz/TF, Enabled: true, Show Names: false, Frames: {a: {Value: false}}}\n"
          "    - {Class: rviz/RobotModel, Enabled: true, Alpha: 0.5, Links: {a: {Value: false}}}\n"
          "    - {Class: rviz/InteractiveMarkers, Enabled: true, Update Topic: /a/update}\n"
          "    - {Class: rviz/Path, Enabled: true, Topic: /b, Pose Style: Arrows, Offset: {X: 1}}\n"
          "    - {Class: rviz/Odometry, Enabled: true, Topic: /c, Covariance: {Value: true,\n"
          "       Orientation: {Value: true, Color Style: RGB, Offset: 1e9}}}\n"
          "    - {Class: rviz/Marker, Enabled: true, Marker Topic: /d, Namespaces: {e f: false}}\n"
          "    - {Class: rviz/RobotModel, Enabled: true, Visual Enabled: false}\n"
          "    - {Class: rviz/MarkerArray, Enabled: true, Namespaces: {com: false}}\n"
          "    - Class: rviz/Group\n"
          "      Enabled: true\n"
          "      Displays: [{Class: rviz/Path, Value: true, Name: \"a\\e[31m\"}]\n"
          "  Tools: [{Class: rviz/MoveCamera}]\n"
          "Panels: [{Class: rviz/Time, SyncMode: 1}]\n");
  for (const char* view :
       {"rviz/Orbit", "rviz/XYOrbit", "rviz/FPS", "rviz/TopDownOrtho", "plugin/Own"}) {
    Write(folder / ("view_" + fs::path(view).filename().string()),
          begin + "  Views: {Current: {Class: " + view +
              ", Distance: 1e999, Yaw: .nan, Pitch: -9, Scale: 0, Angle: 1e300, X: 1e5, Target "
              "Frame: a,\n"
              "    Focal Point: {X: 1, Y: -2, Z: 3e2}, Position: {X: 1, Y: 2}, Invert Z Axis: "
              "true}}\n");
  }
  Write(folder / "of_rviz_2", begin + "  Displays: [{Class: rviz_common/Group}]\n");
  Write(folder / "deep", begin + "  Displays: " + std::string(2000, '['));
  Write(folder / "scalar_lists",
        begin + "  Displays: 7\n  Views: [1]\n  Global Options: x\nPanels: {}\n");
}

void WriteBags(const fs::path& folder) {
  using namespace fuzz;
  // Messages out of order, of a topic that is read and one that is not, and of none.
  std::string records = BagConnectionRecord(0, "/tf", "tf2_msgs/TFMessage") +
                        BagConnectionRecord(1, "/chatter", "std_msgs/String");
  for (const std::uint32_t seconds : {3U, 1U, 2U}) {
    records += BagMessageRecord(0, seconds, std::string(20, 't')) +
               BagMessageRecord(1, seconds, "text") + BagMessageRecord(7, seconds, "nobody's");
  }
  const std::string index = BagRecord(4, {{"ver", Little(1, 4)}, {"conn", Little(0, 4)}}, "index") +
                            BagRecord(6, {{"ver", Little(1, 4)}}, "chunk info");
  for (const char* compression : {"none", "bz2", "lz4"}) {
    const std::string chunk = BagChunk(compression, records);
    const std::string bag = BagHeader(200) + chunk + chunk + index;
    Write(folder / compression, bag);
    Write(folder / (std::string(compression) + "_cut"), bag.substr(0, bag.size() / 2));
    Write(folder / (std::string(compression) + "_active"),
          BagHeader(0) + chunk +
              BagRecord(5, {{"compression", compression}, {"size", Little(0, 4)}}, "") +
              BagPacked(compression, records));
    std::string damaged = bag;
    damaged[BagHeader(200).size() + chunk.size() / 2] ^= 0x40;
    Write(folder / (std::string(compression) + "_damaged"), damaged);
  }
  Write(folder / "without_chunks", BagHeader(0) + records);
  Write(folder / "chunk_in_chunk", BagHeader(9) + BagChunk("lz4", BagChunk("none", records)));
  Write(folder / "encrypted",
        "#ROSBAG V2.0\n" + BagRecord(3, {{"index_pos", Little(9, 8)}, {"encryptor", "aes"}}, ""));
  Write(folder / "unknown_compression",
        BagHeader(9) + BagRecord(5, {{"compression", "zip"}, {"size", Little(9, 4)}}, records));
}

// Little-endian, as ROS serialises.
class RosBytes {
 public:
  explicit RosBytes(char kind) : bytes_(1, kind) {}  // see marker_fuzz.cc
  RosBytes& Count(std::uint32_t value) { return Append(fuzz::Little(value, 4)); }
  RosBytes& Text(const std::string& text) {
    return Count(static_cast<std::uint32_t>(text.size())).Append(text);
  }
  RosBytes& Byte(int value) { return Append(std::string(1, static_cast<char>(value))); }
  template <class Real>
  RosBytes& Reals(const std::vector<Real>& values) {
    for (const Real value : values) {
      std::string raw(sizeof(value), '\0');
      std::memcpy(raw.data(), &value, sizeof(value));
      Append(raw);
    }
    return *this;
  }
  RosBytes& Header(const std::string& frame) { return Count(1).Count(2).Count(3).Text(frame); }
  RosBytes& Marker(std::uint32_t id, std::uint32_t type, std::uint32_t points) {
    Header("world").Text("walls").Count(id).Count(type).Count(0);
    Reals<double>({1, 2, 3, 0, 0, 0, 1, 0.5, 0.5, 0.5}).Reals<float>({1, 0, 0, 1});
    Count(0).Count(0).Byte(0).Count(points);
    for (std::uint32_t i = 0; i < points; ++i) Reals<double>({0.0 + i, 1, 2});
    Count(points);
    for (std::uint32_t i = 0; i < points; ++i) Reals<float>({0, 1, 0, 1});
    return Text("door").Text("package://walls/door.stl").Byte(1);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  RosBytes& Append(const std::string& more) {
    bytes_ += more;
    return *this;
  }
  std::string bytes_;
};

// Maps, polygons, cells, pictures of cameras.
void WriteMaps(const fs::path& folder) {
  Write(folder / "polygon",
        RosBytes('\16').Header("cart").Count(2).Reals<float>({0, 0, 0, 1, 2, 3}).bytes());
  Write(folder / "cells", RosBytes('\20')
                              .Header("cart")
                              .Reals<float>({0.5F, 0.25F})
                              .Count(1)
                              .Reals<double>({1, 2, 3})
                              .bytes());
  RosBytes map('\21');
  map.Header("map").Count(4).Count(5).Reals<float>({0.5F}).Count(3).Count(2);  // width, height
  map.Reals<double>({0, 0, 0, 0, 0, 0, 1}).Count(6);
  for (const int cell : {0, 0, 100, 0, -1, 50}) map.Byte(cell);
  Write(folder / "map", map.bytes());
  RosBytes update('\41');
  update.Header("map").Count(1).Count(2).Count(2).Count(1).Count(2);  // x, y, width, height, cells
  Write(folder / "map_update", update.Byte(100).Byte(-1).bytes());
  RosBytes image('\23');
  image.Header("camera").Count(2).Count(2).Text("rgb8").Byte(0).Count(6).Count(12);
  for (int i = 0; i < 12; ++i) image.Byte(20 * i);
  Write(folder / "image", image.bytes());
  render::Image grey;
  render::SetSize(grey, 8, 8);
  const std::vector<std::uint8_t> file = render::EncodeJpeg(grey, 50);
  Write(folder / "jpeg",
        RosBytes('\24').Header("camera").Text("jpeg").Text({file.begin(), file.end()}).bytes());
  const std::vector<std::uint8_t> png = render::EncodePng(grey);
  const std::string head(12, '\0');
  Write(folder / "depth", RosBytes('\24')
                              .Header("camera")
                              .Text("16UC1; compressedDepth png")
                              .Text(head + std::string(png.begin(), png.end()))
                              .bytes());
  RosBytes depths('\36');
  depths.Header("camera").Count(2).Count(2).Text("16UC1").Byte(0).Count(4).Count(8);
  for (int i = 0; i < 8; ++i) depths.Byte(i);
  Write(folder / "depth_image", depths.bytes());
  for (const bool is_of_depths : {true, false}) {
    RosBytes info(is_of_depths ? '\37' : '\40');
    info.Header("camera").Count(480).Count(640).Text("plumb_bob").Count(0);
    info.Reals<double>({525, 0, 320, 0, 525, 240, 0, 0, 1})
        .Reals<double>({1, 0, 0, 0, 1, 0, 0, 0, 1});
    info.Reals<double>({525, 0, 320, -60, 0, 525, 240, 0, 0, 0, 1, 0});
    for (int i = 0; i < 6; ++i) info.Count(0);  // binning, region
    Write(folder / (is_of_depths ? "depth_calibration" : "calibration"), info.Byte(0).bytes());
  }
}

// Temperature, illuminance, pressure, humidity: a value and its variance. Arrows and a range.
void WriteValues(const fs::path& folder) {
  const std::vector<double> arrows = {0.5, 0, 0, 0, 0.2, 2};
  Write(folder / "twist", RosBytes('\31').Header("cart").Reals(arrows).bytes());
  Write(folder / "accel", RosBytes('\32').Header("cart").Reals(arrows).bytes());
  Write(folder / "range", RosBytes('\33')
                              .Header("cart")
                              .Byte(0)
                              .Reals<float>({0.5F, 0.1F, 4, 2})  // field of view, bounds, range
                              .bytes());
  const char* const names[] = {"temperature", "illuminance", "fluid_pressure", "humidity"};
  for (int i = 0; i < 4; ++i) {
    Write(
        folder / names[i],
        RosBytes(static_cast<char>(21 + i)).Header("jRightKnee").Reals<double>({45.0, 0}).bytes());
  }
}

// A server's whole, with a marker of its own and a control whose handle RViz makes; and an update
// that moves it.
void WriteInteractiveMarkers(const fs::path& folder) {
  constexpr int kMoveAxis = 3, kUpdate = 1;
  const std::vector<double> pose = {1, 2, 3, 0, 0, 0, 1};
  RosBytes all('\34');
  all.Text("goals").Count(7).Count(0).Count(1);  // server, number, markers
  all.Header("world").Reals(pose).Text("goal").Text("to here").Reals<float>({0.5F}).Count(0);
  all.Count(2);  // controls: name, turn, modes, whether it is always visible, markers
  all.Text("box").Reals<double>({0, 0, 0, 1}).Byte(0).Byte(0).Byte(1).Count(1).Marker(1, 1, 0);
  all.Byte(0).Text("");
  all.Text("x")
      .Reals<double>({0, 0, 0, 1})
      .Byte(0)
      .Byte(kMoveAxis)
      .Byte(0)
      .Count(0)
      .Byte(0)
      .Text("");
  Write(folder / "interactive_all", all.bytes());
  RosBytes update('\35');
  update.Text("goals").Count(8).Count(0).Byte(kUpdate).Count(0).Count(1);
  update.Header("world").Reals(pose).Text("goal").Count(1).Text("gone");
  Write(folder / "interactive_update", update.bytes());
}

// Of two people, one with something in a hand.
void WriteToldPeople(const fs::path& folder) {
  RosBytes told('\42');
  told.Count(2);
  told.Text("anna_pelvis").Text("/anna/").Reals<double>({70.0}).Byte(2).Byte(1);
  told.Reals<double>({0, 2.5, 0}).Count(0).Count(3).Reals<double>({0, 0.01, -0.2});
  told.Text("ben_pelvis").Text("/ben/").Reals<double>({std::nan("")}).Byte(0).Byte(0);
  told.Reals<double>({0, 0, 0}).Count(0).Count(0);
  Write(folder / "told_people", told.bytes());
}

void WriteMarkers(const fs::path& folder) {
  constexpr std::uint32_t kMarkerTypes = 12;
  RosBytes all('\1');
  all.Count(kMarkerTypes);
  for (std::uint32_t type = 0; type < kMarkerTypes; ++type) all.Marker(type, type, 3);
  Write(folder / "markers", all.bytes());
  const std::string one = RosBytes('\0').Marker(1, 4, 3).bytes();
  Write(folder / "marker", one);
  Write(folder / "marker_cut", one.substr(0, one.size() - 30));
  Write(folder / "point", RosBytes('\6').Header("cart").Reals<double>({1, 2, 3}).bytes());
  Write(folder / "pose",
        RosBytes('\7').Header("cart").Reals<double>({1, 2, 3, 0, 0, 0, 1}).bytes());
  Write(folder / "poses", RosBytes('\10')
                              .Header("cart")
                              .Count(2)
                              .Reals<double>({1, 2, 3, 0, 0, 0, 1, 4, 5, 6, 0, 0, 0, 0})
                              .bytes());
  RosBytes path('\11');
  path.Header("cart").Count(2);
  for (int i = 0; i < 2; ++i) path.Header("").Reals<double>({0.5 * i, 2, 3, 0, 0, 0, 1});
  Write(folder / "path", path.bytes());
  Write(folder / "wrench",
        RosBytes('\12').Header("cart").Reals<double>({1, 2, 700, 0, -20, 0}).bytes());
  Write(folder / "scan", RosBytes('\13')
                             .Header("cart")
                             .Reals<float>({-1, 1, 0.5F, 0, 0.1F, 0.1F, 5})
                             .Count(3)
                             .Reals<float>({1, 2, 9})
                             .Count(3)
                             .Reals<float>({10, 20, 30})
                             .bytes());
  RosBytes cloud('\14');
  cloud.Header("cart").Count(1).Count(2).Count(4);  // height, width, fields
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "rgb"}) {
    cloud.Text(name).Count(offset).Byte(7).Count(1);
    offset += 4;
  }
  cloud.Byte(0).Count(16).Count(32).Count(32);  // big-endian, steps of a point and a row, bytes
  cloud.Reals<float>({1, 2, 3, 0, 4, 5, 6, 1}).Byte(1);
  Write(folder / "cloud", cloud.bytes());
  WriteMaps(folder);
  WriteValues(folder);
  Write(folder / "not_finite",
        RosBytes('\0')
            .Header("")
            .Text("")
            .Count(0)
            .Count(1)
            .Count(0)
            .Reals<double>({std::numeric_limits<double>::quiet_NaN(), 1e300, 0, 0, 0, 0, 0})
            .bytes());
  Write(folder / "transforms", RosBytes('\2')
                                   .Count(1)
                                   .Header("world")
                                   .Text("pelvis")
                                   .Reals<double>({1, 2, 3, 0, 0, 0, 1})
                                   .bytes());
  Write(folder / "nothing", RosBytes('\0').bytes());
  Write(folder / "many_transforms", RosBytes('\2').Count(0x02000000).bytes());
  Write(folder / "joint_states", RosBytes('\4')
                                     .Header("")
                                     .Count(1)
                                     .Text("jRightKnee_roty")
                                     .Count(1)
                                     .Reals<double>({1})
                                     .Count(0)
                                     .Count(1)
                                     .Reals<double>({2})
                                     .bytes());
}

// A file, and what png_fuzz.cc makes a file of: width, channels, rows that begin with their filter.
void WritePngs(const fs::path& folder) {
  std::mt19937 random(28);
  render::Image image;
  render::SetSize(image, 9, 7);
  for (std::uint8_t& channel : image.rgba) channel = static_cast<std::uint8_t>(random());
  const std::vector<std::uint8_t> file = render::EncodePng(image, {{"Title", "corpus"}});
  Write(folder / "file", {file.begin(), file.end()});
  for (const int channels : {3, 4}) {
    constexpr int kWidth = 11;
    std::string rows = {static_cast<char>(kWidth - 1), static_cast<char>(channels - 3)};
    for (const int filter : {0, 1, 2, 3, 4, 4, 3, 2, 1}) {
      rows += static_cast<char>(filter);
      for (int i = 0; i < kWidth * channels; ++i) rows += static_cast<char>(random());
    }
    Write(folder / ("filters_" + std::to_string(channels)), rows);
  }
}

void WriteRigs(const fs::path& folder) {
  using testing::BoneNames;
  testing::RigSample sample;
  sample.rings = 2;
  for (const auto& [name, names] :
       {std::pair("vrm1", BoneNames::kVrm1), std::pair("vrm0", BoneNames::kVrm0),
        std::pair("mixamo", BoneNames::kMixamo), std::pair("mvn", BoneNames::kMvn)}) {
    sample.names = names;
    Write(folder / name, testing::RigGlb(sample));
  }
  sample.names = BoneNames::kMixamo;
  const std::string whole = testing::RigGlb(sample);
  Write(folder / "torn", whole.substr(0, whole.size() / 2));
  std::string lies = whole;
  lies[14] = '\x7f';  // of the JSON part's length
  Write(folder / "lies", lies);
  sample.missing = {8};
  Write(folder / "no_forearm", testing::RigGlb(sample));
  sample.missing = {};
  const auto edited = [&](const char* name, auto edit) {
    sample.edit = [&](nlohmann::json& document, std::string& binary) { edit(document, binary); };
    Write(folder / name, testing::RigGlb(sample));
  };
  using nlohmann::json;
  edited("circle", [](json& document, std::string&) { document["nodes"][5]["children"] = {0}; });
  edited("no_weights", [](json& document, std::string& binary) {
    const std::size_t at = document["bufferViews"][2]["byteOffset"];
    binary.replace(at, 16, 16, '\0');
  });
  edited("nan", [](json&, std::string& binary) { binary.replace(0, 4, 4, '\xff'); });
  edited("elsewhere",
         [](json& document, std::string&) { document["buffers"][0]["uri"] = "other.bin"; });
  edited("no_length", [](json& document, std::string&) {
    document["nodes"][8]["translation"] = {0, 0, 0};
  });
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
  WriteBags(folder / "bag");
  WritePngs(folder / "png");
  WriteRigs(folder / "rig");
  WriteMarkers(folder / "marker");
  WriteInteractiveMarkers(folder / "marker");
  WriteToldPeople(folder / "marker");
  WriteLoads(folder / "loads");
  WriteOptions(folder / "options");
  WritePoses(folder / "pose");
  WriteYaml(folder / "yaml_options", folder / "camera_keys");
  WriteRviz(folder / "rviz");
  return 0;
}
