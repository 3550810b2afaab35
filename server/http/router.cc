#include "server/http/router.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/picture_limits.h"
#include "core/system/clocks.h"
#include "core/system/json_text.h"
#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "server/http/api.h"
#include "server/http/hand_load_order.h"
#include "server/http/open_api.h"
#include "server/http/protocol.h"
#include "server/http/series_json.h"
#include "server/http/token_page.h"

namespace kinescope::http {
namespace {

constexpr int kMaxPixels = 4096;
constexpr std::uintmax_t kMaxMeshBytes = 64u << 20;
constexpr char kSnapshotPath[] = "/api/v1/snapshot.png";
constexpr char kFilePath[] = "/api/v1/file/{name}";
constexpr char kImagePath[] = "/api/v1/image/{number}";
constexpr char kMeshPath[] = "/api/v1/mesh/{person}/{revision}/{number}";
constexpr char kSkinPath[] = "/api/v1/skin/{person}/{revision}";
constexpr int kMostSkinError = 10;  // mm: with more, people lose their hands

bool IsCostly(const Target& target) { return StartsWith(target.path, "/api/v1/"); }

// Addresses of before version 1, which bookmarks and scripts may still have.
std::string NewAddress(const std::string& path) {
  if (path == "/snapshot.png") return kSnapshotPath;
  if (path == "/ws") return Router::kWebSocketPath;
  if (StartsWith(path, "/api/") && !StartsWith(path, "/api/v1/")) return "/api/v1" + path.substr(4);
  return "";
}

std::string EntityTagOf(const std::string& content) {
  return '"' + std::to_string(content.size()) + '-' +
         std::to_string(std::hash<std::string>()(content)) + '"';
}

template <class Number>
std::optional<Number> ParseNumber(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Removes the first segment from `path`, with its slash, and returns it.
std::string_view TakeSegment(std::string_view& path) {
  const std::string_view segment = path.substr(0, path.find('/'));
  path.remove_prefix(std::min(path.size(), segment.size() + 1));
  return segment;
}

// `path` begins with the fixed segments of `route`, and has as many as it.
bool Matches(std::string_view path, std::string_view route) {
  if (std::count(path.begin(), path.end(), '/') != std::count(route.begin(), route.end(), '/')) {
    return false;
  }
  while (!route.empty() || !path.empty()) {
    const std::string_view wanted = TakeSegment(route), given = TakeSegment(path);
    const bool is_any = !wanted.empty() && wanted.front() == '{';
    if (is_any ? given.empty() : given != wanted) return false;
  }
  return true;
}

// The numbers in the place of the "{...}" of `route`, which `path` matches; nullopt unless there
// are exactly `kCount`.
template <std::size_t kCount>
std::optional<std::array<std::uint64_t, kCount>> NumbersOf(std::string_view path,
                                                           std::string_view route) {
  std::array<std::uint64_t, kCount> numbers{};
  std::string_view rest = path.substr(route.find('{'));
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t slash = rest.find('/');
    const bool is_last = i + 1 == kCount;
    const auto number = ParseNumber<std::uint64_t>(rest.substr(0, slash));
    if (!number || is_last != (slash == std::string_view::npos)) return std::nullopt;
    numbers[i] = *number;
    if (!is_last) rest.remove_prefix(slash + 1);
  }
  return numbers;
}

int ToCharacter(std::uint64_t number) {
  return static_cast<int>(std::min<std::uint64_t>(number, INT32_MAX));
}

// Another process of this server has other bodies at the same addresses, so browsers ask again.
Answer AnswerOfModel(const std::string& content, const char* type, const Request& request) {
  Answer answer;
  answer.content_type = type;
  const std::string tag = EntityTagOf(content);
  answer.headers.emplace_back("Cache-Control", "no-cache");
  answer.headers.emplace_back("ETag", tag);
  if (request.if_none_match == tag) {
    answer.status = 304;
  } else {
    answer.body = content;
  }
  return answer;
}

// `address`: relative, since a proxy may have put a folder before ours.
Answer AnswerOfLaterModel(std::string address, const Request& request) {
  Answer answer = ErrorAnswer(307, "this model has been replaced by a later one");
  const std::size_t query = std::min(request.target.find('?'), request.target.size());
  answer.headers.emplace_back("Location", std::move(address) + request.target.substr(query));
  return answer;
}

}  // namespace

Answer JsonAnswer(std::string body) {
  Answer answer;
  answer.body = std::move(body);
  answer.headers.emplace_back("Cache-Control", "no-store");
  return answer;
}

Answer AskForBody() {
  Answer answer;
  answer.needs_body = true;
  return answer;
}

Answer ErrorAnswer(int status, const std::string& reason) {
  Answer answer = JsonAnswer(JsonText(nlohmann::json{{"error", reason}}));
  answer.status = status;
  return answer;
}

Answer Router::Refuse(int status, const char* kind, const std::string& reason) const {
  site_.count_refusal(kind);
  return ErrorAnswer(status, reason);
}

std::optional<Answer> Router::RefuseStranger(const Request& request, const Target& target,
                                             Admission* admission) const {
  *admission = {Access::kOpen, Role::kOperator};
  if (site_.tokens.of_operator.empty()) {
    if (NamesThisMachine(request.host)) return std::nullopt;
    return Refuse(403, "unknown host",
                  "no token is set, so only requests to localhost or 127.0.0.1 are accepted");
  }
  const GivenTokens given =
      FindTokens(target, request.authorization, request.cookies, site_.cookie_name);
  *admission = CheckToken(site_.tokens, given);
  if (admission->access != Access::kDenied) return std::nullopt;
  // What another site makes a browser send does not use up the share of its user.
  const bool is_guess = given.any() && !IsFromAnotherSite(request.sec_fetch_site) &&
                        IsSameOrigin(request.origin, request.host);
  if (is_guess && site_.guesses != nullptr) {
    const int secs = CountGuesses(request, given);
    if (secs > 0) {
      Answer answer = AskForToken(
          429, "too many wrong tokens",
          "wrong token, and too many of them from " + request.address +
              "; open the URL of the running server, with its token, or try another one in " +
              std::to_string(secs) + " s",
          request, target);
      answer.headers.emplace_back("Retry-After", std::to_string(secs));
      return answer;
    }
  }
  Answer answer = AskForToken(
      401, "no token",
      given.any() ? "wrong token; open the URL of the running server, with its token"
                  : "token missing; open the URL of the server, which ends with ?token=...",
      request, target);
  answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  return answer;
}

Answer Router::AskForToken(int status, const char* kind, const std::string& reason,
                           const Request& request, const Target& target) const {
  Answer answer = Refuse(status, kind, reason);
  if (request.accept.find("text/html") == std::string::npos) return answer;
  return TokenPage(status, reason, target);
}

// Each token of the request is a guess. Returns as GuessGuard::OnWrong.
int Router::CountGuesses(const Request& request, const GivenTokens& given) const {
  std::vector<std::string> guesses = given.cookies;
  for (const auto& token : {given.query, given.header}) {
    if (token) guesses.push_back(*token);
  }
  int secs = 0;
  for (const std::string& guess : guesses) {
    secs = std::max(secs, site_.guesses->OnWrong(request.address, guess, request.received_at));
  }
  return secs;
}

Answer Router::Series(const Request& request, Role /*role*/) const {
  if (site_.history == nullptr) return Refuse(503, "no history", kNoHistory);
  const auto target = ParseTarget(request.target);
  if (!target) return Refuse(400, "bad address", target.error());
  const auto question = ParseSeriesQuestion(target->query);
  if (!question) return Refuse(400, "bad series", question.error());
  const history::Series& series = site_.history->series();
  const auto answer = series.Ask(*question);
  if (answer) return JsonAnswer(SeriesJson(*question, *answer));
  std::string known;
  for (const int character : series.characters()) {
    known += (known.empty() ? "" : ", ") + std::to_string(character);
  }
  return Refuse(404, "no person",
                "person=" + std::to_string(question->character) + ": no samples are kept; " +
                    (known.empty() ? "no person has been in the stream yet" : "expected " + known));
}

// A foreign page can make a browser request pictures and data. It can neither read them nor add a
// header or the token, but rendering and sending them costs time.
std::optional<Answer> Router::RefuseOtherSite(const Request& request, const Target& target) const {
  if (!IsCostly(target) || !IsFromAnotherSite(request.sec_fetch_site)) return std::nullopt;
  return Refuse(403, "another site",
                "Sec-Fetch-Site: " + request.sec_fetch_site +
                    ": only the page of this server may request this; open the address directly");
}

// The same without Sec-Fetch-Site, which browsers do not send to plain http:// addresses of other
// machines. A picture in a page does not accept text/html; a link does.
std::optional<Answer> Router::RefuseBareCookie(const Request& request, const Target& target,
                                               Access access) const {
  const bool is_certain = !request.sec_fetch_site.empty() || !request.page_header.empty() ||
                          request.accept.find("text/html") != std::string::npos;
  if (target.path != kSnapshotPath || access != Access::kByCookie || is_certain) {
    return std::nullopt;
  }
  return Refuse(403, "another site",
                "the cookie alone does not show that the page of this server requests this; add "
                "?token=..., or one of the headers Authorization: Bearer and X-Kinescope-Page: 1");
}

std::optional<Answer> Router::RefuseForeignOrigin(const Request& request, const char* what) const {
  if (IsSameOrigin(request.origin, request.host)) return std::nullopt;
  return Refuse(403, "foreign origin",
                "Origin: " + request.origin + " differs from Host: " + request.host +
                    "; only the page of this server may " + what +
                    ". Behind a proxy, let it pass on the Host header");
}

// A new route: a line here, one in docs/http.md, and its description in docs/openapi.json.
const std::array<Router::ApiRoute, 26> Router::kApiRoutes = {{
    {"/api/v1/session", Method::kGet, Role::kViewer, &Router::Session},
    {"/api/v1/state", Method::kGet, Role::kViewer, &Router::State},
    {"/api/v1/model", Method::kGet, Role::kViewer, &Router::Model},
    {"/api/v1/cameras", Method::kGet, Role::kViewer, &Router::Cameras},
    {"/api/v1/diagnostics", Method::kGet, Role::kViewer, &Router::Diagnostics},
    {"/api/v1/series", Method::kGet, Role::kViewer, &Router::Series},
    {"/api/v1/hand_load", Method::kPost, Role::kOperator, &Router::SetHandLoad},
    {"/api/v1/marks", Method::kGet, Role::kViewer, &Router::Marks},
    {"/api/v1/mark", Method::kPost, Role::kOperator, &Router::SetMark},
    {"/api/v1/alarms", Method::kGet, Role::kViewer, &Router::Alarms},
    {"/api/v1/acknowledge", Method::kPost, Role::kOperator, &Router::Acknowledge},
    {"/api/v1/controls", Method::kGet, Role::kViewer, &Router::ControlStatus},
    {"/api/v1/files", Method::kGet, Role::kViewer, &Router::Files},
    {"/api/v1/recording", Method::kPost, Role::kOperator, &Router::Record},
    {"/api/v1/clip", Method::kPost, Role::kOperator, &Router::Clip},
    {"/api/v1/person", Method::kPost, Role::kOperator, &Router::SetPerson},
    {"/api/v1/class_limits", Method::kPost, Role::kOperator, &Router::SetClassLimits},
    {"/api/v1/trial", Method::kPost, Role::kOperator, &Router::RunTrial},
    {kFilePath, Method::kGet, Role::kOperator, &Router::Download},
    {kMeshPath, Method::kGet, Role::kViewer, &Router::Mesh},
    {kSkinPath, Method::kGet, Role::kViewer, &Router::Skin},
    {"/api/v1/surroundings.glb", Method::kGet, Role::kViewer, &Router::Surroundings},
    {kImagePath, Method::kGet, Role::kViewer, &Router::CameraPicture},
    {kSnapshotPath, Method::kGet, Role::kViewer, &Router::Snapshot},
    {kWebSocketPath, Method::kGet, Role::kViewer, &Router::AskForUpgrade},
    {"/api/v1/openapi.json", Method::kGet, Role::kViewer, &Router::OpenApi},
}};

std::vector<Router::RouteInfo> Router::ApiRoutes() {
  std::vector<RouteInfo> routes;
  routes.reserve(kApiRoutes.size());
  for (const ApiRoute& route : kApiRoutes) {
    routes.push_back({route.path, route.method == Method::kPost ? "POST" : "GET", route.least});
  }
  return routes;
}

const Router::ApiRoute* Router::FindApi(const std::string& path) {
  const auto* const found =
      std::find_if(kApiRoutes.begin(), kApiRoutes.end(),
                   [&](const ApiRoute& route) { return Matches(path, route.path); });
  return found == kApiRoutes.end() ? nullptr : found;
}

std::string Router::ApiPaths() {
  std::string paths;
  for (const ApiRoute& route : kApiRoutes) {
    paths += (paths.empty() ? "" : ", ") + std::string(route.path) +
             (route.method == Method::kPost ? " (POST)" : "");
  }
  return paths;
}

Answer Router::Route(const Request& request) const {
  const auto target = ParseTarget(request.target);
  if (!target) return Refuse(400, "bad address", target.error());
  if (auto refusal = RefuseOtherSite(request, *target)) return *std::move(refusal);
  Admission admission;
  if (auto refusal = RefuseStranger(request, *target, &admission)) return *std::move(refusal);
  const auto [access, role] = admission;
  if (auto refusal = RefuseBareCookie(request, *target, access)) return *std::move(refusal);
  if (auto refusal = RefuseOldAddress(target->path)) return *std::move(refusal);
  const ApiRoute* const api = FindApi(target->path);
  const bool posts = api != nullptr && api->method == Method::kPost;
  if (posts ? request.method != "POST" : request.method != "GET" && request.method != "HEAD") {
    const std::string allowed = posts ? "POST" : "GET, HEAD";
    Answer answer = Refuse(405, "bad method", "this address accepts only " + allowed);
    answer.headers.emplace_back("Allow", allowed);
    return answer;
  }
  if (api != nullptr && !MayAct(role, api->least)) {
    return Refuse(403, "not an operator",
                  WhyNotPermitted(request.method + " " + target->path, role));
  }
  Answer answer =
      api != nullptr ? (this->*api->answer)(request, role) : RouteAdmitted(*target, request);
  answer.to_token_holder = access != Access::kOpen;
  if (access == Access::kByQuery && !posts) {
    const char* const secure = site_.is_tls || request.is_encrypted ? "; Secure" : "";
    const std::string& token =
        role == Role::kOperator ? site_.tokens.of_operator : site_.tokens.of_viewer;
    answer.headers.emplace_back("Set-Cookie", site_.cookie_name + "=" + token +
                                                  "; Path=" + site_.base_path +
                                                  "/; HttpOnly; SameSite=Strict" + secure);
  }
  return answer;
}

std::optional<Answer> Router::RefuseWebSocket(const Request& request, Role* role) const {
  const auto target = ParseTarget(request.target);
  if (!target) return Refuse(400, "bad address", target.error());
  if (auto refusal = RefuseForeignOrigin(request, "open its WebSocket")) return refusal;
  Admission admission;
  if (auto refusal = RefuseStranger(request, *target, &admission)) return refusal;
  if (role != nullptr) *role = admission.role;
  if (target->path != kWebSocketPath) {
    return Refuse(404, "unknown address", std::string("the WebSocket is at ") + kWebSocketPath);
  }
  if (!CanRead(request.socket_protocols)) {
    return Refuse(400, "other protocol",
                  "Sec-WebSocket-Protocol: " + request.socket_protocols + ": this server sends " +
                      SocketProtocol() + "; reload the page, or use a client of this version");
  }
  return std::nullopt;
}

std::optional<Answer> Router::RefuseOldAddress(const std::string& path) const {
  const std::string address = NewAddress(path);
  if (address.empty()) return std::nullopt;
  return Refuse(404, "old address",
                path + ": the address is now " + address + "; docs/http.md has all");
}

Answer Router::RouteAdmitted(const Target& target, const Request& request) const {
  if (StartsWith(target.path, "/api/v1/")) {
    return Refuse(404, "unknown address", "unknown route; expected one of " + ApiPaths());
  }
  return File(target.path, request);
}

Answer Router::AskForUpgrade(const Request& /*request*/, Role /*role*/) const {
  Answer answer = Refuse(426, "no upgrade", "this route accepts WebSocket connections only");
  answer.headers.emplace_back("Upgrade", "websocket");
  return answer;
}

Answer Router::OpenApi(const Request& /*request*/, Role /*role*/) const {
  return JsonAnswer(kOpenApi);
}

Answer Router::Session(const Request& /*request*/, Role role) const {
  return JsonAnswer(JsonText(nlohmann::json{{"role", Name(role)},
                                            {"socket", SocketProtocol()},
                                            {"started_micros", site_.started_micros}}));
}

Answer Router::State(const Request& /*request*/, Role /*role*/) const {
  return JsonAnswer(StateJson(site_.states->Get().get(), MonotonicNanos()));
}

Answer Router::Model(const Request& /*request*/, Role /*role*/) const {
  return JsonAnswer(ModelJson(site_.states->Get().get(), site_.look));
}

Answer Router::Diagnostics(const Request& /*request*/, Role /*role*/) const {
  return JsonAnswer(site_.diagnostics());
}

Answer Router::Cameras(const Request& /*request*/, Role /*role*/) const {
  return JsonAnswer(
      CamerasJson(site_.cameras, site_.framing, site_.live_camera(), site_.has_pictures));
}

// A foreign page can make a browser send anything that a form could send. JSON is not possible: for
// it the browser asks first, and is rejected.
std::optional<Answer> Router::RefuseUnlessJson(const Request& request, const char* what) const {
  if (auto refusal = RefuseForeignOrigin(request, what)) return refusal;
  const std::string type = request.content_type.substr(0, request.content_type.find(';'));
  if (type == "application/json") return std::nullopt;
  return Refuse(415, "bad content type", "expected Content-Type: application/json");
}

Answer Router::SetHandLoad(const Request& request, Role role) const {
  if (auto refusal = RefuseUnlessJson(request, "set hand loads")) return *std::move(refusal);
  if (!site_.set_hand_load)
    return Refuse(503, "no hand loads", "this server does not accept hand loads");
  if (!request.body) return AskForBody();
  const auto order = ParseHandLoadOrder(*request.body);
  if (!order) return Refuse(400, "bad hand load", order.error());
  const std::shared_ptr<const SceneState> state = site_.states->Get();
  static const std::vector<PersonState> kNobody;
  const std::vector<PersonState>& people = state ? state->people : kNobody;
  if (people.empty()) return Refuse(409, "no person", "no person in the stream yet");
  if (!order->person && people.size() > 1) {
    return Refuse(400, "bad hand load", "several persons in the stream; set \"person\"");
  }
  const int character = order->person.value_or(people.front().character);
  const bool is_here = std::any_of(people.begin(), people.end(), [&](const PersonState& person) {
    return person.character == character;
  });
  if (!is_here) {
    return Refuse(404, "no person", "unknown person " + std::to_string(character));
  }
  const std::string wrong = site_.set_hand_load(character, order->load);
  if (!wrong.empty()) return Refuse(400, "bad hand load", wrong);
  if (site_.controls != nullptr) site_.controls->OnHandLoad(character, order->load, role);
  return JsonAnswer(JsonText(nlohmann::json{{"person", character},
                                            {"right_kg", order->load.mass_kg[urdf::kRight]},
                                            {"left_kg", order->load.mass_kg[urdf::kLeft]},
                                            {"both_kg", order->load.both_kg}}));
}

Answer Router::Mesh(const Request& request, Role /*role*/) const {
  const auto numbers = NumbersOf<3>(ParseTarget(request.target)->path, kMeshPath);
  if (!numbers) return Refuse(404, "unknown address", std::string("expected ") + kMeshPath);
  const auto [person, revision, n] = *numbers;
  const std::shared_ptr<const SceneState> state = site_.states->Get();
  if (const auto later = LaterRevision(state.get(), ToCharacter(person), revision)) {
    return AnswerOfLaterModel("../" + std::to_string(*later) + "/" + std::to_string(n), request);
  }
  const auto mesh = FindMesh(state.get(), ToCharacter(person), revision, n);
  if (!mesh || mesh->size() > kMaxMeshBytes) {
    return Refuse(404, "no such mesh", "the newest model does not contain this STL file");
  }
  return AnswerOfModel(*mesh, "model/stl", request);
}

Answer Router::Skin(const Request& request, Role /*role*/) const {
  const auto target = ParseTarget(request.target);
  const auto numbers = NumbersOf<2>(target->path, kSkinPath);
  if (!numbers) return Refuse(404, "unknown address", std::string("expected ") + kSkinPath);
  const auto [person, revision] = *numbers;
  int error_mm = 0;
  if (const auto given = target->query.find("error_mm"); given != target->query.end()) {
    const auto number = ParseNumber<int>(given->second);
    if (!number || *number < 0 || *number > kMostSkinError) {
      return Refuse(400, "bad skin",
                    "error_mm=" + given->second + ": expected a whole number from 0 to " +
                        std::to_string(kMostSkinError));
    }
    error_mm = *number;
  }
  const std::shared_ptr<const SceneState> state = site_.states->Get();
  if (const auto later = LaterRevision(state.get(), ToCharacter(person), revision)) {
    return AnswerOfLaterModel(std::to_string(*later), request);
  }
  const auto model = FindModelWithSkin(state.get(), ToCharacter(person), revision);
  if (!model) {
    return Refuse(404, "no such skin", "this is not the newest model, or it is made of parts");
  }
  return AnswerOfModel(*skins_.Of(model, site_.own_skin.get(), error_mm),
                       "application/octet-stream", request);
}

tl::expected<std::shared_ptr<const SceneState>, Answer> Router::FormerState(
    const std::string& value) const {
  const auto wanted = ParseNumber<std::uint64_t>(value);
  if (!wanted) {
    return tl::unexpected(
        Refuse(400, "bad state", "state=" + value + ": expected a whole number from 0 on"));
  }
  if (site_.history == nullptr) return tl::unexpected(Refuse(503, "no history", kNoHistory));
  auto state = site_.history->Numbered(*wanted);
  if (state == nullptr || state->number != *wanted) {
    return tl::unexpected(RefuseMoment(*wanted, state.get()));
  }
  return state;
}

Answer Router::FormerSurroundings(const std::string& state, const Request& request) const {
  const auto former = FormerState(state);
  if (!former) return former.error();
  if ((*former)->surroundings == 0 || !site_.former_surroundings) {
    return ErrorAnswer(404, "nothing was beside the people: no external markers, and no robots");
  }
  const auto surroundings = site_.former_surroundings(*former);
  if (surroundings == nullptr) {
    Answer wait = JsonAnswer(R"({"wait": "what was beside the people is being made; ask again"})");
    wait.status = 202;
    return wait;
  }
  if (surroundings->glb.empty()) {
    return ErrorAnswer(503, "what was beside the people cannot be made; the server's log says why");
  }
  return AnswerOfModel(surroundings->glb, "model/gltf-binary", request);
}

Answer Router::Surroundings(const Request& request, Role /*role*/) const {
  const auto target = ParseTarget(request.target);
  if (const auto state = target->query.find("state"); state != target->query.end()) {
    return FormerSurroundings(state->second, request);
  }
  const auto surroundings = site_.surroundings ? site_.surroundings() : nullptr;
  if (surroundings == nullptr) {
    return ErrorAnswer(404, "nothing is beside the people: no external markers, and no robots");
  }
  return AnswerOfModel(surroundings->glb, "model/gltf-binary", request);
}

Answer Router::CameraPicture(const Request& request, Role /*role*/) const {
  const auto numbers = NumbersOf<1>(ParseTarget(request.target)->path, kImagePath);
  if (!numbers) return Refuse(404, "unknown address", std::string("expected ") + kImagePath);
  const std::shared_ptr<const SceneState> state = site_.states->Get();
  const std::size_t number = (*numbers)[0];
  if (state == nullptr || number >= state->images.size() || !site_.camera_image) {
    return ErrorAnswer(404, "no camera has sent this picture");
  }
  const auto file = site_.camera_image(number, state->images[number]);
  if (file == nullptr) return ErrorAnswer(404, "the picture of this camera cannot be read");
  return AnswerOfModel(*file, "image/jpeg", request);
}

Answer Router::Snapshot(const Request& request, Role /*role*/) const {
  if (!site_.has_pictures) return Refuse(503, "no renderer", kNoRenderer);
  SnapshotRequest snapshot;
  const auto target = ParseTarget(request.target);
  for (const auto& [name, value] : target->query) {
    if (name == "token" || name == "t") continue;  // t: makes a URL unique for a cache
    if (name == "camera") {
      snapshot.camera = value;
      continue;
    }
    if (name == "state") {
      auto state = FormerState(value);
      if (!state) return std::move(state).error();
      snapshot.state = *std::move(state);
      continue;
    }
    if (name == "theme" && (value == "light" || value == "dark")) {
      snapshot.is_dark = value == "dark";
      continue;
    }
    int* const pixels = name == "width"    ? &snapshot.width
                        : name == "height" ? &snapshot.height
                                           : nullptr;
    const auto number = ParseNumber<int>(value);
    if (pixels == nullptr || !number || *number < kMinPictureSide || *number > kMaxPixels) {
      return Refuse(400, "bad snapshot",
                    name + "=" + value +
                        ": expected camera=<name>, state=<number>, theme=light or dark, width= and "
                        "height= from " +
                        std::to_string(kMinPictureSide) + " to " + std::to_string(kMaxPixels));
    }
    *pixels = *number;
  }
  if (!snapshot.camera.empty()) {
    std::vector<std::string> names;
    for (const CameraView& camera : site_.cameras) names.push_back(camera.name);
    if (std::count(names.begin(), names.end(), snapshot.camera) == 0) {
      return Refuse(
          400, "bad snapshot",
          "camera=" + snapshot.camera + ": unknown camera; expected " + Alternatives(names));
    }
  }
  Answer answer;
  answer.content_type = "image/png";
  answer.headers.emplace_back("Cache-Control", "no-store");
  answer.snapshot = std::move(snapshot);
  return answer;
}

Answer Router::File(const std::string& path, const Request& request) const {
  const StaticFile* const file = site_.files->Find(path);
  const std::string tag = file != nullptr ? EntityTag(file->path) : std::string();
  if (file == nullptr || tag.empty()) {
    const bool is_library = StartsWith(path, "/lib/");
    return Refuse(404, "unknown address",
                  is_library ? "this library is not installed; run sh web/fetch_libraries.sh"
                             : "no page at this address");
  }
  Answer answer;
  answer.content_type = file->content_type;
  // no-cache: store it, but check for changes each time, so that an upgrade is visible at once.
  answer.headers.emplace_back("Cache-Control", "no-cache");
  answer.headers.emplace_back("ETag", tag);
  if (request.if_none_match == tag) {
    answer.status = 304;
  } else {
    answer.file = file->path;
  }
  return answer;
}

}  // namespace kinescope::http
