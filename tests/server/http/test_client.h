/// HTTP and WebSocket as a test's client speaks them: real sockets on 127.0.0.1, and every wait
/// ends after 60 s with an exception that says what was waited for.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace kinescope::http::testing {

using Headers = std::map<std::string, std::string>;

struct Response {
  int status = 0;
  Headers headers;  // names in lower case
  std::string body;
  nlohmann::json json() const { return nlohmann::json::parse(body); }
};

/// One request on a connection of its own. `target` is sent as it is. `from`: the address of this
/// client, of 127.0.0.0/8.
Response Fetch(int port, const std::string& target, const Headers& headers = {},
               const std::string& method = "GET", const std::string& body = "",
               const std::string& from = "");

/// Sends `bytes`, then reads until the server closes the connection or `enough` bytes came.
std::string Exchange(int port, const std::string& bytes, std::size_t enough = 12);

/// A connection that sent `bytes` and stays open.
class OpenConnection {
 public:
  OpenConnection(int port, const std::string& bytes, int receive_buffer_bytes = 0,
                 const std::string& from = "");
  ~OpenConnection();
  OpenConnection(OpenConnection&&) noexcept;
  OpenConnection& operator=(OpenConnection&&) noexcept;

  void Send(const std::string& bytes);
  void FinishSending();
  /// What comes until it is `enough` bytes or the server closes the connection.
  std::string Read(std::size_t enough);
  /// What comes until the server closes the connection.
  std::string ReadToEnd();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class WsClient {
 public:
  /// `from`: the address of this client, of 127.0.0.0/8.
  /// @throws std::runtime_error with the HTTP status when the server refuses.
  explicit WsClient(int port, const std::string& target = "/api/v1/ws", const Headers& headers = {},
                    int receive_buffer_bytes = 0, const std::string& from = "");
  ~WsClient();

  struct Message {
    bool is_text = false;
    std::vector<std::uint8_t> bytes;
    nlohmann::json json() const { return nlohmann::json::parse(bytes.begin(), bytes.end()); }
    bool IsState() const { return !is_text && !bytes.empty() && bytes[0] == 1; }
    bool IsPicture() const { return !is_text && !bytes.empty() && bytes[0] == 2; }
    bool IsPast() const { return !is_text && !bytes.empty() && bytes[0] == 3; }
    std::uint64_t state_number() const;  // of a state or a picture
  };

  /// The subprotocol that the server has selected, or "".
  const std::string& protocol() const;
  Message Receive();
  Message ReceiveState();
  Message ReceivePicture();
  Message ReceivePast();
  /// The next text message that has `key`.
  nlohmann::json ReceiveText(const std::string& key);
  /// True once the server has closed the connection; what comes before is dropped. False after
  /// 60 s.
  bool WaitForClose();

  void Send(const std::string& text);
  void SendBinary(const std::string& bytes);
  void SendPing();
  void SendPong();
  /// Frames as they are, not encoded.
  void SendRaw(const std::string& bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinescope::http::testing
