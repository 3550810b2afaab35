#include "server/http/ws_session.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "server/http/bucket.h"

namespace kinescope::http {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

constexpr std::size_t kMaxMessageBytes = 4096;
constexpr int kMaxMessagesPerSecond = 200;
constexpr int kMaxControlFramesPerSecond = 20;        // pings and pongs; browsers send one in 15 s
constexpr std::size_t kMaxBytesPerSecond = 64 << 10;  // a page sends 4 kB
constexpr std::chrono::seconds kLongestWrite{30};     // of one message
// Sent, but not yet acknowledged: a tenth of a second at 125 states/s, and one picture under way
// while one is displayed.
constexpr std::uint64_t kStatesAhead = 12;
constexpr std::uint64_t kPicturesAhead = 2;

websocket::stream_base::timeout Timeouts() {
  websocket::stream_base::timeout timeouts{};
  timeouts.handshake_timeout = std::chrono::seconds(10);
  // A client that neither reads nor answers a ping for this time is disconnected; a page reconnects
  // by itself.
  timeouts.idle_timeout = std::chrono::seconds(30);
  timeouts.keep_alive_pings = true;
  return timeouts;
}

// With one more now.
bool IsFlooded(Bucket& bucket) {
  const auto now = Clock::now();
  if (bucket.WaitFor(1, now).count() > 0) return true;
  bucket.Take(1, now);
  return false;
}

class WsSession final : public HubClient, public std::enable_shared_from_this<WsSession> {
 public:
  /// `hub` is borrowed and must outlive the session.
  WsSession(Stream stream, std::string address, Role role, Hub& hub, std::uint64_t id);
  ~WsSession() override;

  /// Accepts the connection; from here on the session keeps itself alive.
  void Accept(const IncomingRequest& request);

  void Offer(Slot slot, SharedBytes message) override;
  void SetWantsPictures(bool wanted) override;
  bool wants_pictures() const override { return counters_.pictures; }
  void SetWantsDark(bool wanted) override { wants_dark_ = wanted; }
  bool wants_dark() const override { return wants_dark_; }
  [[nodiscard]] bool OnSeen(Slot slot, std::uint64_t count) override;
  ClientCounters counters() const override { return counters_; }
  const std::string& address() const override { return address_; }
  Role role() const override { return role_; }

 private:
  void Read();
  void OnRead(beast::error_code error);
  void WriteNext();
  void OnWritten(Slot slot, beast::error_code error);
  bool MayWrite(std::size_t slot) const;
  void OnControlFrame();
  void Close();

  websocket::stream<Stream, /*deflateSupported=*/false> socket_;
  const std::string address_;
  const Role role_;
  Hub& hub_;
  ClientCounters counters_;
  bool wants_dark_ = false;
  beast::flat_buffer incoming_;
  std::array<SharedBytes, kSlotCount> waiting_;  // by Slot
  SharedBytes sending_;                          // null: no message is being sent
  std::size_t last_slot_ = 0;
  std::optional<std::uint64_t> seen_states_;  // as the client reported; absent: it never does
  std::optional<std::uint64_t> seen_pictures_;
  Bucket messages_, control_frames_;  // that the client may still send
  std::chrono::steady_clock::time_point sending_since_{};
  bool open_ = false;
};

WsSession::WsSession(Stream stream, std::string address, Role role, Hub& hub, std::uint64_t id)
    : socket_(std::move(stream)),
      address_(std::move(address)),
      role_(role),
      hub_(hub),
      messages_(kMaxMessagesPerSecond, kMaxMessagesPerSecond, Clock::now()),
      control_frames_(kMaxControlFramesPerSecond, kMaxControlFramesPerSecond, Clock::now()) {
  counters_.id = id;
  // The timer of the TCP stream would end the connection; from here the WebSocket's timeouts apply.
  socket_.next_layer().ExpiresNever();
  socket_.next_layer().LimitReading(kMaxBytesPerSecond);
  socket_.set_option(Timeouts());
  socket_.read_message_max(kMaxMessageBytes);
  // Called while a read of this session is in progress, so that the session exists.
  socket_.control_callback([this](websocket::frame_type, beast::string_view) { OnControlFrame(); });
  socket_.auto_fragment(false);  // one message, one write: no second copy, no second wake-up
}

WsSession::~WsSession() { hub_.Leave(*this); }

void WsSession::Accept(const IncomingRequest& request) {
  const bool is_versioned = !request[beast::http::field::sec_websocket_protocol].empty();
  socket_.set_option(
      websocket::stream_base::decorator([is_versioned](websocket::response_type& response) {
        response.set(beast::http::field::server, "kinescope");
        if (is_versioned) {
          response.set(beast::http::field::sec_websocket_protocol, SocketProtocol());
        }
      }));
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->open_ = true;
    if (!self->hub_.Join(*self)) return self->Close();  // other clients joined during the handshake
    self->Read();
  });
}

