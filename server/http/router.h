/// Answers the requests of each route, without sockets. docs/http.md lists the routes. Called on
/// the server's thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/history/history.h"
#include "server/http/access.h"
#include "server/http/answer.h"
#include "server/http/controls.h"
#include "server/http/guess_guard.h"
#include "server/http/role.h"
#include "server/http/server.h"
#include "server/http/skin_buffer.h"
#include "server/http/static_files.h"
#include "server/http/target.h"

namespace kinescope::http {

class Router {
 public:
  struct Site {
    PageTokens tokens;
    std::string cookie_name;
    std::vector<CameraView> cameras;
    CameraFraming framing;
    bool has_pictures = false;
    PageLook look;
    std::shared_ptr<const skin::SkinTemplate> own_skin;  // null: the built-in one
    const StaticFiles* files = nullptr;
    const Latest<SceneState>* states = nullptr;
    const history::History* history = nullptr;  // may be null: none is kept
    std::function<std::shared_ptr<const http::Surroundings>()> surroundings;  // may be null
    GetFormerSurroundings former_surroundings;                                // may be null
    GetCameraFile camera_image;                                               // may be null
    marks::MarkBook* marks = nullptr;  // may be null: nothing can be marked
    Controls* controls = nullptr;      // may be null
    alarms::Alarms* alarms = nullptr;  // may be null: nothing is watched
    std::function<std::string(int character, const HandLoad&)> set_hand_load;  // may be null
    std::function<std::string()> diagnostics;  // the complete JSON, with the part of the server
    std::function<std::string()> live_camera;
    std::function<void(const std::string& reason)> count_refusal;
    bool is_tls = false;              // the cookie is for TLS only then
    std::string base_path;            // "" or "/lab3"; requests come without it
    GuessGuard* guesses = nullptr;    // may be null: wrong tokens are not slowed down
    std::int64_t started_micros = 0;  // of the server, wall clock
  };
  explicit Router(Site site) : site_(std::move(site)) {}

  /// Returns an answer for every request and counts the rejected ones. Without the body of a
  /// request, all else is judged first: the answer is final unless it is Answer::needs_body.
  [[nodiscard]] Answer Route(const Request& request) const;

  /// Whether the request may open a WebSocket: nullopt, or the answer that rejects it. `role`, if
  /// not null, receives the role of an accepted client.
  [[nodiscard]] std::optional<Answer> RefuseWebSocket(const Request& request,
                                                      Role* role = nullptr) const;

  /// A route under /api.
  struct RouteInfo {
    std::string path;    // "{...}" stands for any segment
    std::string method;  // "GET" (HEAD, too) or "POST"
    Role least;          // that may use it
  };
  /// All of them, for messages and tests.
  static std::vector<RouteInfo> ApiRoutes();

  static constexpr const char* kWebSocketPath = "/api/v1/ws";

 private:
  Answer RouteAdmitted(const Target& target, const Request& request) const;
  [[nodiscard]] Answer Refuse(int status, const char* kind, const std::string& reason) const;
  [[nodiscard]] std::optional<Answer> RefuseStranger(const Request& request, const Target& target,
                                                     Admission* admission) const;
  /// As Refuse, but browsers receive a page with a field for the token.
  [[nodiscard]] Answer AskForToken(int status, const char* kind, const std::string& reason,
                                   const Request& request, const Target& target) const;
  [[nodiscard]] int CountGuesses(const Request& request, const GivenTokens& given) const;
  [[nodiscard]] std::optional<Answer> RefuseOtherSite(const Request& request,
                                                      const Target& target) const;
  [[nodiscard]] std::optional<Answer> RefuseBareCookie(const Request& request, const Target& target,
                                                       Access access) const;
  [[nodiscard]] std::optional<Answer> RefuseOldAddress(const std::string& path) const;
  [[nodiscard]] std::optional<Answer> RefuseForeignOrigin(const Request& request,
                                                          const char* what) const;
  enum class Method { kGet, kPost };  // GET: HEAD, too
  struct ApiRoute {
    const char* path;  // "{...}" stands for any segment
    Method method;
    Role least;  // a route that changes anything: kOperator
    Answer (Router::*answer)(const Request&, Role) const;
  };
  static const std::array<ApiRoute, 26> kApiRoutes;
  /// Null if there is no such route.
  static const ApiRoute* FindApi(const std::string& path);
  static std::string ApiPaths();

  Answer Session(const Request& request, Role role) const;
  Answer State(const Request& request, Role role) const;
  Answer Model(const Request& request, Role role) const;
  Answer Diagnostics(const Request& request, Role role) const;
  Answer Cameras(const Request& request, Role role) const;
  Answer Series(const Request& request, Role role) const;
  Answer SetHandLoad(const Request& request, Role role) const;
  /// Nullopt: the request is one of the page of this server, or of no page, and has JSON.
  [[nodiscard]] std::optional<Answer> RefuseUnlessJson(const Request& request,
                                                       const char* what) const;
  // router_marks.cc
  Answer Marks(const Request& request, Role role) const;
  Answer SetMark(const Request& request, Role role) const;
  [[nodiscard]] Answer RefuseMoment(std::uint64_t wanted, const SceneState* nearest) const;
  /// The kept state of the number that `value` is.
  [[nodiscard]] tl::expected<std::shared_ptr<const SceneState>, Answer> FormerState(
      const std::string& value) const;
  [[nodiscard]] Answer FormerSurroundings(const std::string& state, const Request& request) const;
  // router_controls.cc
  template <class Parse, class CarryOut>
  Answer Order(const Request& request, const char* what, Parse parse, CarryOut carry_out) const;
  Answer ControlStatus(const Request& request, Role role) const;
  Answer Files(const Request& request, Role role) const;
  Answer Record(const Request& request, Role role) const;
  Answer Clip(const Request& request, Role role) const;
  Answer SetPerson(const Request& request, Role role) const;
  Answer SetClassLimits(const Request& request, Role role) const;
  Answer RunTrial(const Request& request, Role role) const;
  Answer Download(const Request& request, Role role) const;
  // router_alarms.cc
  Answer Alarms(const Request& request, Role role) const;
  Answer Acknowledge(const Request& request, Role role) const;
  // router.cc
  Answer Mesh(const Request& request, Role role) const;
  Answer Skin(const Request& request, Role role) const;
  Answer Surroundings(const Request& request, Role role) const;
  Answer CameraPicture(const Request& request, Role role) const;
  Answer Snapshot(const Request& request, Role role) const;
  Answer OpenApi(const Request& request, Role role) const;
  Answer AskForUpgrade(const Request& request, Role role) const;
  Answer File(const std::string& path, const Request& request) const;

  Site site_;
  mutable SkinBuffers skins_;
};

}  // namespace kinescope::http
