#include "daemon/line.hpp"

#include <catch2/catch.hpp>

#include "tests/support/manual_world.hpp"

using namespace glidehelm;
using daemon::Line;

namespace {

/// A line in a world that the test moves, with everything that it said.
struct Wire {
  test::ManualWorld world;
  std::vector<std::string> story;
  std::unique_ptr<Line> line;

  explicit Wire(config::Line how) {
    line = std::make_unique<Line>(
        world.world(), std::move(how),
        Line::Handlers{[this](std::uint64_t connection, std::string_view, bool replaced) {
                         story.push_back("open " + std::to_string(connection) + (replaced ? " replacing" : ""));
                       },
                       [this](std::uint64_t connection, std::string_view bytes) {
                         story.push_back(std::to_string(connection) + ": " + std::string{bytes});
                       },
                       [this](std::uint64_t connection, std::string_view reason) {
                         story.push_back("closed " + std::to_string(connection) + ": " + std::string{reason});
                       },
                       [this](std::string_view problem) { story.push_back("trouble: " + std::string{problem}); }});
  }
  std::shared_ptr<world::Stream> dial() {
    std::shared_ptr<world::Stream> stream;
    world.net.connect_tcp("127.0.0.1", 6500, [&](auto s) {
      stream = std::move(s).value();
      stream->start({[](std::string_view) {}, [this](std::string_view) { ++ended; }});
    });
    world.net.settle();
    return stream;
  }
  int ended{};
};

config::Listen listening(std::vector<config::Network> allow = {}) {
  return {config::Endpoint{"127.0.0.1", 6500}, std::move(allow)};
}
config::Connect dialling() { return {config::Endpoint{"dock.example.org", 6500}}; }

using Story = std::vector<std::string>;

}  // namespace

TEST_CASE("a line that listens hands on every byte with its connection, and the end") {
  Wire wire{listening()};
  REQUIRE(wire.line->start());
  CHECK_FALSE(wire.line->connected());
  const auto dock = wire.dial();
  CHECK(wire.line->connected());
  dock->write("Vehicle ");
  dock->write("Name: sim01\r\n");
  wire.world.net.settle();
  dock->close();
  wire.world.net.settle();
  CHECK(wire.story == Story{"open 1", "1: Vehicle ", "1: Name: sim01\r\n", "closed 1: the peer closed the connection"});
  CHECK_FALSE(wire.line->connected());
}

TEST_CASE("a newer connection replaces the older one, whose bytes are not heard any more") {
  Wire wire{listening()};
  REQUIRE(wire.line->start());
  const auto older = wire.dial();
  const auto newer = wire.dial();
  older->write("late");
  newer->write("now");
  wire.world.net.settle();
  CHECK(wire.story == Story{"open 1", "closed 1: replaced by a newer connection", "open 2 replacing", "2: now"});
  CHECK(wire.ended == 1);
}

TEST_CASE("a peer that is not allowed is closed and named, and the line goes on") {
  Wire wire{listening({*config::Network::from_text("192.0.2.0/24")})};
  REQUIRE(wire.line->start());
  wire.dial();
  REQUIRE(wire.story.size() == 1);
  CHECK(wire.story[0].find("trouble: connection from 127.0.0.1:") == 0);
  CHECK(wire.story[0].find("is not in `allow`: closed") != std::string::npos);
  CHECK(wire.ended == 1);
  CHECK_FALSE(wire.line->connected());
}

TEST_CASE("a port that is taken is said at once") {
  Wire wire{listening()};
  const auto other = wire.world.net.listen_tcp("127.0.0.1", 6500, [](std::shared_ptr<world::Stream>) {});
  REQUIRE(other);
  const auto started = wire.line->start();
  REQUIRE_FALSE(started);
  CHECK(started.error().message().find("Address already in use") != std::string::npos);
}

TEST_CASE("dropping a connection closes it with the reason, without one nothing happens") {
  Wire wire{listening()};
  REQUIRE(wire.line->start());
  wire.line->drop("nobody is there");
  CHECK(wire.story.empty());
  const auto dock = wire.dial();
  wire.line->drop("another glider's name");
  wire.world.net.settle();
  CHECK(wire.story == Story{"open 1", "closed 1: another glider's name"});
  CHECK(wire.ended == 1);
}

TEST_CASE("a line that dials tries again, from 1 s to 5 min with a fifth of jitter, and says each cause once") {
  Wire wire{dialling()};
  REQUIRE(wire.line->start());
  wire.world.net.settle();
  std::vector<double> waits;
  for (int i = 0; i < 12; ++i) {
    const auto next = wire.world.clock.next_timer();
    REQUIRE(next);
    waits.push_back(Seconds{*next - wire.world.clock.tick()}.count());
    wire.world.clock.advance_to_next();
    wire.world.net.settle();
  }
  double nominal = 1;
  for (const double wait : waits) {
    CHECK(wait >= 0.8 * nominal);
    CHECK(wait <= 1.2 * nominal);
    nominal = std::min(2 * nominal, 300.0);
  }
  CHECK(wire.story == Story{"trouble: connect dock.example.org:6500: Connection refused"});
}

TEST_CASE("after a call the back-off begins again, and the same trouble is said again") {
  Wire wire{dialling()};
  REQUIRE(wire.line->start());
  wire.world.net.settle();
  wire.world.pass(Seconds{100});
  std::shared_ptr<world::Stream> dock;
  {
    const auto listener = wire.world.net.listen_tcp("dock.example.org", 6500, [&](std::shared_ptr<world::Stream> s) {
      dock = std::move(s);
      dock->start({[](std::string_view) {}, [](std::string_view) {}});
    });
    REQUIRE(listener);
    wire.world.pass(Seconds{360});
    REQUIRE(wire.line->connected());
    dock->close();
    wire.world.net.settle();
  }
  const auto next = wire.world.clock.next_timer();
  REQUIRE(next);
  CHECK(Seconds{*next - wire.world.clock.tick()}.count() <= 1.2);
  wire.world.pass(Seconds{30});
  CHECK(wire.story == Story{"trouble: connect dock.example.org:6500: Connection refused", "open 1",
                            "closed 1: the peer closed the connection",
                            "trouble: connect dock.example.org:6500: Connection refused"});
}

TEST_CASE("a line that is gone dials no more and hears nothing that was on its way") {
  Wire dialler{dialling()};
  REQUIRE(dialler.line->start());
  dialler.line.reset();
  dialler.world.net.settle();
  CHECK_FALSE(dialler.world.clock.next_timer());
  CHECK(dialler.story.empty());

  Wire listener{listening()};
  REQUIRE(listener.line->start());
  const auto dock = listener.dial();
  dock->write("on its way");
  listener.line.reset();
  listener.world.net.settle();
  CHECK(listener.story == Story{"open 1"});
  CHECK(listener.ended == 1);
}
