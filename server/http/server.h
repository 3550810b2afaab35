/// Serves the web page and its live data: HTTP and WebSocket on one port (docs/http.md). It has its
/// own thread; every public function may be called from any thread. Per client only the newest
/// state and picture are kept, so a slow viewer does not affect others. No input from a client can
/// stop the server: it is answered, counted under "http" in /api/v1/diagnostics, or both.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/force_inputs.h"
#include "core/playback.h"
#include "core/scene_state.h"
#include "core/system/ip_networks.h"
#include "core/system/latest.h"
#include "server/alarms/alarms.h"
#include "server/history/history.h"
#include "server/http/controls.h"
#include "server/http/role.h"
#include "server/http/snapshot_request.h"
#include "server/http/tls_files.h"
#include "server/marks/mark_book.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::http {

/// The live picture, encoded once for all viewers.
struct Picture {
  std::vector<std::uint8_t> jpeg;
  std::uint64_t state_number = 0;  // SceneState::number of the state that it shows
  std::int64_t arrival_nanos = 0;  // receive time of that state's sample, monotonic clock
};

/// What is beside the people, external markers and robots, made once for all viewers.
struct Surroundings {
  std::uint64_t revision = 0;  // SceneState::surroundings of what it shows
  std::string glb;             // render/surroundings.h
};
using GetFormerSurroundings = std::function<std::shared_ptr<const Surroundings>(
    const std::shared_ptr<const SceneState>& former)>;

/// A picture of a camera as JPEG; null: it cannot be read. @param number  of the image in
/// SceneState::images
using GetCameraFile = std::function<std::shared_ptr<const std::string>(
    std::size_t number, const std::shared_ptr<const CameraImage>& image)>;

/// The name of the camera that the server was started with, where that is none of the named ones.
inline constexpr char kOwnCamera[] = "own";

/// A named camera for a person who stands at the world's origin. World frame, metres. The page uses
/// these numbers for its 3-D view, so that a name means the same view everywhere.
struct CameraView {
  /// kOwnCamera: it stands in the world, wherever people are, or goes with SceneState::camera_base.
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double vertical_fov_rad = 0.52;
  /// How kOwnCamera is turned with the base: "none", "heading" (about the vertical) or "pose".
  std::string turn = "none";
};

/// A point whose recent path the page draws.
struct PageTrail {
  int segment = -1;  // urdf::Segment; -1: the centre of mass
  Rgb color = {0, 0, 0};
  std::string name;
};

/// How the page draws people, until its viewer chooses.
struct PageLook {
  bool draws_skins = true;        // of people with the built-in surface; else parts
  std::string loads = "spheres";  // where load classes are shown: or "skin", "both"
  std::string style = "matte";    // or "clay", "line"
  double body_opacity = 1;        // 0..1
  std::vector<PageTrail> trails = {};
  double trail_secs = 2;
};

/// Numbers by which every camera frames several people and narrow pictures.
struct CameraFraming {
  double min_width_m = 0;       // visible around the target in any picture
  double margin_m = 0;          // beside the outermost person of a group
  double narrowest_aspect = 1;  // width / height of a picture that a group must fit into
  double reach_m = 0;           // of a group, from the person nearest to the origin
  double height_m = 0;          // that `cameras` show
};

/// Renders for the server. Implemented in server/app; any thread may call it. SetViewers,
/// SetCamera and SetDark are called on the server's thread (SetViewers(0) also by the destructor)
/// and must return at once; SnapshotPng is called on a separate thread.
class PictureFeed {
 public:
  virtual ~PictureFeed() = default;
  /// Number of clients that watch the live picture; it is not rendered while this is 0.
  virtual void SetViewers(int count) = 0;
  /// Selects the named camera of the live picture. False for an unknown name.
  [[nodiscard]] virtual bool SetCamera(const std::string& camera) = 0;
  /// The theme of the live picture: dark while all of its viewers want it so.
  virtual void SetDark(bool is_dark) = 0;
  /// Renders one picture as PNG; blocks until it is done.
  /// @throws std::exception with one line for the client.
  virtual std::vector<std::uint8_t> SnapshotPng(const SnapshotRequest& request) = 0;
};

