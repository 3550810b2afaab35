#include "server/http/protocol.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/hand_load_shape.h"
#include "core/palette.h"
#include "core/person_links.h"
#include "core/system/check.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/unknown.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxCameraName = 64;

template <class Unsigned>
void PutAt(Bytes& bytes, std::size_t at, Unsigned value) {
  static_assert(std::is_unsigned_v<Unsigned>);
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    bytes[at + i] = static_cast<std::uint8_t>((value >> (8 * i)) & 0xFFu);
  }
}

std::uint64_t BitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

// Appends to `bytes`.
class Writer {
 public:
  explicit Writer(Bytes& bytes) : bytes_(bytes) {}

  template <class Unsigned>
  void Put(Unsigned value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    PutAt(bytes_, at, value);
  }
  void PutFloat(double value) {
    const auto narrow = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    Put(bits);
  }
  // Integers are sent as float64, too: exact up to 2^53, as in JavaScript.
  void PutDouble(double value) { Put(BitsOf(value)); }
  void PutVector(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) PutFloat(v[i]);
  }
  template <class Text>
  void PutBytes(const Text& more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
  }
  std::size_t size() const { return bytes_.size(); }

 private:
  Bytes& bytes_;
};

double Micros(std::int64_t nanos) { return static_cast<double>(nanos) / 1e3; }

// In units of 10 ms.
std::uint16_t WaitedUnits(std::int64_t nanos) {
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>(nanos / 10'000'000, 0, 65535));
}

std::uint8_t CountByte(std::size_t count) {
  return static_cast<std::uint8_t>(std::min<std::size_t>(count, 255));
}

void PutLoad(Writer& out, const JointLoad& load, const PersonModel& model) {
  const double radius_mm = 1000 * SphereRadius(load.joint, load.load_class, model);
  out.Put(static_cast<std::uint8_t>(load.joint));
  out.Put(static_cast<std::uint8_t>(load.load_class));
  out.Put(static_cast<std::uint16_t>(std::clamp(std::round(radius_mm), 0.0, 65535.0)));
  out.PutVector(load.position);
  out.PutFloat(load.shown_ratio);
  out.PutFloat(load.deciding_moment);
  out.PutFloat(load.capacity);
}

void PutPose(Writer& out, const urdf::Pose& pose) {
  out.PutVector(pose.position);
  const Eigen::Quaterniond& q = pose.orientation;
  for (const double part : {q.x(), q.y(), q.z(), q.w()}) out.PutFloat(part);
}

void PutObject(Writer& out, const TrackedObject& object) {
  out.Put(static_cast<std::uint32_t>(object.character));
  out.Put(static_cast<std::uint8_t>(object.number));
  for (int i = 0; i < 3; ++i) out.Put(std::uint8_t{0});
  PutPose(out, object.pose);
}

void PutPose(Writer& out, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond turn(pose.linear());
  PutPose(out, urdf::Pose{pose.translation(), turn});
}

void PutRobot(Writer& out, const RobotState& robot) {
  const std::vector<std::size_t> links = LinksToDraw(*robot.model);
  KINESCOPE_CHECK(links.size() <= std::numeric_limits<std::uint16_t>::max());
  out.Put(static_cast<std::uint16_t>(links.size()));
  out.Put(std::uint16_t{0});
  for (const std::size_t link : links) PutPose(out, robot.world_from_link.at(link));
}

// A force that is unknown, or too small to be shown, is NaN.
void PutFoot(Writer& out, const FootForce& foot) {
  const bool is_shown = foot.force.norm() > kMinForceShown && foot.cop.allFinite();
  const Eigen::Vector3d none = Eigen::Vector3d::Constant(kUnknown);
  out.PutVector(is_shown ? foot.cop : none);
  out.PutVector(is_shown ? foot.force : none);
}