void WsSession::Offer(Slot slot, SharedBytes message) {
  if (!open_) return;
  SharedBytes& place = waiting_[static_cast<std::size_t>(slot)];
  if (place != nullptr && slot == Slot::kState) ++counters_.states_dropped;
  if (place != nullptr && slot == Slot::kPicture) ++counters_.pictures_dropped;
  place = std::move(message);
  if (sending_ == nullptr) return WriteNext();
  // Something is offered every 0.4 s. Cancelled operations end later, in OnRead and OnWritten.
  if (std::chrono::steady_clock::now() - sending_since_ > kLongestWrite) {
    socket_.next_layer().Cancel();
  }
}

void WsSession::SetWantsPictures(bool wanted) {
  counters_.pictures = wanted;
  if (!wanted) waiting_[static_cast<std::size_t>(Slot::kPicture)] = nullptr;
}

bool WsSession::OnSeen(Slot slot, std::uint64_t count) {
  const bool is_state = slot == Slot::kState;
  // The client may have received one more than is counted here: the one whose write is ending.
  const std::uint64_t sent = (is_state ? counters_.states_sent : counters_.pictures_sent) + 1;
  if (count > sent) return false;
  (is_state ? seen_states_ : seen_pictures_) = count;
  if (sending_ == nullptr) WriteNext();
  return true;
}

bool WsSession::MayWrite(std::size_t slot) const {
  if (waiting_[slot] == nullptr) return false;
  switch (static_cast<Slot>(slot)) {
    case Slot::kState: return !seen_states_ || counters_.states_sent < *seen_states_ + kStatesAhead;
    case Slot::kPicture:
      return !seen_pictures_ || counters_.pictures_sent < *seen_pictures_ + kPicturesAhead;
    default: return true;
  }
}

void WsSession::Read() {
  socket_.async_read(incoming_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->OnRead(error);
  });
}

void WsSession::OnRead(beast::error_code error) {
  if (error || IsFlooded(messages_)) return Close();
  const auto bytes = incoming_.cdata();
  hub_.OnMessage(*this, {static_cast<const char*>(bytes.data()), bytes.size()});
  incoming_.consume(incoming_.size());
  if (open_) Read();
}

void WsSession::OnControlFrame() {
  // The read that has called this ends with an error, in OnRead.
  if (IsFlooded(control_frames_)) socket_.next_layer().Close();
}

void WsSession::WriteNext() {
  // Round robin: at 240 states per second pictures are still sent, and vice versa.
  for (std::size_t step = 1; step <= kSlotCount; ++step) {
    const std::size_t index = (last_slot_ + step) % kSlotCount;
    if (!MayWrite(index)) continue;
    last_slot_ = index;
    sending_ = std::move(waiting_[index]);
    waiting_[index] = nullptr;
    sending_since_ = std::chrono::steady_clock::now();
    const auto slot = static_cast<Slot>(index);
    socket_.binary(IsBinary(slot));
    socket_.async_write(boost::asio::buffer(*sending_),
                        [self = shared_from_this(), slot](beast::error_code error, std::size_t) {
                          self->OnWritten(slot, error);
                        });
    return;
  }
}

void WsSession::OnWritten(Slot slot, beast::error_code error) {
  sending_ = nullptr;
  if (error) return Close();
  if (slot == Slot::kState) ++counters_.states_sent;
  if (slot == Slot::kPicture) ++counters_.pictures_sent;
  if (open_) WriteNext();
}

void WsSession::Close() {
  if (!open_) return;
  open_ = false;
  hub_.Leave(*this);
  beast::error_code ignored;
  socket_.next_layer().socket().close(ignored);
}

}  // namespace

void ServeWebSocket(Stream stream, std::string address, Role role, Hub& hub, std::uint64_t id,
                    const IncomingRequest& request) {
  std::make_shared<WsSession>(std::move(stream), std::move(address), role, hub, id)
      ->Accept(request);
}

}  // namespace kinescope::http
