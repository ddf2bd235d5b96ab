#include "daemon/world/simulated_clock.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/manual_clock.hpp"
#include "tests/support/manual_net.hpp"

using namespace glidehelm;
using world::SimulatedClock;

namespace {

constexpr const char* kSocket = "/run/clock";
constexpr Tick at(std::int64_t ms) { return Tick{std::chrono::milliseconds{ms}}; }

/// A daemon's clock and a simulator that says lines by hand (docs/lockstep.md).
struct Scene {
  test::ManualNet net;
  test::ManualClock wall;
  std::vector<std::string> answers, lost;
  std::shared_ptr<world::Stream> simulator;
  std::unique_ptr<world::Listener> listener;
  std::string partial;
  int ready{};
  std::unique_ptr<SimulatedClock> clock;

  explicit Scene(std::size_t chunk = 0) {
    net.chunk = chunk;
    listener = net.listen_unix(kSocket, 0600,
                               [this](std::shared_ptr<world::Stream> stream) {
                                 simulator = std::move(stream);
                                 simulator->start({[this](std::string_view bytes) { hear(bytes); },
                                                   [this](std::string_view) { answers.emplace_back("(gone)"); }});
                               })
                   .value();
    clock = std::make_unique<SimulatedClock>(net, wall, kSocket,
                                             [this](std::string_view reason) { lost.emplace_back(reason); });
    clock->start([this] { ++ready; });
    net.settle();
    REQUIRE(simulator);
  }
  void hear(std::string_view bytes) {
    partial += bytes;
    for (auto end = partial.find('\n'); end != std::string::npos; end = partial.find('\n')) {
      answers.push_back(partial.substr(0, end));
      partial.erase(0, end + 1);
    }
  }
  void say(const std::string& text) {
    simulator->write(text);
    net.settle();
  }
  void greet() { say("glidersim-clock 1\n"); }
  /// What the daemon has answered since the last look.
  std::vector<std::string> heard() {
    net.settle();
    return std::exchange(answers, {});
  }
};
using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("time is what the simulator says, whatever the chunks") {
  Scene s{GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{5})};
  CHECK(s.clock->simulated());
  s.greet();
  CHECK(s.ready == 0);  // there is no time yet
  s.say("run 1800000000000 5000\n");
  CHECK(s.ready == 1);
  CHECK(s.clock->utc() == Instant{std::chrono::milliseconds{1'800'000'000'000}});
  CHECK(s.clock->tick() == at(5000));
  CHECK(s.heard() == Lines{"idle 5000 none"});
  s.say("run 1799999990000 5000\n");  // UTC may step back, the tick may stand
  CHECK(s.clock->utc() == Instant{std::chrono::milliseconds{1'799'999'990'000}});
  CHECK(s.ready == 1);
  CHECK(s.heard() == Lines{"idle 5000 none"});
  CHECK(s.lost.empty());
}

TEST_CASE("timers fire in order up to the tick, and the next one is told") {
  Scene s;
  s.greet();
  s.say("run 0 1000\n");
  std::string order;
  s.clock->on_run([&] { order += '!'; });
  s.clock->call_at(at(3000), [&] { order += 'c'; });
  s.clock->call_at(at(2000), [&] {
    order += 'a';
    s.clock->call_at(at(2000), [&] { order += 'b'; });  // due at once
    s.clock->call_at(at(7000), [&] { order += 'd'; });
  });
  const auto cancelled = s.clock->call_at(at(2500), [&] { order += 'x'; });
  s.clock->cancel(cancelled);
  CHECK(s.clock->next_timer() == at(2000));
  CHECK(s.heard() == Lines{"idle 1000 none"});
  s.say("run 1000 3000\n");
  CHECK(order == "!abc");
  CHECK(s.heard() == Lines{"idle 3000 7000"});
}

TEST_CASE("idle waits for every byte of every line, and for what is under way") {
  Scene s;
  s.greet();
  s.clock->handled("early", 3);  // bytes may come before their run
  s.say("run 0 1000 a=10 b=0 early=3\n");
  CHECK(s.heard().empty());
  s.clock->handled("a", 9);
  CHECK(s.heard().empty());
  s.clock->set_busy(true);
  s.clock->handled("a", 10);
  CHECK(s.heard().empty());
  s.clock->call_at(at(900), [] {});  // overdue: fires before the answer
  s.clock->call_at(at(4000), [] {});
  s.clock->set_busy(false);
  CHECK(s.heard() == Lines{"idle 1000 4000"});
  s.clock->set_busy(false);
  s.clock->handled("a", 11);
  CHECK(s.heard().empty());  // nobody asked
}

