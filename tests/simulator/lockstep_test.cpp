#include "simulator/lockstep.hpp"

#include <catch2/catch.hpp>

#include "daemon/world/real.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::ClockServer;
using simulator::Idle;
using simulator::idle_from;
using simulator::run_line;

TEST_CASE("an answer is read, and what is none is not") {
  CHECK(idle_from("idle 1000 none") == Idle{1000, std::nullopt});
  CHECK(idle_from("idle 1000 21000") == Idle{1000, 21000});
  for (const char* line : {"", "idle", "idle ", "idle 5", "idle 5 ", "idle x none", "idle 5 6 7", "busy 5 none",
                           "idle 5 none ", "idle 5.0 none"})
    CHECK_FALSE(idle_from(line));
}

TEST_CASE("time is told with the bytes of every line") {
  CHECK(run_line(Instant{std::chrono::milliseconds{1700000000123}}, 1000, {{"a", 0}, {"b", 4711}}) ==
        "run 1700000000123 1000 a=0 b=4711\n");
  CHECK(run_line(Instant{std::chrono::milliseconds{-5}}, 7, {}) == "run -5 7\n");
}

namespace {

/// A clock server and a fake daemon that is a bare socket, in one loop.
struct Scene {
  Scene()
      : world{real.world()},
        server{world.net,
               {[this] { on_connected(); }, [this] { ++lost; }, [this](const Idle& i) { on_idle(i); },
                [this](const std::string& l) {
                  nonsense = l;
                  world.net.stop();
                }}} {
    REQUIRE(server.listen(path()));
    // Nothing here takes a second; a hang must fail, not block.
    world.clock.call_at(world.clock.tick() + std::chrono::seconds{10}, [this] {
      timed_out = true;
      world.net.stop();
    });
  }
  std::string path() const { return (temp.path / "c").string(); }
  void dial(std::function<void(const std::string& line)> heard) {
    world.net.connect_unix(path(), [this, heard](Expected<std::shared_ptr<world::Stream>, world::NetError> s) {
      REQUIRE(s);
      daemon = *s;
      daemon->start({[this, heard](std::string_view bytes) {
                       text += bytes;
                       for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
                         const auto line = text.substr(0, end);
                         text.erase(0, end + 1);
                         heard(line);
                       }
                     },
                     [](std::string_view) {}});
    });
  }
  TempFolder temp;
  world::RealWorld real;
  world::World world;
  ClockServer server;
  std::shared_ptr<world::Stream> daemon;
  std::string text, nonsense;
  int connected{}, lost{};
  bool timed_out{};
  std::function<void()> on_connected = [this] { ++connected; };
  std::function<void(const Idle&)> on_idle = [](const Idle&) {};
};

}  // namespace

TEST_CASE("a daemon is greeted, told the time and heard") {
  Scene s;
  std::vector<std::string> lines;
  std::vector<Idle> answers;
  s.on_connected = [&] { s.server.run(Instant{std::chrono::seconds{1}}, 1000, {{"sim01", 0}}); };
  s.on_idle = [&](const Idle& idle) {
    answers.push_back(idle);
    if (answers.size() == 2) return s.world.net.stop();
    s.server.run(Instant{std::chrono::seconds{2}}, 2000, {{"sim01", 12}});
  };
  s.dial([&](const std::string& line) {
    lines.push_back(line);
    if (line == "run 1000 1000 sim01=0") {
      s.daemon->write("idle 1000 ");  // in two pieces: TCP splits where it likes
      s.daemon->write("1500\n");
    }
    if (line == "run 2000 2000 sim01=12") s.daemon->write("idle 2000 none\n");
  });
  s.world.net.run();
  REQUIRE_FALSE(s.timed_out);
  CHECK(lines == std::vector<std::string>{"glidersim-clock 1", "run 1000 1000 sim01=0", "run 2000 2000 sim01=12"});
  CHECK(answers == std::vector<Idle>{{1000, 1500}, {2000, std::nullopt}});
}

TEST_CASE("an answer to another time, or no answer at all, is nonsense") {
  for (const char* reply : {"idle 999 none\n", "hello\n"}) {
    Scene s;
    s.on_connected = [&] { s.server.run(Instant{}, 1000, {}); };
    s.dial([&](const std::string& line) {
      if (line.rfind("run", 0) == 0) s.daemon->write(reply);
    });
    s.world.net.run();
    CHECK_FALSE(s.timed_out);
    CHECK(s.nonsense + "\n" == reply);
  }
}

TEST_CASE("a daemon that comes back replaces the one that is gone") {
  Scene s;
  s.on_connected = [&] {
    if (++s.connected == 2) s.world.net.stop();
  };
  s.dial([&](const std::string&) {
    if (s.connected == 1) s.dial([](const std::string&) {});
  });
  s.world.net.run();
  CHECK_FALSE(s.timed_out);
  CHECK(s.connected == 2);
  CHECK(s.lost == 1);
}