void PutPerson(Writer& out, const PersonState& person) {
  KINESCOPE_CHECK(person.model != nullptr);
  const BodyForces& forces = person.forces;
  const HandLoadShape held = ShapeOfHandLoad(person);
  const std::uint8_t loads = CountByte(person.loads.size());
  const std::vector<urdf::Pose> links = VisibleLinkPoses(person);
  const unsigned flags =
      (person.com ? 1u : 0u) | (person.cop ? 2u : 0u) | (person.com_is_ours ? 4u : 0u) |
      (person.model->description.mass_is_assumed ? 8u : 0u) | (forces.is_dynamic ? 16u : 0u) |
      (forces.ground_is_measured ? 32u : 0u) | (forces.external_contact_suspected ? 64u : 0u) |
      (forces.com_disagrees ? 128u : 0u);
  out.Put(static_cast<std::uint32_t>(person.character));
  out.Put(static_cast<std::uint8_t>(flags));
  out.Put(static_cast<std::uint8_t>(links.size()));
  out.Put(loads);
  out.Put(CountByte(held.count));
  out.PutDouble(static_cast<double>(person.model->revision));
  out.PutVector(person.com.value_or(Eigen::Vector3d::Zero()));
  out.PutVector(person.cop.value_or(Eigen::Vector3d::Zero()));
  out.PutFloat(forces.lumbar ? forces.lumbar->compression : kUnknown);
  out.PutFloat(forces.margin_of_stability.value_or(kUnknown));
  out.PutFloat(forces.com_minus_mvn ? forces.com_minus_mvn->norm() : kUnknown);
  for (const HandForce& hand : forces.hands) out.PutFloat(hand.mass_kg);
  out.Put(CountByte(forces.support.size));
  out.Put(static_cast<std::uint8_t>(forces.metric));
  out.Put(std::uint16_t{0});
  for (const urdf::Pose& link : links) PutPose(out, link);
  for (std::size_t i = 0; i < loads; ++i) PutLoad(out, person.loads[i], *person.model);
  for (std::size_t i = 0; i < forces.support.size; ++i) {
    out.PutFloat(forces.support.corners[i].x());
    out.PutFloat(forces.support.corners[i].y());
  }
  for (const FootForce& foot : forces.feet) PutFoot(out, foot);
  for (std::size_t i = 0; i < held.count; ++i) {
    out.Put(static_cast<std::uint32_t>(held.solids[i].kind));
    PutPose(out, held.solids[i].pose);
    out.PutVector(held.solids[i].size);
  }
}

Bytes ToBytes(const json& message) {
  const std::string text = JsonText(message);
  return Bytes(text.begin(), text.end());
}

void PutState(Writer& out, const SceneState& state, const StateMoment& moment) {
  const std::size_t start = out.size();
  const std::uint8_t people = CountByte(state.people.size());
  const std::uint8_t objects = CountByte(state.objects.size());
  out.Put(static_cast<std::uint8_t>(MessageKind::kState));
  out.Put(kProtocolVersion);
  out.Put(static_cast<std::uint8_t>(state.liveness));
  out.Put(people);
  out.Put(state.counter);
  out.PutDouble(static_cast<double>(state.number));
  out.PutDouble(Micros(moment.now_nanos));
  out.PutDouble(Micros(state.arrival_nanos));
  out.PutDouble(Micros(state.stamp_nanos));
  out.PutDouble(static_cast<double>(state.time_code_millis));
  out.PutFloat(state.rate_hz);
  out.Put(static_cast<std::uint32_t>(moment.viewers));
  out.PutFloat(state.floor_z);
  const std::uint8_t ghosts = CountByte(state.ghosts.size());
  out.Put(objects);
  out.Put(ghosts);
  out.Put(WaitedUnits(state.waited_nanos));
  out.PutFloat(state.view_heading);
  std::vector<const RobotState*> robots;
  for (const RobotState& robot : state.robots) {
    if (robot.moves) robots.push_back(&robot);
  }
  robots.resize(CountByte(robots.size()));
  out.Put(static_cast<std::uint8_t>(robots.size()));
  out.Put(static_cast<std::uint8_t>(state.camera_base ? 1 : 0));
  out.Put(static_cast<std::uint8_t>(state.extent.isEmpty() ? 0 : 1));
  out.Put(std::uint8_t{0});
  out.PutDouble(Micros(state.made_nanos));
  const history::Extent kept = moment.kept.value_or(history::Extent{});
  out.PutDouble(Micros(kept.first_nanos));
  out.PutDouble(static_cast<double>(kept.first_number));
  KINESCOPE_CHECK(out.size() - start == kStateHeaderBytes);
  for (std::size_t i = 0; i < people; ++i) PutPerson(out, state.people[i]);
  for (std::size_t i = 0; i < objects; ++i) PutObject(out, state.objects[i]);
  for (std::size_t i = 0; i < ghosts; ++i) PutPerson(out, state.ghosts[i].person);
  for (const RobotState* const robot : robots) PutRobot(out, *robot);
  if (state.camera_base) PutPose(out, *state.camera_base);
  if (state.extent.isEmpty()) return;
  out.PutVector(state.extent.min());
  out.PutVector(state.extent.max());
}

}  // namespace

