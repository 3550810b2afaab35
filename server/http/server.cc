#include "server/http/server.h"

#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/alarms/alarm_json.h"
#include "server/http/access.h"
#include "server/http/base_path.h"
#include "server/http/client_address.h"
#include "server/http/http_session.h"
#include "server/http/tls_certificate.h"

namespace kinescope::http {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds kWatch{1};

std::string Authority(const std::string& ip, int port) {
  const bool is_v6 = ip.find(':') != std::string::npos;
  return (is_v6 ? "[" + ip + "]" : ip) + ":" + std::to_string(port);
}

// Data that wait in the kernel cannot be replaced by newer data, so the buffer is small: a slow
// viewer then sees a recent picture and not one from the buffer.
void KeepKernelQueueShort(tcp::socket& socket) {
  constexpr int kUnsentBytes = 16 << 10;
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes,
               sizeof kUnsentBytes);
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
}

void CheckTokenText(const std::string& token, const std::string& origin) {
  if (!FitsIntoCookie(token)) {
    throw UsageError(origin + ": expected only letters, digits and -._~");
  }
  if (!token.empty() && token.size() < kMinTokenLength) {
    throw UsageError(origin + ": a token of " + std::to_string(token.size()) +
                     " characters can be guessed; use " + std::to_string(kMinTokenLength) +
                     " or more, such as these random ones: " + RandomToken());
  }
}

const HttpConfig& Checked(const HttpConfig& config) {
  CheckConfig(config);
  return config;
}

}  // namespace

void CheckConfig(const HttpConfig& config) {
  error_code error;
  const auto address = asio::ip::make_address(config.bind_ip, error);
  if (error) {
    throw UsageError(
        "--bind_ip=" + config.bind_ip +
        ": not an IP address; use 127.0.0.1 for this machine or 0.0.0.0 for the network");
  }
  if (config.port < 0 || config.port > 65535) {
    throw UsageError(config.port_origin + "=" + std::to_string(config.port) +
                     ": expected 0 to 65535");
  }
  if (!address.is_loopback() && config.token.empty()) {
    throw UsageError(
        "--bind_ip=" + config.bind_ip +
        ": an address that other machines can reach needs a token; set --token_file=FILE, which is "
        "made with a random token if it is missing, or use 127.0.0.1");
  }
  if (config.tls.any()) TlsCertificate(config.tls, nullptr);
  (void)CheckedBasePath(config.base_path);
  CheckTokenText(config.token, config.token_origin);
  CheckTokenText(config.viewer_token, config.viewer_token_origin);
  if (config.viewer_token.empty()) return;
  if (config.token.empty()) {
    throw UsageError(config.viewer_token_origin +
                     ": viewers have a token only if the operator has one; set --token_file=FILE, "
                     "too, which is made with a random token if it is missing");
  }
  if (config.viewer_token == config.token) {
    throw UsageError(config.viewer_token_origin + ": the same token as that of " +
                     config.token_origin + ", so viewers would be operators; choose another");
  }
}

Listener::Listener(const HttpConfig& config)
    : Listener(Checked(config).bind_ip, config.port, config.port_origin) {}

Listener Listener::OpenToAll() { return {"0.0.0.0", 0, ""}; }

Listener::Listener(const std::string& ip, int port, const std::string& port_origin) {
  asio::io_context io;
  tcp::acceptor acceptor(io);
  const tcp::endpoint endpoint(asio::ip::make_address(ip), static_cast<unsigned short>(port));
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) descriptor_ = acceptor.release(error);
  if (error == boost::system::errc::address_not_available) {
    throw UsageError("--bind_ip=" + ip +
                     ": this machine does not have this address; use one of its own, 0.0.0.0 for "
                     "all of them or 127.0.0.1 for this machine only");
  }
  if (error) {
    const std::string remedy =
        port_origin.empty() ? "" : "; choose another port with " + port_origin + " (0: a free one)";
    throw UsageError("cannot serve at " + Authority(ip, port) + ": " + error.message() + remedy);
  }
}

Listener::~Listener() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int Listener::Release() { return std::exchange(descriptor_, -1); }

struct HttpServer::Impl {
  Impl(const HttpConfig& config, Listener& listener, Latest<SceneState>& states,
       Latest<Picture>& pictures, PictureFeed* feed,
       std::function<std::string()> program_diagnostics);
  ~Impl();

  void Accept();
  void OnAccepted(error_code error, tcp::socket socket);
  void OnState();
  void ArmTick();
  void RunIo();
  template <class T, class Then>
  std::thread Watch(Latest<T>& values, std::atomic<bool>& announced, Then then);
  Router::Site MakeSite();

  const HttpConfig config_;
  Latest<SceneState>& states_;
  Latest<Picture>& pictures_;
  PictureFeed* const feed_;
  const std::function<std::string()> program_diagnostics_;
  std::atomic<bool> stopping_{false};