TEST_CASE("a timer that begins something keeps the answer back until it is done") {
  Scene s;
  s.greet();
  s.clock->call_at(at(500), [&] { s.clock->set_busy(true); });
  s.say("run 0 1000\n");
  CHECK(s.heard().empty());
  s.clock->set_busy(false);
  CHECK(s.heard() == Lines{"idle 1000 none"});
}

TEST_CASE("a line that is none ends the clock, once") {
  const std::string line = GENERATE(as<std::string>{}, "run", "run 1", "run x 1000", "run 0 1000x", "run 0 1000 a",
                                    "run 0 1000 a=", "run 0 1000 a=-1", "run 0 999", "run 0 1e3", "walk 0 1000", "",
                                    "run 0 1000  a=1", "glidersim-clock 1");
  Scene s;
  s.greet();
  s.say("run 0 1000\n");
  CHECK(s.heard() == Lines{"idle 1000 none"});
  s.say(line + "\nrun 0 2000\n");
  REQUIRE(s.lost.size() == 1);
  CHECK(s.lost[0] == "the simulator sent: " + line);
  CHECK(s.clock->tick() == at(1000));
  CHECK(s.heard() == Lines{"(gone)"});
}

TEST_CASE("another version, a line without end, a second run, no simulator: the reason is said") {
  SECTION("another version") {
    Scene s;
    s.say("glidersim-clock 2\n");
    CHECK(s.lost == Lines{"the simulator speaks another version: glidersim-clock 2"});
  }
  SECTION("a line without end") {
    Scene s;
    s.greet();
    s.say(std::string(70'000, 'x'));
    CHECK(s.lost == Lines{"the simulator sent a line without end"});
  }
  SECTION("a run before the answer to the last") {
    Scene s;
    s.greet();
    s.say("run 0 1000 a=1\nrun 0 2000 a=1\n");
    CHECK(s.lost == Lines{"the simulator sent: run 0 2000 a=1"});
  }
  SECTION("it goes away") {
    Scene s;
    s.greet();
    s.simulator->close();
    s.net.settle();
    CHECK(s.lost == Lines{"the peer closed the connection"});
  }
  SECTION("it is not there") {
    test::ManualNet net;
    test::ManualClock wall;
    Lines lost;
    SimulatedClock clock{net, wall, kSocket, [&](std::string_view reason) { lost.emplace_back(reason); }};
    clock.start([] {});
    // 300 tries, 200 ms apart: after the first one, a minute of patience.
    for (int i = 0; i < 299; ++i) {
      net.settle();
      wall.advance(Seconds{0.2});
    }
    net.settle();
    CHECK(lost.empty());
    SECTION("it never comes") {
      wall.advance(Seconds{0.2});
      net.settle();
      CHECK(lost == Lines{"connect /run/clock: No such file or directory"});
      CHECK_FALSE(wall.next_timer());
    }
    SECTION("it comes late") {
      bool connected = false;
      const auto listener = net.listen_unix(kSocket, 0600, [&](auto) { connected = true; }).value();
      wall.advance(Seconds{0.2});
      net.settle();
      CHECK(connected);
      CHECK(lost.empty());
    }
  }
}

TEST_CASE("whoever hears that the clock is lost may end it") {
  Scene s;
  s.greet();
  s.say("run 0 1000\n");
  SimulatedClock* clock = s.clock.get();
  CHECK(clock->tick() == at(1000));
  test::ManualNet net;
  std::unique_ptr<SimulatedClock> other;
  std::shared_ptr<world::Stream> simulator;
  const auto listener = net.listen_unix(kSocket, 0600, [&](auto stream) { simulator = std::move(stream); }).value();
  int lost = 0;
  other = std::make_unique<SimulatedClock>(net, s.wall, kSocket, [&](std::string_view) {
    ++lost;
    other.reset();
  });
  other->start([] {});
  net.settle();
  REQUIRE(simulator);
  simulator->write("nonsense\nmore nonsense\n");
  net.settle();
  CHECK(lost == 1);
  CHECK_FALSE(other);
}

TEST_CASE("a clock that ends first is not called any more") {
  Scene s;
  s.greet();
  s.simulator->write("run 0 1000\n");
  s.clock.reset();
  CHECK(s.heard() == Lines{"(gone)"});
  CHECK(s.ready == 0);
}
