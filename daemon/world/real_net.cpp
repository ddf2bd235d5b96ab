#include "daemon/world/real_net.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <deque>
#include <list>

namespace glidehelm::world {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Local = asio::local::stream_protocol;

namespace {

constexpr std::size_t kMostQueued = 1U << 20;
constexpr std::size_t kReadSize = 16U << 10;
constexpr std::chrono::seconds kAcceptAgain{1};
constexpr std::chrono::seconds kConnectWithin{60};

void watch_peer(tcp::socket& socket) {
  const auto set = [&](int level, int name, int value) {
    ::setsockopt(socket.native_handle(), level, name, &value, sizeof value);
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 30);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 10);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, 60'000);
  set(IPPROTO_TCP, TCP_NODELAY, 1);
}

std::string peer_of(tcp::socket& socket) {
  error_code error;
  const auto peer = socket.remote_endpoint(error);
  if (error) return "?";
  const auto address = peer.address().to_string(error);
  return (peer.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(peer.port());
}

::ucred credentials_of(Local::socket& socket) {
  ::ucred who{};
  socklen_t size = sizeof who;
  if (::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) who.uid = 0xffffffffU;
  return who;
}

std::string peer_of(Local::socket& socket) {
  const auto who = credentials_of(socket);
  return "uid " + std::to_string(who.uid) + " pid " + std::to_string(who.pid);
}

std::uint32_t uid_of(tcp::socket&) { return 0xffffffffU; }
std::uint32_t uid_of(Local::socket& socket) { return credentials_of(socket).uid; }

template <class Socket>
class RealStream final : public Stream, public std::enable_shared_from_this<RealStream<Socket>> {
 public:
  explicit RealStream(Socket socket) : socket_{std::move(socket)}, peer_{peer_of(socket_)}, uid_{uid_of(socket_)} {}

  void start(Handlers handlers) override {
    handlers_ = std::move(handlers);
    read();
  }

  void write(std::string bytes) override {
    if (closed_ || bytes.empty()) return;
    queued_ += bytes.size();
    if (queued_ > kMostQueued) {
      end("the peer does not read: more than 1 MiB is waiting for it");
      return;
    }
    out_.push_back(std::move(bytes));
    if (out_.size() == 1) write_front();
  }

  void close() override {
    closed_ = true;
    handlers_ = {};
    error_code ignored;
    if (out_.empty()) socket_.close(ignored);  // what is queued still goes out; write_front closes behind it
  }

  [[nodiscard]] std::string peer() const override { return peer_; }
  [[nodiscard]] std::uint32_t peer_uid() const override { return uid_; }

 private:
  void read() {
    socket_.async_read_some(
        asio::buffer(in_), [self = this->shared_from_this()](const error_code& error, std::size_t n) {
          if (self->closed_) return;
          if (error) {
            self->end(error == asio::error::eof ? "the peer closed the connection" : error.message());
            return;
          }
          // The handler may close the stream and so destroy itself: a copy keeps it alive through the call.
          const auto bytes = self->handlers_.bytes;
          if (bytes) bytes(std::string_view{self->in_.data(), n});
          if (!self->closed_) self->read();
        });
  }

  void write_front() {
    asio::async_write(socket_, asio::buffer(out_.front()),
                      [self = this->shared_from_this()](const error_code& error, std::size_t) {
                        if (error) {
                          self->out_.clear();
                          if (!self->closed_) self->end(error.message());
                          return;
                        }
                        self->queued_ -= self->out_.front().size();
                        self->out_.pop_front();
                        if (!self->out_.empty())
                          self->write_front();
                        else if (self->closed_) {
                          error_code ignored;
                          self->socket_.close(ignored);
                        }
                      });
  }

  void end(const std::string& reason) {
    if (closed_) return;
    closed_ = true;
    error_code ignored;
    socket_.close(ignored);
    const auto ended = std::move(handlers_.ended);
    handlers_ = {};
    if (ended) ended(reason);
  }

  Socket socket_;
  std::string peer_;
  std::uint32_t uid_;
  Handlers handlers_;
  std::array<char, kReadSize> in_{};
  std::deque<std::string> out_;
  std::size_t queued_{};
  bool closed_{};
};

template <class Protocol>
class RealListener final : public Listener {
 public:
  using Acceptor = typename Protocol::acceptor;
  struct Loop : std::enable_shared_from_this<Loop> {
    Acceptor acceptor;
    Net::Accepted accepted;
    asio::steady_timer again;
    explicit Loop(asio::io_context& context) : acceptor{context}, again{context} {}

    void accept() {
      acceptor.async_accept(
          [self = this->shared_from_this()](const error_code& error, typename Protocol::socket socket) {
            if (error == asio::error::operation_aborted || !self->acceptor.is_open()) return;
            if (error) {  // out of descriptors, say: not a reason to spin or to stop listening
              self->again.expires_after(kAcceptAgain);
              self->again.async_wait([self](const error_code& stopped) {
                if (!stopped) self->accept();
              });
              return;
            }
            if constexpr (std::is_same_v<Protocol, tcp>) watch_peer(socket);
            self->accepted(std::make_shared<RealStream<typename Protocol::socket>>(std::move(socket)));
            self->accept();
          });
    }
  };

  RealListener(std::shared_ptr<Loop> loop, std::uint16_t port, std::string path)
      : loop_{std::move(loop)}, port_{port}, path_{std::move(path)} {}
  ~RealListener() override {
    error_code ignored;
    loop_->again.cancel();
    loop_->acceptor.close(ignored);
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  [[nodiscard]] std::uint16_t port() const override { return port_; }

 private:
  std::shared_ptr<Loop> loop_;
  std::uint16_t port_;
  std::string path_;
};

template <class Protocol>
error_code open_acceptor(typename Protocol::acceptor& acceptor, const typename Protocol::endpoint& endpoint) {
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error && std::is_same_v<Protocol, tcp>) acceptor.set_option(asio::socket_base::reuse_address{true}, error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  return error;
}

}  // namespace

struct RealNet::Parts {
  explicit Parts(asio::io_context& shared) : context{shared}, resolver{shared} {}
  asio::io_context& context;
  tcp::resolver resolver;
  struct Signal {
    Signal(asio::io_context& loop, int number, std::function<void()> handler)
        : set{loop, number}, then{std::move(handler)} {}
    asio::signal_set set;
    std::function<void()> then;
  };
  /// Waits again after each signal; the list keeps the address, and a loop that ends lets go of the handler.
  static void wait(Signal& signal) {
    signal.set.async_wait([&signal](const error_code& error, int) {
      if (error) return;
      signal.then();
      wait(signal);
    });
  }
  std::list<Signal> signals;
};

RealNet::RealNet(RealLoop& loop) : parts_{std::make_unique<Parts>(loop.context)} {}
RealNet::~RealNet() = default;

Expected<std::unique_ptr<Listener>, NetError> RealNet::listen_tcp(const std::string& address, std::uint16_t port,
                                                                  Accepted accepted) {
  const auto refused = [&](const std::string& reason) {
    return unexpected(NetError{"listen", address + ":" + std::to_string(port), reason});
  };
  error_code error;
  const auto ip = asio::ip::make_address(address, error);
  if (error) return refused("not an IP address");
  using Tcp = RealListener<tcp>;
  auto loop = std::make_shared<Tcp::Loop>(parts_->context);
  loop->accepted = std::move(accepted);
  error = open_acceptor<tcp>(loop->acceptor, tcp::endpoint{ip, port});
  if (error) return refused(error.message());
  const auto bound = loop->acceptor.local_endpoint(error).port();
  loop->accept();
  return std::unique_ptr<Listener>{std::make_unique<Tcp>(std::move(loop), bound, std::string{})};
}

Expected<std::unique_ptr<Listener>, NetError> RealNet::listen_unix(const std::string& path, unsigned mode,
                                                                   Accepted accepted) {
  const auto refused = [&](const std::string& reason) { return unexpected(NetError{"listen", path, reason}); };
  if (path.size() >= sizeof(sockaddr_un::sun_path)) return refused("the path is longer than 107 bytes");
  using Unix = RealListener<Local>;
  // A socket that nobody listens on is what a killed process left behind.
  Local::socket probe{parts_->context};
  error_code error;
  probe.connect(Local::endpoint{path}, error);
  if (!error) return refused("another process listens there");
  struct ::stat found {};
  const bool is_socket = ::lstat(path.c_str(), &found) == 0 && S_ISSOCK(found.st_mode);
  if (error == asio::error::connection_refused && is_socket) ::unlink(path.c_str());
  auto loop = std::make_shared<Unix::Loop>(parts_->context);
  loop->accepted = std::move(accepted);
  error = open_acceptor<Local>(loop->acceptor, Local::endpoint{path});
  if (error) return refused(error.message());
  if (::chmod(path.c_str(), mode) != 0) return refused("its mode cannot be set");
  loop->accept();
  return std::unique_ptr<Listener>{std::make_unique<Unix>(std::move(loop), std::uint16_t{0}, path)};
}

void RealNet::connect_tcp(const std::string& host, std::uint16_t port, Connected connected) {
  const auto where = host + ":" + std::to_string(port);
  parts_->resolver.async_resolve(
      host, std::to_string(port), tcp::resolver::numeric_service,
      [&context = parts_->context, where, connected = std::move(connected)](const error_code& error,
                                                                            const tcp::resolver::results_type& found) {
        if (error) {
          connected(unexpected(NetError{"resolve", where, error.message()}));
          return;
        }
        auto socket = std::make_shared<tcp::socket>(context);
        // The kernel would knock at a black hole for two minutes.
        auto patience = std::make_shared<asio::steady_timer>(context, kConnectWithin);
        patience->async_wait([socket](const error_code& stopped) {
          error_code ignored;
          if (!stopped) socket->close(ignored);
        });
        asio::async_connect(
            *socket, found, [socket, patience, where, connected](const error_code& problem, const tcp::endpoint&) {
              patience->cancel();
              if (!problem && socket->is_open()) {
                watch_peer(*socket);
                connected(std::shared_ptr<Stream>{std::make_shared<RealStream<tcp::socket>>(std::move(*socket))});
              } else {
                connected(unexpected(NetError{
                    "connect", where, problem && socket->is_open() ? problem.message() : "no answer within 60 s"}));
              }
            });
      });
}

void RealNet::connect_unix(const std::string& path, Connected connected) {
  if (path.size() >= sizeof(sockaddr_un::sun_path)) {
    post([path, connected = std::move(connected)] {
      connected(unexpected(NetError{"connect", path, "the path is longer than 107 bytes"}));
    });
    return;
  }
  auto socket = std::make_shared<Local::socket>(parts_->context);
  socket->async_connect(
      Local::endpoint{path}, [socket, path, connected = std::move(connected)](const error_code& error) {
        if (error)
          connected(unexpected(NetError{"connect", path, error.message()}));
        else
          connected(std::shared_ptr<Stream>{std::make_shared<RealStream<Local::socket>>(std::move(*socket))});
      });
}

void RealNet::on_signal(int number, std::function<void()> then) {
  parts_->signals.emplace_back(parts_->context, number, std::move(then));
  Parts::wait(parts_->signals.back());
}

void RealNet::post(std::function<void()> work) { asio::post(parts_->context, std::move(work)); }

void RealNet::run() {
  const auto guard = asio::make_work_guard(parts_->context);
  parts_->context.restart();
  parts_->context.run();
}

void RealNet::stop() { parts_->context.stop(); }

}  // namespace glidehelm::world
