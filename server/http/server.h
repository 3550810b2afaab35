/// The web page and its live data: HTTP and WebSocket on one port (docs/http.md). One thread of its
/// own; every public function may be called from any thread. Per client only the newest state and
/// picture are kept, so a slow viewer costs nobody else anything. Nothing that a client sends can
/// stop the server: it is answered, counted under "http" in /api/diagnostics, or both.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/force_inputs.h"
#include "core/latest.h"
#include "core/scene_state.h"

namespace kinescope::http {

/// The server's own picture, encoded once for all viewers.
struct Picture {
  std::vector<std::uint8_t> jpeg;
  std::uint64_t state_number = 0;  // SceneState::number it shows
  std::int64_t arrival_nanos = 0;  // of that state's sample, monotonic clock
};

/// A view by name, of a person who stands at the world's origin. World frame, metres. The page aims
/// its own 3-D view with these numbers, so that a name means one view everywhere.
struct CameraView {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double vertical_fov_rad = 0.52;
};

/// Draws for the server. Implemented in server/app; any thread may call it. SetViewers and
/// SetCamera are called on the server's own thread (SetViewers(0) once more by the destructor) and
/// must return at once; SnapshotPng on a thread of its own.
class PictureFeed {
 public:
  virtual ~PictureFeed() = default;
  /// How many clients look at the live picture now; nothing is drawn while it is 0.
  virtual void SetViewers(int count) = 0;
  /// Which named camera the live picture uses. False for a name that does not exist.
  [[nodiscard]] virtual bool SetCamera(const std::string& camera) = 0;
  /// One picture of the newest state as PNG; blocks until drawn. Empty camera: the live one's.
  /// @throws std::exception with one line for the client.
  virtual std::vector<std::uint8_t> SnapshotPng(const std::string& camera, int width,
                                                int height) = 0;
};

struct HttpConfig {
  std::string bind_ip = "127.0.0.1";
  int port = 8080;                  // 0 takes a free one
  std::string token;                // required as ?token= or cookie when not empty
  std::filesystem::path web_root;   // folder of index.html
  std::vector<CameraView> cameras;  // in the order shown to people
  std::string camera;               // the live picture's at the start; one of `cameras`
  /// What `character` holds from now on: "" or why that cannot be. Called on the server's thread,
  /// must return at once. Null: nothing can be set here.
  std::function<std::string(int character, const HandLoad& load)> set_hand_load;
};

/// Clients at once; the next one is told to come back later.
inline constexpr int kMaxClients = 64;

class HttpServer {
 public:
  /// Listens when it returns. `states` and `pictures` are watched for new values; `diagnostics`
  /// gives the JSON object of /api/diagnostics, to which the server adds its own "http"; it is
  /// called on the server's thread. All are borrowed and must outlive the server. `feed` may be
  /// null (no renderer): the page then says so.
  /// @throws UsageError naming address and port that could not be bound, and what to do; also for
  /// an address beyond this machine without a token, and for a token that does not fit into a
  /// cookie.
  HttpServer(const HttpConfig& config, Latest<SceneState>& states, Latest<Picture>& pictures,
             PictureFeed* feed, std::function<std::string()> diagnostics);
  /// Interrupts `states` and `pictures`, which ends every other wait on them too.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;         // the one really bound
  std::string url() const;  // with the token, ready to open
  int clients() const;      // WebSockets connected now

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinescope::http