/// How long the server waits for a client.
struct PatienceLimits {
  std::chrono::milliseconds header{
      5000};  // from its first byte, of a new connection from the start
  std::chrono::milliseconds body{10000};
  std::chrono::milliseconds next_request{20000};
  /// In this time, a client must read 80 kB of a response, or all that is left.
  std::chrono::milliseconds write_window{10000};
  std::chrono::milliseconds response{300'000};  // for reading a whole response
};

struct HttpConfig {
  std::string bind_ip = "127.0.0.1";
  int port = 8080;                          // 0: any free port
  std::string port_origin = "--http_port";  // where it was set, for messages about it
  /// Required as ?token=, Authorization: Bearer or cookie, unless empty. Its owner is an operator.
  std::string token;
  std::string token_origin = "--token";  // where it was set, for messages about it
  /// Its owner may look and not change anything. Empty: none; without `token` it must be.
  std::string viewer_token;
  std::string viewer_token_origin = "--viewer_token";
  TlsFiles tls;
  IpNetworks trusted_proxies;  // whose X-Forwarded-For and X-Forwarded-Proto are believed
  /// The path under which a proxy offers the page, "/lab3"; requests come with it or without.
  std::string base_path;
  std::filesystem::path web_root;                      // folder with index.html
  std::filesystem::path web_bundle;                    // see StaticFiles; may be empty
  std::vector<CameraView> cameras;                     // in display order
  CameraFraming framing;                               // of `cameras`
  PageLook look;                                       // of people, on the page
  std::shared_ptr<const skin::SkinTemplate> own_skin;  // instead of the built-in one; or null
  std::string camera;  // of the live picture at the start; one of `cameras`
  /// Sets the hand load of `character`: returns "" or why it is rejected. Called on the server's
  /// thread, must return at once. Null: hand loads cannot be set over HTTP.
  std::function<std::string(int character, const HandLoad& load)> set_hand_load;
  /// Where viewers look back; borrowed. Null: they cannot.
  const history::History* history = nullptr;
  /// Of the recording that is played; null: the stream is live. Called on the server's thread. May
  /// be null.
  std::function<std::shared_ptr<const Playback>()> playback;
  /// The newest that is made; null: none yet. Called on the server's thread. May be null.
  std::function<std::shared_ptr<const Surroundings>()> surroundings;
  /// Of a former state; null: they are being made. Without content: they cannot be made. Called on
  /// the server's thread, must return at once. May be null.
  GetFormerSurroundings former_surroundings;
  /// Called on the server's thread, must return at once. May be null.
  GetCameraFile camera_image;
  /// Where operators mark moments, which needs `history`; borrowed. Null: they cannot.
  marks::MarkBook* marks = nullptr;
  /// What operators do; borrowed. Null: the page has no controls.
  Controls* controls = nullptr;
  /// What people are warned of; borrowed. Null: nothing.
  alarms::Alarms* alarms = nullptr;
  /// The health of the stream as a JSON object, for the message "stream"; "": not known yet. Called
  /// on the server's thread while clients are connected, must return at once. May be null.
  std::function<std::string()> stream;
  PatienceLimits patience;
  /// Receives lines for the log, on the server's thread. May be null.
  std::function<void(const std::string& line)> warn;
};

/// @throws UsageError for an address, port, token or certificate that cannot be used; listens
/// nowhere.
void CheckConfig(const HttpConfig& config);

/// A port that is open already: connections wait in it until an HttpServer serves them. So a port
/// that is in use is found before anything slow starts. Any thread, one at a time.
class Listener {
 public:
  /// @throws UsageError as CheckConfig does, or with the address and port that could not be bound
  /// and the remedy.
  explicit Listener(const HttpConfig& config);
  /// At all addresses and a free port, for a server without a token. @throws UsageError.
  static Listener OpenToAll();
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// The socket, which then belongs to the caller.
  int Release();

 private:
  Listener(const std::string& ip, int port, const std::string& port_origin);

  int descriptor_ = -1;
};

/// Maximum number of clients; further ones are asked to try again later.
inline constexpr int kMaxClients = 128;

class HttpServer {
 public:
  /// Listens when the constructor returns. It publishes new values of `states` and `pictures`.
  /// `diagnostics` returns the JSON object of /api/v1/diagnostics, to which the server adds the
  /// member "http"; it is called on the server's thread. All references are borrowed and must
  /// outlive the server. `feed` may be null (no renderer): the page then reports this. `listener`:
  /// of the same config; it has served its purpose then.
  HttpServer(const HttpConfig& config, Listener& listener, Latest<SceneState>& states,
             Latest<Picture>& pictures, PictureFeed* feed,
             std::function<std::string()> diagnostics);
  /// With a listener of its own. @throws UsageError as Listener does.
  HttpServer(const HttpConfig& config, Latest<SceneState>& states, Latest<Picture>& pictures,
             PictureFeed* feed, std::function<std::string()> diagnostics);
  /// Interrupts `states` and `pictures`, which also ends all other waits on them.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;  // the actual port
  /// With the token of `role`, ready to open.
  std::string url(Role role = Role::kOperator) const;
  /// The same with a part of the token.
  std::string url_for_log(Role role = Role::kOperator) const;
  int clients() const;  // open WebSockets

  /// Calls `work` on the server's thread, unless the server ends before. Any thread.
  void Post(std::function<void()> work);

  /// The camera of the live picture, by name. On the server's thread. @return why not; "": done
  [[nodiscard]] std::string SelectCamera(const std::string& camera, std::string_view role);
  const std::string& camera() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinescope::http
