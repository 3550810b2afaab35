/// Serves all WebSocket clients: encodes each state and each picture once and offers it to the
/// clients that want it. Server's thread only, except where stated.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/playback.h"
#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/http/bucket.h"
#include "server/http/counters.h"
#include "server/http/protocol.h"
#include "server/http/role.h"
#include "server/http/server.h"

namespace kinescope::http {

/// Messages that wait for sending: one place per slot, so that a newer message replaces the older
/// one.
enum class Slot { kError, kPong, kDetails, kStream, kAlarms, kControls, kState, kPast, kPicture };
inline constexpr int kSlotCount = 9;
constexpr bool IsBinary(Slot slot) { return slot >= Slot::kState; }

class HubClient {
 public:
  virtual ~HubClient() = default;
  virtual void Offer(Slot slot, SharedBytes message) = 0;
  virtual void SetWantsPictures(bool wanted) = 0;
  virtual bool wants_pictures() const = 0;
  virtual void SetWantsDark(bool wanted) = 0;
  virtual bool wants_dark() const = 0;  // of the live picture
  /// Acknowledges `count` messages in `slot`; false if fewer were sent.
  [[nodiscard]] virtual bool OnSeen(Slot slot, std::uint64_t count) = 0;
  virtual ClientCounters counters() const = 0;
  virtual const std::string& address() const = 0;  // of the client's machine
  virtual Role role() const = 0;
};

class Hub {
 public:
  using Clock = std::chrono::steady_clock;

  using GetPlayback = std::function<std::shared_ptr<const Playback>()>;

  /// `feed`, `history`, `playback` and `marks` may be null. All references are borrowed.
  Hub(const Latest<SceneState>& states, const Latest<Picture>& pictures, PictureFeed* feed,
      const history::History* history, std::string camera, Counters& counters,
      GetPlayback playback = nullptr, const marks::MarkBook* marks = nullptr);

  /// Whether a client at `address` may join: while its address has fewer clients than there are
  /// free places. So one address takes at most half of all, and never the last one.
  [[nodiscard]] bool HasPlaceFor(const std::string& address) const;
  /// Why it may not, for the client, with the way out.
  [[nodiscard]] std::string WhyNoPlaceFor(const std::string& address) const;
  /// False if there is no place for it.
  [[nodiscard]] bool Join(HubClient& client);
  void Leave(HubClient& client);  // does nothing for a client that has not joined

  /// Sends the newest state to all clients; to those for whom a few are enough only if they have
  /// got none for kFewInterval. If the last one was sent less than kMinStateInterval ago, it
  /// returns the time after which to call again; zero: sent.
  Clock::duration SendState(Clock::time_point now);
  void SendPicture();

  /// Call it every kTickInterval. It repeats a state that is kHeartbeat old, so that clients see
  /// that the server runs and how old the state is, and sends changed details.
  void Tick(Clock::time_point now);

  /// Sends the health of the stream, the alarms, or the state of the controls, to all clients if it
  /// has changed, and to those who join later. `news`: a JSON object; "": not known yet.
  void SendNews(Slot slot, const std::string& news);

  /// `on_camera` is called when the camera of the live picture has changed.
  using OnCamera = std::function<void(const std::string& before, const std::string& after,
                                      std::string_view role)>;
  void SetOnCamera(OnCamera on_camera) { on_camera_ = std::move(on_camera); }

  using GetSurroundings = std::function<std::shared_ptr<const Surroundings>()>;
  /// Those that clients are told of. May be null.
  void SetSurroundings(GetSurroundings surroundings) { surroundings_ = std::move(surroundings); }

  /// Processes a message of `client`. Answers are sent to this client, a change of camera to all. A
  /// message with a command that the client's role does not permit has no effect.
  void OnMessage(HubClient& client, std::string_view text);

  /// Sets the camera of the live picture, which all clients are told. @param role  of who does so
  /// @return why not; "": done
  [[nodiscard]] std::string SelectCamera(const std::string& camera, std::string_view role);

  int client_count() const { return client_count_; }  // any thread
  const std::string& camera() const { return camera_; }
  std::vector<ClientCounters> client_counters() const;

  static constexpr std::chrono::milliseconds kMinStateInterval{8};  // faster than any screen
  static constexpr std::chrono::milliseconds kTickInterval{125};
  static constexpr std::chrono::milliseconds kHeartbeat{350};
  static constexpr std::chrono::milliseconds kFewInterval{240};  // with 60 states/s: four a second
  // Former states per client: a page that plays needs at most 84 a second. Beyond these, an answer
  // has one state.
  static constexpr double kPastStatesAtOnce = 128, kPastStatesPerSecond = 200;

 private:
  // What the hub remembers of a client.
  struct Seat {
    bool few_states = false;
    Bucket past_states{kPastStatesAtOnce, kPastStatesPerSecond, Clock::now()};  // still to be had
  };

  void SetFewStates(HubClient& client, bool few);
  void LookBack(HubClient& client, const LookBack& wanted);
  [[nodiscard]] StateMoment Moment() const;
  void SetPictures(HubClient& client, bool wanted);
  [[nodiscard]] int CountOf(const std::string& address) const;
  void ChooseTheme();
  void CountViewers();  // call after a client has changed whether it wants pictures
  SharedBytes EncodeNewestState() const;
  SharedBytes EncodeDetails() const;
  /// `surroundings`: their revision, 0: none.
  std::string DetailsOf(const SceneState* state, std::uint64_t surroundings) const;

  const Latest<SceneState>& states_;
  const Latest<Picture>& pictures_;
  PictureFeed* const feed_;
  const history::History* const history_;
  std::string camera_;  // of the live picture
  Counters& counters_;
  const GetPlayback playback_;
  const marks::MarkBook* const marks_;
  OnCamera on_camera_;            // may be null
  GetSurroundings surroundings_;  // may be null
  std::map<HubClient*, Seat> clients_;
  std::atomic<int> client_count_{0};  // clients_.size(), readable on other threads
  int viewers_ = 0;                   // clients that want pictures, as reported to feed_
  bool is_dark_ = false;              // the live picture, as reported to feed_
  SharedBytes details_;               // as last sent to all clients
  std::map<Slot, SharedBytes> news_;  // as last sent to all clients
  SharedBytes picture_;               // as last sent to all viewers; null without any
  Clock::time_point state_sent_at_{}, few_sent_at_{};  // to all; also to those who want few
};

}  // namespace kinescope::http
