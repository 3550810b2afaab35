#include "server/http/server.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

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

#include "core/system/errors.h"
#include "server/http/access.h"
#include "server/http/http_session.h"

namespace kinescope::http {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr int kMaxConnections = 256;  // WebSockets are not counted here
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
    throw UsageError("--http_port=" + std::to_string(config.port) + ": expected 0 to 65535");
  }
  if (!address.is_loopback() && config.token.empty()) {
    throw UsageError(
        "--bind_ip=" + config.bind_ip +
        ": an address that other machines can reach needs --token; set a token, or use 127.0.0.1");
  }
  if (!FitsIntoCookie(config.token)) {
    throw UsageError("--token: expected only letters, digits and -._~");
  }
}

namespace {

tcp::acceptor Listen(asio::io_context& io, const HttpConfig& config) {
  CheckConfig(config);
  tcp::acceptor acceptor(io);
  const tcp::endpoint endpoint(asio::ip::make_address(config.bind_ip),
                               static_cast<unsigned short>(config.port));
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    throw UsageError("cannot serve the page at " + Authority(config.bind_ip, config.port) + ": " +
                     error.message() + "; choose another port with --http_port (0: a free one)");
  }
  return acceptor;
}

}  // namespace

struct HttpServer::Impl {
  Impl(const HttpConfig& config, Latest<SceneState>& states, Latest<Picture>& pictures,
       PictureFeed* feed, std::function<std::string()> program_diagnostics);
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
  std::optional<SnapshotWorker> snapshots_;
  std::optional<Router> router_;
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

HttpServer::Impl::Impl(const HttpConfig& config, Latest<SceneState>& states,
                       Latest<Picture>& pictures, PictureFeed* feed,
                       std::function<std::string()> program_diagnostics)
    : config_(config),
      states_(states),
      pictures_(pictures),
      feed_(feed),
      program_diagnostics_(std::move(program_diagnostics)),
      files_(config.web_root),
      hub_(states, pictures, feed, config.camera, counters_),
      acceptor_(Listen(io_, config)) {
  port_ = acceptor_.local_endpoint().port();
  if (feed_ != nullptr) snapshots_.emplace(*feed_);
  router_.emplace(MakeSite());
  shared_.router = &*router_;
  shared_.hub = &hub_;
  shared_.counters = &counters_;
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
  site.token = config_.token;
  // Cookies ignore ports: without the number, two servers on one machine would share a cookie.
  site.cookie_name = "kinescope_" + std::to_string(port_);
  site.cameras = config_.cameras;
  site.framing = config_.framing;
  site.has_pictures = feed_ != nullptr;
  site.files = &files_;
  site.states = &states_;
  site.set_hand_load = config_.set_hand_load;
  site.diagnostics = [this] {
    return WithHttpCounters(program_diagnostics_ ? program_diagnostics_() : "{}", counters_,
                            hub_.client_counters());
  };
  site.live_camera = [this] { return hub_.camera(); };
  site.count_refusal = [this](const std::string& reason) { ++counters_.rejected[reason]; };
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
    hub_.Tick(std::chrono::steady_clock::now());
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
  if (shared_.connections >= kMaxConnections) {
    ++counters_.rejected["too many connections"];  // closed by its destructor
  } else {
    KeepKernelQueueShort(socket);
    std::make_shared<HttpSession>(std::move(socket), shared_)->Read();
  }
}

HttpServer::HttpServer(const HttpConfig& config, Latest<SceneState>& states,
                       Latest<Picture>& pictures, PictureFeed* feed,
                       std::function<std::string()> diagnostics)
    : impl_(std::make_unique<Impl>(config, states, pictures, feed, std::move(diagnostics))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port_; }

std::string HttpServer::url() const {
  const std::string& ip = impl_->config_.bind_ip;
  // 0.0.0.0 cannot be opened; on this machine it means localhost.
  const bool is_any = ip == "0.0.0.0" || ip == "::";
  const std::string url = "http://" + Authority(is_any ? "localhost" : ip, impl_->port_) + "/";
  return impl_->config_.token.empty() ? url : url + "?token=" + impl_->config_.token;
}

int HttpServer::clients() const { return impl_->hub_.client_count(); }

}  // namespace kinescope::http
