#include "simulator/runner.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "daemon/world/real.hpp"
#include "daemon/world/simulated_clock.hpp"
#include "tests/simulator/support.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using namespace glidehelm::simulator;

namespace {

const Instant kStart = instant_at(1.7e9);

GliderPlan short_way() {
  GliderPlan p;
  p.setup.start = geo_point(40, 5);
  p.setup.start_s = 1.7e9;
  p.setup.cycle_s = 20;
  p.goal = destination(p.setup.start, Bearing{}, Metres{8000});
  p.setup.list.waypoints = {p.goal};
  p.setup.list.radius = Metres{500};
  p.setup.list.initial = 0;
  return p;
}

/// A daemon of a few lines, in the same loop: the project's own simulated clock and a listening line. Its clock connects
/// once the runner listens.
struct FakeDaemon {
  FakeDaemon(world::World world, std::string clock_socket)
      : net{world.net}, wall{world.clock}, socket{std::move(clock_socket)} {
    auto made = net.listen_tcp("127.0.0.1", 0, [this](std::shared_ptr<world::Stream> s) { adopt(std::move(s)); });
    REQUIRE(made);
    listener = std::move(*made);
  }
  /// A life begins when the runner's loop runs.
  void come_to_life(std::function<void()> ready = [] {}) {
    net.post([this, ready] { live(ready); });
  }
  void live(const std::function<void()>& ready) {
    ++lives;
    received = 0;
    clock.emplace(net, wall, socket, [](std::string_view) {});
    clock->start(ready);
  }
  void adopt(std::shared_ptr<world::Stream> s) {
    stream = std::move(s);
    ++connections;
    stream->start({[this](std::string_view bytes) {
                     text += bytes;
                     received += bytes.size();
                     if (on_bytes) on_bytes(std::string{bytes});
                     if (clock && answers) clock->handled("sim01", received);
                   },
                   [this](std::string_view) {
                     if (on_ended) on_ended();
                   }});
    if (on_adopt) on_adopt(stream);
  }
  [[nodiscard]] std::uint16_t port() const { return listener->port(); }

  world::Net& net;
  world::Clock& wall;
  std::string socket;
  std::optional<world::SimulatedClock> clock;
  std::unique_ptr<world::Listener> listener;
  std::shared_ptr<world::Stream> stream;
  std::function<void(const std::string&)> on_bytes;
  std::function<void()> on_ended;
  std::function<void(const std::shared_ptr<world::Stream>&)> on_adopt;
  std::string text;
  std::uint64_t received{};
  int connections{}, lives{};
  bool answers{true};
};

struct Scene {
  explicit Scene(GliderPlan plan = short_way(), EndPlan end = {}) {
    auto made = DockFolder::make(world.files, (temp.path / "d").string());
    REQUIRE(made);
    folder = std::move(*made);
    sim.emplace(std::vector<Simulation::Member>{{std::move(plan), folder.get()}}, ocean::Ocean{kStill, kStill}, kOpen,
                end, 1);
  }
  RunOutcome run(Pace pace, std::uint16_t port, bool we_dial = true) {
    Runner runner{world.net,
                  world.clock,
                  *sim,
                  {{"sim01", {we_dial, "127.0.0.1", port}, folder.get()}},
                  kStart,
                  std::move(pace),
                  {[this](const SurfacingRecord& r) { told.push_back(r.number); },
                   [this](const std::string& s) { said += s + "\n"; }, [this](Instant now) { times.push_back(now); }}};
    return runner.run();
  }
  [[nodiscard]] std::string socket() const { return (temp.path / "c").string(); }
  Pace lockstep() const { return {socket(), std::nullopt, false, 10}; }
  TempFolder temp;
  world::RealWorld real;
  world::World world{real.world()};
  std::unique_ptr<DockFolder> folder;
  std::optional<Simulation> sim;
  std::vector<int> told;
  std::vector<Instant> times;
  std::string said;
};

std::string list_to(const char* waypoint) {
  return std::string{
             "behavior_name=goto_list\n<start:b_arg>\nb_arg: initial_wpt(enum) 0\nb_arg: list_when_wpt_dist(m) "
             "300\n<end:b_arg>\n<start:waypoints>\n"} +
         waypoint + "\n<end:waypoints>\n";
}

}  // namespace

