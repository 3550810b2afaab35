// page_fixture_server [--token T [--viewer_token T]] [--no-pictures] [--meshes FOLDER] [--worn]
// [--diagnostics JSON] [--marks_file FILE] [--alarms FILE] [--base_path PATH] [--port N]
// [--tls_certificate FILE --tls_key FILE]:
// --worn: gloves and props on everybody, and a tracked object. Prints one line of JSON with its
// "url", then obeys lines on its standard input until that ends:
//   live | stale | nodata   what it publishes, 60 times a second (stale, nodata: once)
//   people <n>              how many persons it shows
//   limits <medium> <high>  the class limits of its states
//   stream <JSON>           the health of the stream
//   compression <n>         of each person's L5/S1, N
// page_fixture_server describe: prints one state as the server encodes it (hex) beside what it
// means, and the limits of the load classes, for the page's unit tests.
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <sstream>
#include <string>

#include "core/hand_load_shape.h"
#include "core/palette.h"
#include "core/person_links.h"
#include "core/skin_inputs.h"
#include "core/system/clocks.h"
#include "core/system/install_paths.h"
#include "core/system/scratch_folder.h"
#include "render/shape/coarser_skin.h"
#include "server/alarms/alarms.h"
#include "server/alarms/rule_file.h"
#include "server/http/api.h"
#include "server/http/protocol.h"
#include "server/http/server.h"
#include "server/http/skin_buffer.h"
#include "tests/server/http/plain_pictures.h"
#include "tests/server/http/test_scene.h"
#include "tests/urdf/rig/rig_samples.h"
#include "tests/worn.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"
#include "urdf/skin/bind_pose.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/load_regions.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::http::testing {
namespace {

using nlohmann::json;
using urdf::At;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::nanoseconds kPeriod{1'000'000'000 / 60};
constexpr std::chrono::seconds kMostLate{1};
constexpr std::size_t kSkyStep = 29;  // of vertices

class PlainFeed final : public PictureFeed {
 public:
  void SetViewers(int count) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    viewers_ = count;
  }
  bool SetCamera(const std::string& camera) override { return camera != "nowhere"; }
  void SetDark(bool is_dark) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_dark_ = is_dark;
  }
  std::vector<std::uint8_t> SnapshotPng(const SnapshotRequest& request) override {
    return PlainPng(request.width, request.height,
                    request.state ? ColorOf(*request.state) : ColorOf(request.is_dark));
  }
  std::array<std::uint8_t, 3> color() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ColorOf(is_dark_);
  }
  int viewers() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return viewers_;
  }

 private:
  static std::array<std::uint8_t, 3> ColorOf(bool is_dark) {
    return is_dark ? std::array<std::uint8_t, 3>{10, 20, 40}
                   : std::array<std::uint8_t, 3>{40, 90, 160};
  }

  // Of former states: red, and the number of the state in green and blue.
  static std::array<std::uint8_t, 3> ColorOf(const SceneState& state) {
    return {255, static_cast<std::uint8_t>(state.number >> 8),
            static_cast<std::uint8_t>(state.number)};
  }

  mutable std::mutex mutex_;
  int viewers_ = 0;
  bool is_dark_ = false;
};

std::string Hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

json Numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json Numbers(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

// Some of the vertices in order: their places, and the share of the sky over them.
json SurfaceToJson(const render::CoarserSkin& of, const PersonModel& model,
                   const PersonState& person,
                   const std::array<const urdf::HandSkeleton*, 2>& gloves,
                   const std::array<const urdf::FingerPoses*, 2>& fingers) {
  const urdf::Skeleton& skeleton = model.human.skeleton;
  const skin::Build build = BuildOf(model);
  skin::PersonSkin::Surface surface;
  skin::PersonSkin(of.skin, build, skeleton, gloves).Pose(person.links, fingers, surface);
  of.normals.Apply(surface);
  std::vector<float> open;
  skin::SetOpenSky(surface.positions, surface.normals, skin::LimbRunsOf(of.skin.weights),
                   skin::CapsulesOf(skeleton, build, person.links), open);
  json some_open = json::array(), places = json::array();
  for (std::size_t i = 0; i < open.size(); i += kSkyStep) {
    some_open.push_back(open[i]);
    for (const float value : surface.positions[i]) {
      places.push_back(std::round(1e5 * static_cast<double>(value)) / 1e5);
    }
  }
  return {{"open", std::move(some_open)}, {"places", std::move(places)}};
}

// Region and place in it of all vertices, in order.
json RegionsToJson(const PersonModel& model,
                   const std::array<const urdf::HandSkeleton*, 2>& gloves) {
  const urdf::Skeleton& skeleton = model.human.skeleton;
  const skin::Build build = BuildOf(model);
  const skin::SkinTemplate& built_in = skin::BuiltInSkin();
  const skin::PersonSkin skin(built_in, build, skeleton, gloves);
  json joints = json::array(), inside = json::array();
  for (const skin::LoadRegion& region : skin::LoadRegionsOf(
           skin.rest(), built_in.weights, skin.triangles(), skin.bind(), skeleton.height)) {
    joints.push_back(urdf::kScoredJoints[region.joint]);
    inside.push_back(std::round(1e4 * region.inside) / 1e4);
  }
  return {{"joints", std::move(joints)}, {"inside", std::move(inside)}};
}

constexpr int kCoarseError = 4;  // mm

// The buffer of the person's skin, and frames and sky for random postures as the server computes
// them; also of a skin of fewer triangles.
json SkinToJson(const PersonState& person) {
  PersonModel model = *person.model;
  model.has_built_in_surface = true;
  const urdf::Skeleton& skeleton = model.human.skeleton;
  const std::string buffer = SkinBuffer(model, nullptr);
  const std::string coarse_buffer = SkinBuffer(model, nullptr, kCoarseError);
  const render::CoarserSkin whole = {skin::BuiltInSkin(), {}};
  const render::CoarserSkin coarse =
      render::MakeCoarserSkin(whole.skin, BuildOf(model), skeleton, 1e-3 * kCoarseError);
  std::mt19937 random(7);
  const auto angle = [&](double most) {
    return most * (static_cast<double>(random()) / 2147483648.0 - 1);
  };
  json postures = json::array();
  for (int i = 0; i < 6; ++i) {
    urdf::JointAngles angles{};
    for (Eigen::Vector3d& joint : angles) joint = {angle(2.4), angle(2.4), angle(2.4)};
    PersonState moved = person;
    moved.links = urdf::ForwardKinematics(skeleton, {{1, 2, 3}, {0.5, 0.5, -0.5, 0.5}}, angles);
    std::array<const urdf::FingerPoses*, 2> fingers{};
    std::array<const urdf::HandSkeleton*, 2> gloves{};
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      if (!moved.gloves[side]) continue;
      gloves[side] = &*model.human.gloves[side];
      urdf::FingerAngles bend{};
      for (Eigen::Vector3d& joint : bend) joint = {angle(0.9), angle(0.4), 0};
      urdf::FingerPoses& links = moved.gloves[side]->links;
      links = urdf::CompleteHand(*gloves[side], moved.links[At(urdf::HandSegmentOf(side))], {}, {},
                                 bend);
      fingers[side] = &links;
    }
    json links = json::array(), frames = json::array();
    for (const urdf::Pose& link : VisibleLinkPoses(moved)) {
      links.push_back(
          {{"position", Numbers(link.position)}, {"quaternion", Numbers(link.orientation)}});
    }
    const skin::BindPose bind = skin::BindPoseOf(skeleton, gloves);
    for (const urdf::Pose& frame : skin::FramePoses(moved.links, fingers, bind)) {
      frames.push_back(
          {{"position", Numbers(frame.position)}, {"rotation", Numbers(frame.orientation)}});
    }
    postures.push_back({{"links", links},
                        {"frames", frames},
                        {"surface", SurfaceToJson(whole, model, moved, gloves, fingers)},
                        {"coarse", SurfaceToJson(coarse, model, moved, gloves, fingers)}});
  }
  std::array<const urdf::HandSkeleton*, 2> gloves{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (person.gloves[side]) gloves[side] = &*model.human.gloves[side];
  }
  return {{"hex", Hex({buffer.begin(), buffer.end()})},
          {"coarse_hex", Hex({coarse_buffer.begin(), coarse_buffer.end()})},
          {"sky_step", kSkyStep},
          {"regions", RegionsToJson(model, gloves)},
          {"postures", postures}};
}