  // Server's thread only, once it runs. The members that connections borrow are before io_, so that
  // they outlive the handlers that io_ still holds when it is destroyed.
  Counters counters_;
  StaticFiles files_;
  Hub hub_;
  GuessGuard guesses_;
  PixelBudget pixels_;
  std::optional<SnapshotWorker> snapshots_;
  std::optional<Router> router_;
  std::optional<TlsCertificate> tls_;
  Shared shared_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer tick_{io_};
  asio::steady_timer state_pause_{io_};
  asio::steady_timer accept_pause_{io_};
  bool state_is_due_ = false;  // state_pause_ is running

  // Any thread.
  int port_ = 0;
  std::atomic<bool> state_announced_{false};  // a wake-up is queued in io_
  std::atomic<bool> picture_announced_{false};

  std::thread io_thread_;
  std::thread state_watch_;
  std::thread picture_watch_;
};

HttpServer::Impl::Impl(const HttpConfig& config, Listener& listener, Latest<SceneState>& states,
                       Latest<Picture>& pictures, PictureFeed* feed,
                       std::function<std::string()> program_diagnostics)
    : config_(config),
      states_(states),
      pictures_(pictures),
      feed_(feed),
      program_diagnostics_(std::move(program_diagnostics)),
      files_(config.web_root, config.web_bundle),
      hub_(states, pictures, feed, config.history, config.camera, counters_, config.playback,
           config.marks),
      guesses_(config.warn),
      pixels_(Clock::now()),
      acceptor_(io_, asio::ip::make_address(config.bind_ip).is_v6() ? tcp::v6() : tcp::v4(),
                listener.Release()) {
  port_ = acceptor_.local_endpoint().port();
  if (feed_ != nullptr) snapshots_.emplace(*feed_);
  if (config_.tls.any()) tls_.emplace(config_.tls, config_.warn);
  router_.emplace(MakeSite());
  if (config.controls != nullptr) {
    hub_.SetOnCamera([controls = config.controls](const std::string& before,
                                                  const std::string& after, std::string_view role) {
      controls->OnCamera(before, after, role);
    });
  }
  hub_.SetSurroundings(config.surroundings);
  shared_.router = &*router_;
  shared_.route = [this](const Request& request) { return router_->Route(request); };
  shared_.hub = &hub_;
  shared_.counters = &counters_;
  shared_.pixels = &pixels_;
  shared_.tls = tls_ ? &*tls_ : nullptr;
  shared_.proxies = config_.trusted_proxies;
  shared_.base_path = CheckedBasePath(config_.base_path);
  shared_.patience = config_.patience;
  shared_.snapshots = snapshots_ ? &*snapshots_ : nullptr;
  Accept();
  ArmTick();
  io_thread_ = std::thread([this] { RunIo(); });
  state_watch_ = Watch(states_, state_announced_, [this] { OnState(); });
  picture_watch_ = Watch(pictures_, picture_announced_, [this] { hub_.SendPicture(); });
}

HttpServer::Impl::~Impl() {
  stopping_ = true;
  states_.Interrupt();
  pictures_.Interrupt();
  state_watch_.join();
  picture_watch_.join();
  io_.stop();
  io_thread_.join();
  snapshots_.reset();  // its last picture is posted to io_, which no longer runs, and dropped there
  if (feed_ != nullptr) feed_->SetViewers(0);
}

Router::Site HttpServer::Impl::MakeSite() {
  Router::Site site;
  site.tokens = {config_.token, config_.viewer_token};
  // Cookies ignore ports: without the number, two servers on one machine would share a cookie.
  site.cookie_name = "kinescope_" + std::to_string(port_);
  site.cameras = config_.cameras;
  site.framing = config_.framing;
  site.history = config_.history;
  site.surroundings = config_.surroundings;
  site.former_surroundings = config_.former_surroundings;
  site.camera_image = config_.camera_image;
  site.started_micros = WallNanos() / 1000;
  site.marks = config_.marks;
  site.controls = config_.controls;
  site.alarms = config_.alarms;
  site.has_pictures = feed_ != nullptr;
  site.look = config_.look;
  site.own_skin = config_.own_skin;
  site.files = &files_;
  site.states = &states_;
  site.set_hand_load = config_.set_hand_load;
  site.diagnostics = [this] {
    return WithHttpCounters(program_diagnostics_ ? program_diagnostics_() : "{}", counters_,
                            hub_.client_counters(), tls_ ? &tls_->status() : nullptr);
  };
  site.live_camera = [this] { return hub_.camera(); };
  site.count_refusal = [this](const std::string& reason) { ++counters_.rejected[reason]; };
  site.guesses = &guesses_;
  site.is_tls = tls_.has_value();
  site.base_path = CheckedBasePath(config_.base_path);
  return site;
}

void HttpServer::Impl::RunIo() {
  while (true) {
    try {
      io_.run();
      return;
    } catch (const std::exception&) {
      // One handler failed (out of memory, for example) and its connection ended; the others
      // continue.
      ++counters_.failures;
    }
  }
}

