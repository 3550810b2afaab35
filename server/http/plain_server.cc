#include "server/http/plain_server.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "server/http/client_address.h"
#include "server/http/counters.h"
#include "server/http/http_session.h"
#include "server/http/server.h"

namespace kinescope::http {
namespace {

constexpr std::chrono::milliseconds kLook{100};
constexpr std::chrono::seconds kLastAnswers{2};
constexpr std::chrono::milliseconds kAcceptPause{100};

}  // namespace

struct PlainServer::Impl {
  explicit Impl(Listener& listener)
      : acceptor(io, boost::asio::ip::tcp::v4(), listener.Release()),
        port(acceptor.local_endpoint().port()) {
    shared.counters = &counters;
  }

  void Accept();
  void OnAccepted(boost::asio::ip::tcp::socket socket);
  void RunOne();

  // Before io, so that they outlive the sessions that io still holds when it is destroyed.
  Counters counters;
  Shared shared;
  boost::asio::io_context io{1};
  boost::asio::ip::tcp::acceptor acceptor;
  boost::asio::steady_timer accept_pause{io};
  const int port;
};

void PlainServer::Impl::Accept() {
  acceptor.async_accept(
      [this](boost::system::error_code error, boost::asio::ip::tcp::socket socket) {
        if (error == boost::asio::error::operation_aborted) return;
        if (error) {  // probably out of file descriptors
          accept_pause.expires_after(kAcceptPause);
          return accept_pause.async_wait([this](boost::system::error_code cancelled) {
            if (!cancelled) Accept();
          });
        }
        Accept();
        OnAccepted(std::move(socket));
      });
}

void PlainServer::Impl::OnAccepted(boost::asio::ip::tcp::socket socket) {
  std::string client = ClientAddress(socket);
  if (!shared.connections.MakeRoomFor(client, Clock::now())) return;
  std::make_shared<HttpSession>(std::move(socket), std::move(client), shared)->Read();
}

// What one connection cannot do (out of memory, for example) ends that connection.
void PlainServer::Impl::RunOne() {
  try {
    io.run_one_for(kLook);
  } catch (const std::exception&) {
    ++counters.failures;
  }
}

PlainServer::PlainServer(Listener&& listener, Route route)
    : impl_(std::make_unique<Impl>(listener)) {
  impl_->shared.route = std::move(route);
}

PlainServer::~PlainServer() = default;

int PlainServer::port() const { return impl_->port; }

void PlainServer::Serve(const std::function<bool()>& is_over) {
  impl_->Accept();
  while (!is_over()) impl_->RunOne();
  boost::system::error_code ignored;
  impl_->acceptor.close(ignored);
  const auto until = Clock::now() + kLastAnswers;
  while (impl_->shared.connections.CountBusy() > 0 && Clock::now() < until) impl_->RunOne();
}

}  // namespace kinescope::http