Bytes EncodeState(const SceneState& state, const StateMoment& moment) {
  Bytes bytes;
  bytes.reserve(kStateHeaderBytes + state.people.size() * std::size_t{1400});
  Writer out(bytes);
  PutState(out, state, moment);
  return bytes;
}

PastEncoder::PastEncoder(std::uint32_t id, const StateMoment& moment) : moment_(moment) {
  Writer out(bytes_);
  out.Put(static_cast<std::uint8_t>(MessageKind::kPast));
  out.Put(kProtocolVersion);
  out.Put(std::uint16_t{0});  // the count, see Finish()
  out.Put(id);
  out.Put(std::uint64_t{0});  // the time
  KINESCOPE_CHECK(bytes_.size() == kPastHeaderBytes);
}

void PastEncoder::Add(const SceneState& state, const std::string& details) {
  KINESCOPE_CHECK(count_ > 0 || !details.empty());
  const std::size_t at = bytes_.size();
  Writer out(bytes_);
  out.Put(std::uint32_t{0});
  out.Put(static_cast<std::uint32_t>(details.size()));
  PutState(out, state, moment_);
  PutAt(bytes_, at, static_cast<std::uint32_t>(bytes_.size() - at - kPastStateBytes));
  out.PutBytes(details);
  ++count_;
}

Bytes PastEncoder::Finish(std::int64_t until_nanos) {
  KINESCOPE_CHECK(count_ <= std::numeric_limits<std::uint16_t>::max());
  PutAt(bytes_, 2, static_cast<std::uint16_t>(count_));
  PutAt(bytes_, 8, BitsOf(Micros(until_nanos)));
  return std::move(bytes_);
}

Bytes EncodePicture(const Picture& picture) {
  Bytes bytes;
  bytes.reserve(kPictureHeaderBytes + picture.jpeg.size());
  Writer out(bytes);
  out.Put(static_cast<std::uint8_t>(MessageKind::kPicture));
  out.Put(kProtocolVersion);
  out.Put(std::uint16_t{0});
  out.Put(std::uint32_t{0});
  out.PutDouble(static_cast<double>(picture.state_number));
  out.PutDouble(Micros(picture.arrival_nanos));
  KINESCOPE_CHECK(out.size() == kPictureHeaderBytes);
  out.PutBytes(picture.jpeg);
  return bytes;
}