template <class T, class Then>
std::thread HttpServer::Impl::Watch(Latest<T>& values, std::atomic<bool>& announced, Then then) {
  return std::thread([this, &values, &announced, then] {
    std::uint64_t seen = 0;
    while (!stopping_) {
      const auto asked_at = std::chrono::steady_clock::now();
      if (values.WaitNewer(seen, kWatch) == nullptr) {
        // Null before the timeout: interrupted; calling again would loop without a pause.
        if (std::chrono::steady_clock::now() - asked_at < kWatch) return;
        continue;
      }
      // At most one wake-up is queued: a busy server takes the newest value when it runs it.
      if (announced.exchange(true)) continue;
      asio::post(io_, [&announced, then] {
        announced = false;
        then();
      });
    }
  });
}

void HttpServer::Impl::OnState() {
  if (state_is_due_) return;
  const auto wait = hub_.SendState(std::chrono::steady_clock::now());
  if (wait <= decltype(wait)::zero()) return;
  state_is_due_ = true;
  state_pause_.expires_after(wait);
  state_pause_.async_wait([this](error_code) {
    state_is_due_ = false;
    OnState();
  });
}

void HttpServer::Impl::ArmTick() {
  tick_.expires_after(Hub::kTickInterval);
  tick_.async_wait([this](error_code error) {
    if (error) return;
    ArmTick();
    const auto now = std::chrono::steady_clock::now();
    hub_.Tick(now);
    if (hub_.client_count() > 0) {
      if (config_.stream) hub_.SendNews(Slot::kStream, config_.stream());
      if (config_.alarms != nullptr) {
        hub_.SendNews(Slot::kAlarms, alarms::ShownJson(*config_.alarms));
      }
      if (config_.controls != nullptr) {
        hub_.SendNews(Slot::kControls, config_.controls->StatusJson());
      }
    }
    guesses_.Report(now);
    if (tls_) tls_->Check(now);
  });
}

void HttpServer::Impl::Accept() {
  acceptor_.async_accept(
      [this](error_code error, tcp::socket socket) { OnAccepted(error, std::move(socket)); });
}

// Accepts the next connection first: a failure after that (out of memory, for example) costs one
// connection.
void HttpServer::Impl::OnAccepted(error_code error, tcp::socket socket) {
  if (error) {
    // Probably out of file descriptors: trying again at once would loop without a pause.
    accept_pause_.expires_after(std::chrono::milliseconds(100));
    accept_pause_.async_wait([this](error_code cancelled) {
      if (!cancelled) Accept();
    });
    ++counters_.rejected["accept failed"];
    return;
  }
  Accept();
  std::string address = ClientAddress(socket);
  if (!shared_.connections.MakeRoomFor(address, Clock::now())) {
    ++counters_.rejected["too many connections"];  // closed by its destructor
  } else {
    KeepKernelQueueShort(socket);
    std::make_shared<HttpSession>(std::move(socket), std::move(address), shared_)->Read();
  }
}

HttpServer::HttpServer(const HttpConfig& config, Listener& listener, Latest<SceneState>& states,
                       Latest<Picture>& pictures, PictureFeed* feed,
                       std::function<std::string()> diagnostics)
    : impl_(std::make_unique<Impl>(config, listener, states, pictures, feed,
                                   std::move(diagnostics))) {}

HttpServer::HttpServer(const HttpConfig& config, Latest<SceneState>& states,
                       Latest<Picture>& pictures, PictureFeed* feed,
                       std::function<std::string()> diagnostics) {
  Listener listener(config);
  impl_ = std::make_unique<Impl>(config, listener, states, pictures, feed, std::move(diagnostics));
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port_; }

namespace {

const std::string& TokenOf(const HttpConfig& config, Role role) {
  return role == Role::kOperator ? config.token : config.viewer_token;
}

std::string UrlOf(const HttpConfig& config, int port, const std::string& token) {
  const std::string& ip = config.bind_ip;
  // 0.0.0.0 cannot be opened; on this machine it means localhost.
  const bool is_any = ip == "0.0.0.0" || ip == "::";
  const std::string url = (config.tls.any() ? "https://" : "http://") +
                          Authority(is_any ? "localhost" : ip, port) +
                          CheckedBasePath(config.base_path) + "/";
  return token.empty() ? url : url + "?token=" + token;
}

}  // namespace

std::string HttpServer::url(Role role) const {
  return UrlOf(impl_->config_, impl_->port_, TokenOf(impl_->config_, role));
}

std::string HttpServer::url_for_log(Role role) const {
  const std::string& token = TokenOf(impl_->config_, role);
  return UrlOf(impl_->config_, impl_->port_, token.empty() ? "" : Shortened(token));
}

int HttpServer::clients() const { return impl_->hub_.client_count(); }

std::string HttpServer::SelectCamera(const std::string& camera, std::string_view role) {
  return impl_->hub_.SelectCamera(camera, role);
}

const std::string& HttpServer::camera() const { return impl_->hub_.camera(); }

void HttpServer::Post(std::function<void()> work) { asio::post(impl_->io_, std::move(work)); }

}  // namespace kinescope::http
