#include "daemon/world/real_net.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "daemon/world/real.hpp"
#include "tests/contract/net_contract.hpp"
#include "tests/simulator/temp_folder.hpp"
#include "tests/support/manual_net.hpp"

using namespace glidehelm;
using namespace glidehelm::world;
using glidehelm::test::NetContract;
using glidehelm::test::TempFolder;

namespace {

/// The real loop, turned until something is so; ten seconds of patience.
struct Loop {
  RealWorld real;
  World world{real.world()};
  void until(const std::function<bool()>& so) {
    const auto end = world.clock.tick() + std::chrono::seconds{10};
    std::function<void()> look = [&] {
      if (so() || world.clock.tick() > end)
        world.net.stop();
      else
        world.clock.call_at(world.clock.tick() + std::chrono::milliseconds{2}, look);
    };
    world.net.post(look);
    world.net.run();
    REQUIRE(so());
  }
};

/// Sockets of this process that are watched as a line to a glider must be.
int watched_sockets() {
  int count = 0;
  for (int fd = 0; fd < 256; ++fd) {
    const auto is = [&](int level, int name, int wanted) {
      int value = 0;
      socklen_t size = sizeof value;
      return ::getsockopt(fd, level, name, &value, &size) == 0 && value == wanted;
    };
    if (is(SOL_SOCKET, SO_KEEPALIVE, 1) && is(IPPROTO_TCP, TCP_KEEPIDLE, 30) && is(IPPROTO_TCP, TCP_KEEPINTVL, 10) &&
        is(IPPROTO_TCP, TCP_KEEPCNT, 3) && is(IPPROTO_TCP, TCP_USER_TIMEOUT, 60'000))
      ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("the machine's streams and the ones in memory keep one contract") {
  TempFolder temp;
  const std::string path = temp.path / "socket";
  SECTION("the machine's") {
    Loop loop;
    NetContract{loop.world.net, [&](const auto& so) { loop.until(so); }, path}.check();
  }
  SECTION("in memory, in pieces of any size") {
    test::ManualNet net;
    net.chunk = GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{7});
    NetContract{net,
                [&](const auto& so) {
                  net.settle();
                  REQUIRE(so());
                },
                path}
        .check();
  }
}

TEST_CASE("both ends of a TCP line are watched for a peer that is silently gone") {
  Loop loop;
  NetContract::Ear near, far;
  const auto listener =
      loop.world.net.listen_tcp("127.0.0.1", 0, [&](std::shared_ptr<Stream> s) { far.start(std::move(s)); }).value();
  loop.world.net.connect_tcp("localhost", listener->port(), [&](auto s) { near.start(std::move(s).value()); });
  loop.until([&] { return near.started && far.started; });
  CHECK(watched_sockets() == 2);
}

TEST_CASE("addresses that cannot be had say why") {
  Loop loop;
  const auto refused = loop.world.net.listen_tcp("localhost", 0, [](auto) {});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message() == "listen localhost:0: not an IP address");
  CHECK_FALSE(loop.world.net.listen_tcp("203.0.113.7", 0, [](auto) {}));  // not an address of this machine
  const auto long_path = std::string(120, 'x');
  const auto too_long = loop.world.net.listen_unix(long_path, 0600, [](auto) {});
  REQUIRE_FALSE(too_long);
  CHECK(too_long.error().reason == "the path is longer than 107 bytes");
  std::string problem;
  loop.world.net.connect_unix(long_path, [&](auto s) { problem = s ? "connected" : s.error().reason; });
  loop.until([&] { return !problem.empty(); });
  CHECK(problem == "the path is longer than 107 bytes");
  problem.clear();
  loop.world.net.connect_tcp("no-such-host.invalid", 1,
                             [&](auto s) { problem = s ? "connected" : s.error().operation; });
  loop.until([&] { return !problem.empty(); });
  CHECK(problem == "resolve");
}

TEST_CASE("a Unix socket has its mode, tells who calls, and outlives nobody") {
  TempFolder temp;
  const std::string path = temp.path / "s";
  Loop loop;
  {
    // What a killed process leaves behind: a bound socket that nobody listens on.
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, path.size());
    REQUIRE(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::close(fd);
  }
  NetContract::Ear caller, called;
  auto listener =
      loop.world.net.listen_unix(path, 0640, [&](std::shared_ptr<Stream> s) { called.start(std::move(s)); });
  REQUIRE(listener);
  struct ::stat stat {};
  REQUIRE(::stat(path.c_str(), &stat) == 0);
  CHECK((stat.st_mode & 07777U) == 0640);
  const auto second = loop.world.net.listen_unix(path, 0640, [](auto) {});
  REQUIRE_FALSE(second);
  CHECK(second.error().reason == "another process listens there");
  loop.world.net.connect_unix(path, [&](auto s) { caller.start(std::move(s).value()); });
  loop.until([&] { return called.started; });
  CHECK(called.stream->peer_uid() == ::getuid());
  CHECK(called.stream->peer() == "uid " + std::to_string(::getuid()) + " pid " + std::to_string(::getpid()));
  listener->reset();
  CHECK_FALSE(std::filesystem::exists(path));
  // The file of somebody else is not removed to make room.
  temp.write("s", "a file");
  CHECK_FALSE(loop.world.net.listen_unix(path, 0640, [](auto) {}));
  CHECK(temp.read("s") == "a file");
}

TEST_CASE("a handler may close its stream, and hears nothing after it") {
  Loop loop;
  int heard = 0, ended = 0;
  std::shared_ptr<Stream> far;
  NetContract::Ear near;
  const auto listener = loop.world.net
                            .listen_tcp("127.0.0.1", 0,
                                        [&](std::shared_ptr<Stream> s) {
                                          far = std::move(s);
                                          far->start({[&](std::string_view) {
                                                        ++heard;
                                                        far->close();
                                                        far.reset();
                                                      },
                                                      [&](std::string_view) { ++ended; }});
                                        })
                            .value();
  loop.world.net.connect_tcp("127.0.0.1", listener->port(), [&](auto s) {
    near.start(std::move(s).value());
    near.stream->write("first");
  });
  loop.until([&] { return !near.ended.empty(); });
  CHECK(heard == 1);
  CHECK(ended == 0);
}

TEST_CASE("signals and other threads come through the loop") {
  Loop loop;
  int signals = 0, posted = 0;
  loop.world.net.on_signal(SIGUSR1, [&] {
    if (++signals < 3) ::raise(SIGUSR1);
  });
  ::raise(SIGUSR1);
  std::thread other{[&] {
    for (int i = 0; i < 100; ++i) loop.world.net.post([&] { ++posted; });
  }};
  loop.until([&] { return signals == 3 && posted == 100; });
  other.join();
}

TEST_CASE("signals in memory are raised by the test, and run stops when it is told to") {
  test::ManualNet net;
  int signals = 0;
  net.on_signal(SIGTERM, [&] {
    ++signals;
    net.stop();
  });
  std::thread other{[&] { net.raise(SIGTERM); }};
  net.run();
  other.join();
  CHECK(signals == 1);
  CHECK(net.stopped());
}