namespace {

std::optional<std::int64_t> ParseNanos(const json& micros) {
  constexpr double kMaxMicros = 9e15;  // exact as a float64, and as nanoseconds
  if (!micros.is_number() || !(std::abs(micros.get<double>()) < kMaxMicros)) return std::nullopt;
  return std::llround(1e3 * micros.get<double>());
}

// With the id, `value` has two members, or four.
std::optional<history::Span> ParseSpan(const json& value) {
  const auto from = value.find("micros"), until = value.find("until_micros"),
             every = value.find("every_micros");
  const bool is_run = until != value.end() && every != value.end();
  if (from == value.end() || value.size() != (is_run ? 4 : 2)) return std::nullopt;
  const auto from_nanos = ParseNanos(*from);
  const auto until_nanos = is_run ? ParseNanos(*until) : from_nanos;
  const auto every_nanos = is_run ? ParseNanos(*every) : 0;
  if (!from_nanos || !until_nanos || !every_nanos || *until_nanos < *from_nanos ||
      *every_nanos < 0) {
    return std::nullopt;
  }
  return history::Span{*from_nanos, *until_nanos, *every_nanos};
}

std::optional<LookBack> ParseLookBack(const json& value) {
  if (!value.is_object()) return std::nullopt;
  const auto id = value.find("id"), number = value.find("number");
  if (id == value.end() || !id->is_number_unsigned() ||
      id->get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    return std::nullopt;
  }
  LookBack look;
  look.id = id->get<std::uint32_t>();
  if (number != value.end()) {
    if (value.size() != 2 || !number->is_number_unsigned()) return std::nullopt;
    look.number = number->get<std::uint64_t>();
    return look;
  }
  const auto span = ParseSpan(value);
  if (!span) return std::nullopt;
  look.span = *span;
  return look;
}

std::optional<std::string> ParseName(const json& value) {
  const bool fits =
      value.is_string() && value.get_ref<const std::string&>().size() <= kMaxCameraName;
  return fits ? std::optional(value.get<std::string>()) : std::nullopt;
}

std::optional<std::uint64_t> ParseCount(const json& value) {
  return value.is_number_unsigned() ? std::optional(value.get<std::uint64_t>()) : std::nullopt;
}

std::optional<bool> ParseFlag(const json& value) {
  return value.is_boolean() ? std::optional(value.get<bool>()) : std::nullopt;
}

std::optional<double> ParseAnyNumber(const json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

// False: `value` is not of the kind.
template <class Value>
bool Store(std::optional<Value> value, std::optional<Value>& member) {
  member = std::move(value);
  return member.has_value();
}

struct CommandKind {
  const char* name;
  Role least;
  const char* expected;
  const char* example;  // a valid value
  bool (*read)(const json& value, ClientCommand& command);
};

// A new command: a line here, and one in docs/http.md.
constexpr std::array<CommandKind, 8> kCommandKinds = {{
    {"pictures", Role::kViewer, "true or false", "true",
     [](const json& value, ClientCommand& c) { return Store(ParseFlag(value), c.pictures); }},
    {"dark", Role::kViewer, "true or false", "true",
     [](const json& value, ClientCommand& c) { return Store(ParseFlag(value), c.dark); }},
    {"camera", Role::kOperator, "a name", "\"front\"",
     [](const json& value, ClientCommand& c) { return Store(ParseName(value), c.camera); }},
    {"look", Role::kViewer,
     "{\"id\": a count, \"number\": that of a state}, {\"id\": a count, \"micros\": a time of this "
     "server}, or the latter with \"until_micros\": a time not before it, and \"every_micros\": 0 "
     "or "
     "more",
     R"({"id": 1, "number": 0})",
     [](const json& value, ClientCommand& c) { return Store(ParseLookBack(value), c.look); }},
    {"few_states", Role::kViewer, "true or false", "true",
     [](const json& value, ClientCommand& c) { return Store(ParseFlag(value), c.few_states); }},
    {"ping", Role::kViewer, "a number", "1",
     [](const json& value, ClientCommand& c) { return Store(ParseAnyNumber(value), c.ping); }},
    {"seen_states", Role::kViewer, "a count", "0",
     [](const json& value, ClientCommand& c) { return Store(ParseCount(value), c.seen_states); }},
    {"seen_pictures", Role::kViewer, "a count", "0",
     [](const json& value, ClientCommand& c) { return Store(ParseCount(value), c.seen_pictures); }},
}};

std::string KnownCommands() {
  std::string text;
  for (const CommandKind& kind : kCommandKinds) {
    text += std::string(text.empty() ? "" : ", ") + '"' + kind.name + '"';
  }
  return text;
}

}  // namespace

std::vector<CommandInfo> Commands() {
  std::vector<CommandInfo> commands;
  commands.reserve(kCommandKinds.size());
  for (const CommandKind& kind : kCommandKinds) {
    commands.push_back(
        {kind.name, kind.least, std::string("{\"") + kind.name + "\": " + kind.example + "}"});
  }
  return commands;
}

tl::expected<ClientCommand, std::string> ParseCommand(std::string_view text) {
  const json message = ParseJson(text);
  if (!message.is_object()) return tl::unexpected(std::string("expected one JSON object"));
  ClientCommand command;
  for (const auto& [key, value] : message.items()) {
    const auto* const kind =
        std::find_if(kCommandKinds.begin(), kCommandKinds.end(),
                     [&, &name = key](const CommandKind& each) { return name == each.name; });
    if (kind == kCommandKinds.end()) {
      return tl::unexpected("unknown command; expected one of " + KnownCommands());
    }
    if (!kind->read(value, command)) {
      return tl::unexpected(std::string(kind->name) + ": expected " + kind->expected);
    }
    if (kind->least > command.least) {
      command.least = kind->least;
      command.needs_least = kind->name;
    }
  }
  return command;
}

Bytes EncodePong(double ping, std::int64_t now_nanos) {
  return ToBytes({{"pong", ping}, {"server_micros", Micros(now_nanos)}});
}

Bytes EncodeError(const std::string& reason) { return ToBytes({{"error", reason}}); }

std::string SocketProtocol() {
  return "kinescope.v" + std::to_string(static_cast<int>(kProtocolVersion));
}

bool CanRead(std::string_view offered_protocols) {
  if (offered_protocols.empty()) return true;
  const std::string wanted = SocketProtocol();
  while (!offered_protocols.empty()) {
    const std::size_t end = offered_protocols.find(',');
    std::string_view name = offered_protocols.substr(0, end);
    offered_protocols.remove_prefix(end == std::string_view::npos ? name.size() : end + 1);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    if (name == wanted) return true;
  }
  return false;
}

}  // namespace kinescope::http