TEST_CASE("in lockstep a whole run takes no wall time to speak of, and every byte arrives at its simulated time") {
  Scene scene;
  FakeDaemon daemon{scene.world, scene.socket()};
  std::vector<std::int64_t> blocks;
  daemon.on_bytes = [&](const std::string& bytes) {
    if (bytes.find("Glider sim01 at surface.") == 0) blocks.push_back((daemon.clock->utc() - kStart).count());
  };
  daemon.come_to_life();
  REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
  CHECK(scene.sim->all_arrived());
  CHECK(scene.told.size() == scene.sim->surfacings(0).size());
  CHECK(std::is_sorted(scene.times.begin(), scene.times.end()));
  CHECK(scene.times.size() > blocks.size());
  CHECK(daemon.received > 10'000);
  REQUIRE(blocks.size() > 13);
  // The first at-surface block: 60 s to the last fix, 45 s to the call, 15 s to the block; then one a minute.
  CHECK(blocks[0] == 120'000);
  CHECK(blocks[1] == 180'000);
  CHECK(std::is_sorted(blocks.begin(), blocks.end()));
}

TEST_CASE("the daemon's timers fire in between, at their own tick") {
  Scene scene{short_way(), EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  std::vector<std::int64_t> fired;
  std::function<void()> again = [&] {
    fired.push_back((daemon.clock->utc() - kStart).count());
    if (fired.size() < 5) daemon.clock->call_at(daemon.clock->tick() + std::chrono::milliseconds{33'333}, again);
  };
  daemon.come_to_life([&] { daemon.clock->call_at(daemon.clock->tick() + std::chrono::milliseconds{33'333}, again); });
  REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
  CHECK(fired == std::vector<std::int64_t>{33'333, 66'666, 99'999, 133'332, 166'665});
}

TEST_CASE("two lockstep runs give the same bytes, and a file put there in between is flown in both") {
  std::vector<std::string> texts;
  for (int k = 0; k < 2; ++k) {
    Scene scene{short_way(), EndPlan{true, 3, std::nullopt}};
    FakeDaemon daemon{scene.world, scene.socket()};
    daemon.on_bytes = [&](const std::string& bytes) {
      if (bytes.find("at surface.") != std::string::npos)
        scene.temp.write("d/to-glider/goto_l10.ma", list_to("0500.0 3900.0"));
    };
    daemon.come_to_life();
    REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
    CHECK(scene.sim->result(0).lists_taken == 3);
    CHECK(scene.sim->dives(0)[0].truth.heading.degrees() == Approx(180).margin(1));
    texts.push_back(daemon.text);
  }
  CHECK((texts[0] == texts[1]));
}

TEST_CASE("a redial closes the line after its last bytes and comes on a new connection") {
  auto plan = short_way();
  plan.redial.surfacings = {1};
  Scene scene{plan, EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  daemon.come_to_life();
  REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
  CHECK(daemon.connections == 2);
}

TEST_CASE("half open, the older connection stays open while the new one speaks") {
  auto plan = short_way();
  plan.line.half_open.surfacings = {1};
  Scene scene{plan, EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  int ended = 0;
  std::vector<std::shared_ptr<world::Stream>> kept;
  daemon.on_adopt = [&](const std::shared_ptr<world::Stream>& s) { kept.push_back(s); };
  daemon.on_ended = [&] { ++ended; };
  int ended_at_the_redial = -1;
  daemon.on_bytes = [&](const std::string& bytes) {
    if (daemon.connections == 2 && bytes.find("Carrier Detect") != std::string::npos) ended_at_the_redial = ended;
  };
  daemon.come_to_life();
  REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
  CHECK(daemon.connections == 2);
  CHECK(ended_at_the_redial == 0);
}

TEST_CASE("a line that was dialled again begins with an empty line, and time waits until it is read") {
  auto plan = short_way();
  plan.redial.surfacings = {1};
  Scene scene{plan, EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  std::vector<std::pair<std::int64_t, std::string>> second;
  daemon.on_bytes = [&](const std::string& bytes) {
    if (daemon.connections == 2) second.emplace_back((daemon.clock->utc() - kStart).count(), bytes);
  };
  daemon.come_to_life();
  REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
  REQUIRE(second.size() > 2);
  // The link falls 60 + 45 + 15 + 20 s after the start, the glider calls again 45 s later.
  CHECK(second[0] == std::pair<std::int64_t, std::string>{140'000, "\r\n"});
  CHECK(second[1].first == 185'000);
}

TEST_CASE("a daemon that dials has its back-off timer fired before the glider goes on") {
  auto plan = short_way();
  plan.redial.surfacings = {1};
  Scene scene{plan, EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  const auto port = daemon.port();
  daemon.listener.reset();  // the port is the simulator's now, and the daemon dials
  std::function<void()> dial = [&] {
    scene.world.net.connect_tcp("127.0.0.1", port, [&](Expected<std::shared_ptr<world::Stream>, world::NetError> s) {
      REQUIRE(s);
      daemon.adopt(*s);
    });
  };
  daemon.on_ended = [&] { daemon.clock->call_at(daemon.clock->tick() + std::chrono::milliseconds{1200}, dial); };
  daemon.come_to_life(dial);
  REQUIRE(scene.run(scene.lockstep(), port, false) == RunOutcome::finished);
  CHECK(daemon.connections == 2);
  CHECK(daemon.text.find("RESUMING MISSION") != std::string::npos);
}

TEST_CASE("without a daemon the run gives up after its patience") {
  Scene scene;
  auto pace = scene.lockstep();
  pace.daemon_wait_s = 0.3;
  CHECK(scene.run(pace, 1) == RunOutcome::no_daemon);
  CHECK(scene.said.find("no daemon") != std::string::npos);
}

TEST_CASE("a daemon that never becomes idle is given up") {
  Scene scene;
  FakeDaemon daemon{scene.world, scene.socket()};
  daemon.come_to_life([&] { daemon.clock->set_busy(true); });
  auto pace = scene.lockstep();
  pace.daemon_wait_s = 0.3;
  CHECK(scene.run(pace, daemon.port()) == RunOutcome::no_daemon);
  CHECK(scene.said.find("does not become idle") != std::string::npos);
}

TEST_CASE("a daemon that was killed in mid-call comes back and hears the next reprint") {
  Scene scene{short_way(), EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  std::string second_life;
  daemon.on_bytes = [&](const std::string& bytes) {
    if (daemon.lives == 2) second_life += bytes;
    if (daemon.lives != 1 || !daemon.answers || bytes.find("at surface.") == std::string::npos) return;
    // Killed: nothing is answered any more, both sockets end, and a new life begins a little later.
    daemon.answers = false;
    scene.world.net.post([&] {
      daemon.stream->close();
      daemon.clock.reset();
      scene.world.clock.call_at(scene.world.clock.tick() + std::chrono::milliseconds{50}, [&] {
        daemon.answers = true;
        daemon.live([] {});
      });
    });
  };
  daemon.come_to_life();
  REQUIRE(scene.run(scene.lockstep(), daemon.port()) == RunOutcome::finished);
  CHECK(daemon.lives == 2);
  CHECK(second_life.find("Glider sim01 at surface.") == 0);
  CHECK(second_life.find("Carrier Detect") == std::string::npos);
}

TEST_CASE("with a pace the run takes wall time in proportion") {
  Scene scene{short_way(), EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  daemon.come_to_life();
  auto pace = scene.lockstep();
  pace.realtime = 2000;  // 960 s in 0.48 s
  const auto before = scene.world.clock.tick();
  REQUIRE(scene.run(pace, daemon.port()) == RunOutcome::finished);
  const auto took = std::chrono::duration<double>(scene.world.clock.tick() - before).count();
  CHECK(took > 0.45);  // never faster; how much slower depends on the machine
}

TEST_CASE("in wall time the lines are fed without any clock") {
  Scene scene{short_way(), EndPlan{true, 1, std::nullopt}};
  FakeDaemon daemon{scene.world, scene.socket()};
  REQUIRE(scene.run({"", 4000.0, false, 10}, daemon.port()) == RunOutcome::finished);
  CHECK(daemon.text.find("RESUMING MISSION") != std::string::npos);
}

TEST_CASE("alone, the gliders fly the lists that they started with") {
  Scene scene;
  std::vector<int> numbers;
  run_alone(*scene.sim, [&](const SurfacingRecord& r) { numbers.push_back(r.number); });
  CHECK(scene.sim->all_arrived());
  CHECK(numbers.size() == scene.sim->surfacings(0).size());
}
