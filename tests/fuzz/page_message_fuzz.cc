// Any text as what a browser says over the WebSocket: it is understood or answered with an error,
// and neither the camera nor the answers leave their bounds.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/system/check.h"
#include "server/history/history.h"
#include "server/http/hand_load_order.h"
#include "server/http/hub.h"

namespace page_message_fuzz {
namespace {

using namespace kinescope;

class Client : public http::HubClient {
 public:
  explicit Client(http::Role role) : role_(role) {}
  void Offer(http::Slot, http::SharedBytes message) override {
    KINESCOPE_CHECK(message != nullptr);
    KINESCOPE_CHECK(message->size() < 65536);
  }
  void SetWantsPictures(bool wanted) override { wants_ = wanted; }
  bool wants_pictures() const override { return wants_; }
  void SetWantsDark(bool wanted) override { dark_ = wanted; }
  bool wants_dark() const override { return dark_; }
  bool OnSeen(http::Slot, std::uint64_t) override { return true; }
  http::ClientCounters counters() const override { return {}; }
  const std::string& address() const override { return address_; }
  http::Role role() const override { return role_; }

 private:
  bool wants_ = false;
  bool dark_ = false;
  const http::Role role_;
  const std::string address_ = "127.0.0.1";
};

class Feed : public http::PictureFeed {
 public:
  void SetViewers(int count) override { KINESCOPE_CHECK(count == 0 || count == 1); }
  bool SetCamera(const std::string& camera) override { return camera == "front"; }
  void SetDark(bool) override {}
  std::vector<std::uint8_t> SnapshotPng(const http::SnapshotRequest&) override { return {}; }
};

// What clients look back to.
const history::History& Past() {
  static history::History history;
  if (history.extent()) return history;
  for (std::uint64_t number = 5; number < 9; ++number) {
    auto state = std::make_shared<SceneState>();
    state->number = number;
    state->made_nanos = 1000 * static_cast<std::int64_t>(number);
    history.Add(std::move(state));
  }
  return history;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Latest<SceneState> states;
  Latest<http::Picture> pictures;
  Feed feed;
  http::Counters counters;
  http::Hub hub(states, pictures, &feed, &Past(), "iso", counters);
  for (const http::Role role : {http::Role::kViewer, http::Role::kOperator}) {
    Client client(role);
    KINESCOPE_CHECK(hub.Join(client));
    hub.OnMessage(client, {reinterpret_cast<const char*>(data), size});
    hub.Leave(client);
    KINESCOPE_CHECK(role == http::Role::kOperator || hub.camera() == "iso");
  }
  // The same bytes as the body of POST /api/v1/hand_load.
  const auto order = http::ParseHandLoadOrder({reinterpret_cast<const char*>(data), size});
  if (order) {
    const HandLoad& load = order->load;
    KINESCOPE_CHECK(std::isfinite(load.mass_kg[0] + load.mass_kg[1] + load.both_kg) ||
                    load.mass_kg[0] > 1e300 || load.mass_kg[1] > 1e300 || load.both_kg > 1e300);
    KINESCOPE_CHECK(order->person.value_or(0) >= 0);
  } else {
    KINESCOPE_CHECK(!order.error().empty());
  }
  return 0;
}

}  // namespace page_message_fuzz