// As for `--figure skin:FILE`; it is not closed, and seen from both sides.
json OwnSkinToJson(const PersonState& person) {
  kinescope::testing::RigSample sample;
  sample.edit = [](json& document, std::string&) {
    document["materials"][0]["doubleSided"] = true;
    json& corners = document["accessors"][3];
    corners["count"] = corners["count"].get<std::size_t>() - 3;
  };
  const skin::SkinTemplate own = rig::SkinOf(rig::ReadRig(kinescope::testing::RigGlb(sample)));
  PersonModel model = *person.model;
  model.has_built_in_surface = true;
  const std::string buffer = SkinBuffer(model, &own);
  return {{"hex", Hex({buffer.begin(), buffer.end()})},
          {"vertices", own.size()},
          {"first_color", own.colors.front()}};
}

json Describe() {
  SceneState state = MakeScene(41, 3.25, 5'000'000'000, MakePersonModel(7), 2);
  state.waited_nanos = 120'000'000;
  state.view_heading = -2.25;
  state.made_nanos = 5'001'000'000;
  kinescope::testing::Wear(state.people[1]);
  state.objects = {{9, 22, "cart", {{1, -2, 0.5}, {0.5, -0.5, 0.5, 0.5}}, 5}};
  RobotState robot;
  auto drawn = std::make_shared<urdf::RobotModel>();
  drawn->links.resize(1);
  drawn->links[0].visuals.resize(1);
  robot.model = drawn;
  robot.moves = true;
  robot.world_from_link = {
      Eigen::Isometry3d(Eigen::Translation3d(3, 2, 1) * Eigen::Quaterniond(0.8, 0.36, -0.48, 0))};
  state.robots = {robot};
  state.camera_base = urdf::Pose{{4, 5, 6}, Eigen::Quaterniond(0.8, 0, 0, 0.6)};
  state.extent = {Eigen::Vector3d(-1, 0, 0.5), Eigen::Vector3d(2, 3, 4)};
  json people = json::array();
  for (const PersonState& person : state.people) {
    json links = json::array(), loads = json::array();
    for (const urdf::Pose& link : VisibleLinkPoses(person)) {
      links.push_back(
          {{"position", Numbers(link.position)}, {"quaternion", Numbers(link.orientation)}});
    }
    for (const JointLoad& load : person.loads) {
      const bool is_known = std::isfinite(load.ratio);
      loads.push_back({{"joint", load.joint},
                       {"loadClass", Name(load.load_class)},
                       {"radius", SphereRadius(load.joint, load.load_class, *person.model)},
                       {"position", Numbers(load.position)},
                       {"ratio", is_known ? json(load.shown_ratio) : json(nullptr)},
                       {"moment", is_known ? json(load.deciding_moment) : json(nullptr)},
                       {"capacity", load.capacity}});
    }
    json support = json::array(), held = json::array(), feet = json::array();
    for (const FootForce& foot : person.forces.feet) {
      if (foot.force.norm() <= kMinForceShown) continue;
      feet.push_back({{"cop", Numbers(foot.cop)}, {"force", Numbers(foot.force)}});
    }
    for (std::size_t i = 0; i < person.forces.support.size; ++i) {
      const Eigen::Vector2d& corner = person.forces.support.corners[i];
      support.push_back({corner.x(), corner.y()});
    }
    const HandLoadShape solids = ShapeOfHandLoad(person);
    for (std::size_t i = 0; i < solids.count; ++i) {
      const HandLoadSolid& solid = solids.solids[i];
      const Eigen::Quaterniond& q = solid.pose.orientation;
      held.push_back({{"kind", solid.kind == HandLoadSolid::Kind::kBox ? "box" : "cylinder"},
                      {"position", Numbers(solid.pose.position)},
                      {"quaternion", {q.x(), q.y(), q.z(), q.w()}},
                      {"size", Numbers(solid.size)}});
    }
    people.push_back({{"character", person.character},
                      {"revision", 7},
                      {"com", Numbers(*person.com)},
                      {"cop", Numbers(*person.cop)},
                      {"comSource", "mvn"},
                      {"massIsAssumed", true},
                      {"isDynamic", true},
                      {"groundIsMeasured", false},
                      {"leans", false},
                      {"comDisagrees", false},
                      {"compression", person.forces.lumbar->compression},
                      {"margin", *person.forces.margin_of_stability},
                      {"comMinusMvn", nullptr},
                      {"heldKg", {5, 0}},
                      {"metric", "total"},
                      {"support", support},
                      {"feet", feet},
                      {"held", held},
                      {"links", links},
                      {"loads", loads}});
  }
  json objects = json::array();
  for (const TrackedObject& object : state.objects) {
    objects.push_back({{"character", object.character},
                       {"number", object.number},
                       {"position", Numbers(object.pose.position)},
                       {"quaternion", Numbers(object.pose.orientation)}});
  }
  const StateMoment moment = {5'004'000'000, 3, history::Extent{2'000'000'000, 0, 12, 0}};
  PastEncoder past(7, moment);
  past.Add(state, R"({"details": 5})");
  past.Add(state, "");
  return {{"hex", Hex(EncodeState(state, moment))},
          {"past_hex", Hex(past.Finish(2'500'000'000))},
          {"state",
           {{"liveness", "live"},
            {"counter", state.counter},
            {"stateNumber", 41},
            {"sentMicros", 5'004'000},
            {"arrivalMicros", 5'000'000},
            {"stampMicros", state.stamp_nanos / 1000},
            {"timeCodeMillis", 3250},
            {"rateHz", 60},
            {"viewers", 3},
            {"floor", state.floor_z},
            {"waitedMillis", state.waited_nanos / 1'000'000},
            {"viewHeading", state.view_heading},
            {"madeMicros", state.made_nanos / 1000},
            {"oldestMicros", 2'000'000},
            {"oldestNumber", 12},
            {"people", people},
            {"objects", objects},
            {"ghosts", json::array()},
            {"robots", {{{{"position", {3, 2, 1}}, {"quaternion", {0.36, -0.48, 0, 0.8}}}}}},
            {"cameraBase", {{"position", {4, 5, 6}}, {"quaternion", {0, 0, 0.6, 0.8}}}},
            {"extent", {{"min", {-1, 0, 0.5}}, {"max", {2, 3, 4}}}}}},
          {"skins", {SkinToJson(state.people[0]), SkinToJson(state.people[1])}},
          {"own_skin", OwnSkinToJson(state.people[0])},
          {"picture_hex", Hex(EncodePicture({{0xFF, 0xD8, 0xFF}, 41, 5'000'000'000}))},
          {"class_limits", json::parse(ModelJson(&state, {}))["class_limits"]}};
}

// What the tests ask for over standard input.
class Orders {
 public:
  std::string mode = "live";
  int people = 1;
  std::array<double, 2> class_limits = kDefaultClassLimits;
  double compression = 2150;
  bool changed = true;
  bool ended = false;

  void WaitUntil(Clock::time_point time) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now()).count();
    pollfd input{0, POLLIN, 0};
    if (::poll(&input, 1, static_cast<int>(std::max<std::int64_t>(0, left))) <= 0) return;
    char bytes[256];
    const ssize_t count = ::read(0, bytes, sizeof bytes);
    ended = count <= 0;
    if (!ended) pending_.append(bytes, static_cast<std::size_t>(count));
    for (std::size_t end = pending_.find('\n'); end != std::string::npos;
         end = pending_.find('\n')) {
      Obey(pending_.substr(0, end));
      pending_.erase(0, end + 1);
    }
  }

  std::string stream() const {  // any thread
    const std::lock_guard<std::mutex> lock(mutex_);
    return stream_;
  }

 private:
  void Obey(const std::string& line) {
    changed = true;
    if (line.rfind("people ", 0) == 0) {
      people = std::stoi(line.substr(7));
    } else if (line.rfind("limits ", 0) == 0) {
      std::istringstream(line.substr(7)) >> class_limits[0] >> class_limits[1];
    } else if (line.rfind("compression ", 0) == 0) {
      compression = std::stod(line.substr(12));
    } else if (line.rfind("stream ", 0) == 0) {
      const std::lock_guard<std::mutex> lock(mutex_);
      stream_ = line.substr(7);
    } else {
      mode = line;
    }
  }
  std::string pending_;  // of a line that has not come to its end
  mutable std::mutex mutex_;
  std::string stream_;  // guarded by mutex_
};

SceneState NextState(const Orders& orders, const SceneState& last,
                     const std::shared_ptr<const PersonModel>& model, double seconds) {
  SceneState next = last;
  if (orders.mode == "live") {
    next = MakeScene(last.number, seconds, MonotonicNanos(), model, orders.people);
    for (PersonState& person : next.people) {
      person.forces.lumbar->compression = orders.compression;
    }
  } else if (orders.mode == "nodata") {
    next = SceneState();
    next.source = "udp://0.0.0.0:9763";
  } else {
    next.liveness = Liveness::kStale;
    for (PersonState& person : next.people) {
      for (JointLoad& load : person.loads) {
        load.load_class = LoadClass::kUnknown;
        load.ratio = load.shown_ratio = std::nan("");
        load.reason = "the stream has stopped";
      }
    }
  }
  next.number = last.number + 1;
  next.class_limits = orders.class_limits;
  return next;
}

struct Options {
  std::string mesh_folder;
  std::string diagnostics = "{}";
  bool worn = false;
  std::filesystem::path marks_file;  // empty: one of this run
  std::string alarms;                // file of rules; "": nothing is watched
};

void AddWorn(SceneState& state, const std::shared_ptr<const PersonModel>& model) {
  for (PersonState& person : state.people) kinescope::testing::Wear(person, 0.3, model);
  state.objects = {{9, 2, "HTC Vive", {{0.4, -0.6, 1.2}, {1, 0, 0, 0}}, state.stamp_nanos}};
}

// Hand loads set on the page, on their way into the made-up people.
struct Told {
  std::mutex mutex;
  std::map<int, HandLoad> loads;  // by character; guarded by mutex
};

void Hold(const std::map<int, HandLoad>& loads, SceneState& state) {
  for (PersonState& person : state.people) {
    const auto found = loads.find(person.character);
    const HandLoad load = found != loads.end() ? found->second : HandLoad();
    person.forces.stated_hand_load = load;
    person.forces.stated_hand_load.is_known = true;
    person.forces.hands[urdf::kRight].mass_kg = load.mass_kg[urdf::kRight];
    person.forces.hands[urdf::kLeft] = person.forces.hands[urdf::kRight];
    person.forces.hands[urdf::kLeft].mass_kg = 0;
  }
}

void Serve(HttpConfig config, const Options& options, PlainFeed* feed) {
  Told told;
  config.set_hand_load = [&told](int character, const HandLoad& load) {
    const std::lock_guard<std::mutex> lock(told.mutex);
    if (load.mass_kg[urdf::kRight] > 50) return std::string("load of more than 50 kg");
    told.loads[character] = load;
    return std::string();
  };
  Latest<SceneState> states;
  Latest<Picture> pictures;
  history::History history;
  config.history = &history;
  const ScratchFolder folder;
  marks::MarkBook book(
      {options.marks_file.empty() ? folder / "marks.jsonl" : options.marks_file,
       {"grasp", "lift", "place", "release", "step", "slip", "talk", "pain", "discard"}});
  config.marks = &book;
  std::optional<alarms::Alarms> watched;
  if (!options.alarms.empty()) {
    config.alarms = &watched.emplace(alarms::LoadRules(options.alarms), /*is_live=*/true);
  }
  Orders orders;
  config.stream = [&orders] { return orders.stream(); };
  HttpServer server(config, states, pictures, feed, [&] { return options.diagnostics; });
  std::cout << json{{"url", server.url()}, {"viewer_url", server.url(Role::kViewer)}}.dump()
            << std::endl;
  const auto model = MakePersonModel(1, options.mesh_folder);
  const auto worn_model =
      options.worn ? kinescope::testing::WornModel(*model, options.mesh_folder) : nullptr;
  SceneState state;
  const auto began = Clock::now();
  // On a busy machine samples are late, as from a suit, and none is missing: tests count them.
  for (auto due = began; !orders.ended; due = std::max(due + kPeriod, Clock::now() - kMostLate)) {
    orders.WaitUntil(due);
    if (watched) watched->OnTime(MonotonicNanos(), std::nullopt);
    if (orders.mode != "live" && !orders.changed) continue;
    orders.changed = false;
    const double seconds = std::chrono::duration<double>(due - began).count();
    state = NextState(orders, state, model, seconds);
    if (options.worn && orders.mode == "live") AddWorn(state, worn_model);
    {
      const std::lock_guard<std::mutex> lock(told.mutex);
      Hold(told.loads, state);
    }
    state.made_nanos = MonotonicNanos();
    const auto published = std::make_shared<const SceneState>(state);
    if (watched) watched->OnState(state);
    states.Publish(published);
    history.Add(published);
    if (feed != nullptr && feed->viewers() > 0 && state.number % 4 == 0) {
      pictures.Publish(std::make_shared<const Picture>(
          Picture{PlainJpeg(640, 360, feed->color()), state.number, state.arrival_nanos}));
    }
  }
}

int Main(const std::vector<std::string>& arguments) {
  HttpConfig config;
  config.port = 0;
  config.web_root = FindResource("web");
  config.web_bundle = FindWebBundle();
  config.cameras = MakeCameras();
  config.framing = MakeFraming();
  config.camera = "front";
  PlainFeed feed;
  PlainFeed* used_feed = &feed;
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "describe") return std::puts(Describe().dump().c_str()) < 0 ? 1 : 0;
    if (arguments[i] == "--no-pictures") used_feed = nullptr;
    if (arguments[i] == "--token" && i + 1 < arguments.size()) config.token = arguments[++i];
    if (arguments[i] == "--viewer_token" && i + 1 < arguments.size()) {
      config.viewer_token = arguments[++i];
    }
    if (arguments[i] == "--base_path" && i + 1 < arguments.size())
      config.base_path = arguments[++i];
    if (arguments[i] == "--tls_certificate" && i + 1 < arguments.size()) {
      config.tls.certificate = arguments[++i];
    }
    if (arguments[i] == "--tls_key" && i + 1 < arguments.size()) config.tls.key = arguments[++i];
    if (arguments[i] == "--meshes" && i + 1 < arguments.size())
      options.mesh_folder = arguments[++i];
    if (arguments[i] == "--worn") options.worn = true;
    if (arguments[i] == "--port" && i + 1 < arguments.size()) {
      config.port = std::stoi(arguments[++i]);
    }
    if (arguments[i] == "--marks_file" && i + 1 < arguments.size()) {
      options.marks_file = arguments[++i];
    }
    if (arguments[i] == "--alarms" && i + 1 < arguments.size()) options.alarms = arguments[++i];
    if (arguments[i] == "--diagnostics" && i + 1 < arguments.size()) {
      options.diagnostics = arguments[++i];
    }
  }
  Serve(config, options, used_feed);
  return 0;
}

}  // namespace
}  // namespace kinescope::http::testing

int main(int argc, char** argv) try {
  return kinescope::http::testing::Main({argv + 1, argv + argc});
} catch (const std::exception& error) {
  std::fprintf(stderr, "page_fixture_server: %s\n", error.what());
  return 2;
}
