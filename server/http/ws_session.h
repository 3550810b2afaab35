/// Serves one WebSocket client: reads its commands and sends the messages of the hub one at a time.
/// A message that is replaced by a newer one before it is sent is dropped and counted. Server's
/// thread only.
#pragma once

#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/http/bucket.h"
#include "server/http/hub.h"
#include "server/http/stream.h"

namespace kinescope::http {

class WsSession final : public HubClient, public std::enable_shared_from_this<WsSession> {
 public:
  using Upgrade = boost::beast::http::request<boost::beast::http::string_body>;

  /// `hub` is borrowed and must outlive the session.
  WsSession(Stream stream, std::string address, Role role, Hub& hub, std::uint64_t id);
  ~WsSession() override;

  /// Accepts the connection; from here on the session keeps itself alive.
  void Accept(const Upgrade& request);

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
  void OnRead(boost::beast::error_code error);
  void WriteNext();
  void OnWritten(Slot slot, boost::beast::error_code error);
  bool MayWrite(std::size_t slot) const;
  void OnControlFrame();
  void Close();

  boost::beast::websocket::stream<Stream> socket_;
  const std::string address_;
  const Role role_;
  Hub& hub_;
  ClientCounters counters_;
  bool wants_dark_ = false;
  boost::beast::flat_buffer incoming_;
  std::array<SharedBytes, kSlotCount> waiting_;  // by Slot
  SharedBytes sending_;                          // null: no message is being sent
  std::size_t last_slot_ = 0;
  std::optional<std::uint64_t> seen_states_;  // as the client reported; absent: it never does
  std::optional<std::uint64_t> seen_pictures_;
  Bucket messages_, control_frames_;  // that the client may still send
  std::chrono::steady_clock::time_point sending_since_{};
  bool open_ = false;
};

}  // namespace kinescope::http
