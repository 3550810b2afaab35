/// Encodes and parses the WebSocket messages; docs/http.md describes them and web/state_codec.js
/// reads them. Everything is little-endian. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "core/scene_state.h"
#include "server/history/history.h"
#include "server/http/role.h"
#include "server/http/server.h"

namespace kinescope::http {

using Bytes = std::vector<std::uint8_t>;
using SharedBytes = std::shared_ptr<const Bytes>;  // encoded once, sent to every client

/// First byte of a binary message.
enum class MessageKind : std::uint8_t { kState = 1, kPicture = 2, kPast = 3 };

inline constexpr std::uint8_t kProtocolVersion = 10;

/// "kinescope.v10": the name of this version among the subprotocols of a WebSocket.
[[nodiscard]] std::string SocketProtocol();

/// Whether a client that offers these subprotocols (a list, separated by commas) can read the
/// messages. One that offers none has to look at the version in each message.
[[nodiscard]] bool CanRead(std::string_view offered_protocols);

inline constexpr std::size_t kStateHeaderBytes = 96;
inline constexpr std::size_t kPersonHeaderBytes = 64;
inline constexpr std::size_t kLinkBytes = 28;
inline constexpr std::size_t kLoadBytes = 28;
inline constexpr std::size_t kCornerBytes = 8;
inline constexpr std::size_t kFootBytes = 24;
inline constexpr std::size_t kSolidBytes = 44;
inline constexpr std::size_t kObjectBytes = 36;
inline constexpr std::size_t kRobotHeaderBytes = 4;
inline constexpr std::size_t kPictureHeaderBytes = 24;
inline constexpr std::size_t kPastHeaderBytes = 16;
inline constexpr std::size_t kPastStateBytes = 8;  // before each state of it

/// What a message says beside its state.
struct StateMoment {
  std::int64_t now_nanos = 0;  // of the monotonic clock, so that the page can show the age
  int viewers = 0;
  std::optional<history::Extent> kept;  // that viewers can look back to
};

/// At most 255 people, 255 loads per person, 255 tracked objects and 255 robots that move are sent.
/// Links are those of core/person_links.h, of robots LinksToDraw().
Bytes EncodeState(const SceneState& state, const StateMoment& moment);

/// The answer to LookBack `id`: former states, each with the content of the message "details" of
/// its moment.
class PastEncoder {
 public:
  PastEncoder(std::uint32_t id, const StateMoment& moment);

  /// `details` "": those of the state before. @pre not so for the first one
  void Add(const SceneState& state, const std::string& details);
  std::size_t count() const { return count_; }
  std::size_t bytes() const { return bytes_.size(); }  // of the message

  /// `until_nanos`: up to when there are no other states in what was asked for. Ends the encoder.
  Bytes Finish(std::int64_t until_nanos);

 private:
  const StateMoment moment_;
  std::size_t count_ = 0;
  Bytes bytes_;
};

Bytes EncodePicture(const Picture& picture);

/// A request for former states: the one of `number`, or those of `span`.
struct LookBack {
  std::uint32_t id = 0;  // of the client, returned unchanged
  history::Span span;
  std::optional<std::uint64_t> number;
};

/// A member of a command, and who may send it.
struct CommandInfo {
  std::string name;
  Role least;           // a command that changes what others see: kOperator
  std::string example;  // a valid command with this member only
};
/// All of them, for messages and tests.
[[nodiscard]] std::vector<CommandInfo> Commands();

/// A command of a client: one JSON object with any of these members.
struct ClientCommand {
  Role least = Role::kViewer;         // that all of its members need
  std::string needs_least;            // the first member that needs it; "": there is none
  std::optional<bool> pictures;       // whether the client wants the live picture
  std::optional<bool> dark;           // and whether it wants it dark
  std::optional<std::string> camera;  // of the live picture
  std::optional<LookBack> look;
  std::optional<bool> few_states;  // whether the newest state is enough a few times a second
  std::optional<double> ping;      // the client's clock; returned unchanged
  // Number of states and pictures that the client has processed since it connected. A client that
  // reports these is sent only a few messages ahead, because messages that wait in a browser cannot
  // be replaced by newer ones.
  std::optional<std::uint64_t> seen_states;
  std::optional<std::uint64_t> seen_pictures;
};

/// The reason of an error is one line for the client. Unknown members are rejected, so that
/// misspelt ones are noticed.
[[nodiscard]] tl::expected<ClientCommand, std::string> ParseCommand(std::string_view text);

Bytes EncodePong(double ping, std::int64_t now_nanos);
Bytes EncodeError(const std::string& reason);

}  // namespace kinescope::http
