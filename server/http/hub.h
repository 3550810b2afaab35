/// All WebSocket clients: encodes each state and each picture once and offers it to those who want
/// it. Server's thread only.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/latest.h"
#include "core/scene_state.h"
#include "server/http/counters.h"
#include "server/http/protocol.h"
#include "server/http/server.h"

namespace kinescope::http {

/// What a client keeps for sending: one place each, so that the newest replaces the older.
enum class Slot { kError, kPong, kDetails, kState, kPicture };
inline constexpr int kSlotCount = 5;
constexpr bool IsBinary(Slot slot) { return slot == Slot::kState || slot == Slot::kPicture; }

class HubClient {
 public:
  virtual ~HubClient() = default;
  virtual void Offer(Slot slot, SharedBytes message) = 0;
  virtual void SetWantsPictures(bool wanted) = 0;
  virtual bool wants_pictures() const = 0;
  /// It has taken so many of those that were sent in `slot`; false when there were not so many.
  [[nodiscard]] virtual bool OnSeen(Slot slot, std::uint64_t count) = 0;
  virtual ClientCounters counters() const = 0;
};

class Hub {
 public:
  using Clock = std::chrono::steady_clock;

  /// `feed` may be null. Everything is borrowed.
  Hub(const Latest<SceneState>& states, const Latest<Picture>& pictures, PictureFeed* feed,
      std::string camera, Counters& counters);

  /// False: kMaxClients are there already.
  [[nodiscard]] bool Join(HubClient& client);
  void Leave(HubClient& client);  // does nothing for one that is not there

  /// Sends the newest state to all, unless one went out less than kMinStateInterval ago: then the
  /// caller comes back after the time returned. Zero: sent.
  Clock::duration SendState(Clock::time_point now);
  void SendPicture();

  /// To be called every kTickInterval: repeats a state that is kHeartbeat old, so that clients see
  /// that the server lives and how old the state is; sends details that changed.
  void Tick(Clock::time_point now);

  /// What `client` said. Answers go to it, a change of camera to everybody.
  void OnMessage(HubClient& client, std::string_view text);

  int client_count() const { return client_count_; }  // any thread
  const std::string& camera() const { return camera_; }
  std::vector<ClientCounters> client_counters() const;

  static constexpr std::chrono::milliseconds kMinStateInterval{8};  // no screen shows more
  static constexpr std::chrono::milliseconds kTickInterval{125};
  static constexpr std::chrono::milliseconds kHeartbeat{350};

 private:
  void SetPictures(HubClient& client, bool wanted);
  void CountViewers();  // after a client began or stopped to want pictures
  SharedBytes EncodeNewestState() const;
  SharedBytes EncodeDetails() const;

  const Latest<SceneState>& states_;
  const Latest<Picture>& pictures_;
  PictureFeed* const feed_;
  std::string camera_;  // of the live picture
  Counters& counters_;
  std::set<HubClient*> clients_;
  std::atomic<int> client_count_{0};  // clients_.size(), for other threads
  int viewers_ = 0;                   // clients that want pictures, as told to feed_
  SharedBytes details_;               // as sent to all last
  Clock::time_point state_sent_at_{};
};

}  // namespace kinescope::http
