#include "daemon/forecast_watch.hpp"

#include <catch2/catch.hpp>
#include <csignal>

#include "core/base/utc.hpp"
#include "tests/support/forecast_shelf.hpp"

using namespace glidehelm;
using namespace glidehelm::daemon;
using glidehelm::test::ForecastShelf;

namespace {

mission::Mission mission_of(std::vector<std::string> patterns) {
  mission::Mission m;
  m.name = "leg";
  m.glider = "sim01";
  m.goal = geo_point(28.5, -15.5);
  m.currents.files = std::move(patterns);
  return m;
}

/// A watch over /data/*.nc, and everything that it said.
struct WatchPost {
  test::ManualWorld world;
  ForecastShelf shelf{world};
  std::vector<std::string> loaded, refused, noted;
  int settled{};
  std::unique_ptr<ForecastWatch> watch;
  mission::Mission mission{mission_of({"/data/*.nc"})};

  WatchPost() {
    world.files.make_folder_at("/state");
    start();
  }
  /// A daemon that starts anew over the same disk.
  void start() {
    watch = std::make_unique<ForecastWatch>(
        world.world(), "/state/grids",
        ForecastWatch::Handlers{
            [this](const std::shared_ptr<const OceanSource>& ocean) { loaded.push_back(ocean->forecast.facts().name); },
            [this](const std::string& problem) { refused.push_back(problem); },
            [this](const std::string& note) { noted.push_back(note); }, [this] { ++settled; }});
  }
  void follow() {
    watch->follow(mission);
    world.net.settle();
  }
  void look() {
    watch->look();
    world.net.settle();
  }
  [[nodiscard]] double now_s() const { return epoch_seconds(world.clock.utc()); }
  /// A run of `hours_ago`, whose times begin then.
  [[nodiscard]] ForecastShelf::Says run(double east, double hours_ago, int hours = 96) const {
    return {east, now_s() - 3600 * hours_ago, now_s() - 3600 * hours_ago, hours};
  }
  /// The current that is in use now.
  [[nodiscard]] double east() const { return east_of(*watch->current()); }
  [[nodiscard]] double east_of(const OceanSource& ocean) const {
    const auto sample = ocean.forecast.ocean().dive.sample(geo_point(28.5, -15.5), now_s());
    return sample ? sample->current.east.si() : std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace

TEST_CASE("a new cycle is swapped in as a whole, and who holds the old one keeps it") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.125);
  const auto plan = post.watch->current();  // a running plan
  post.shelf.publish("b.nc", post.run(0.5, 1));
  post.watch->look();
  CHECK(post.watch->loading());
  CHECK(post.watch->current() == plan);  // until the new one is whole
  post.world.net.settle();
  CHECK(post.east() == 0.5);
  CHECK(post.east_of(*plan) == 0.125);
  CHECK(post.loaded == std::vector<std::string>{"a.nc", "b.nc"});
  CHECK(post.refused.empty());
  CHECK(post.settled == 2);
}

TEST_CASE("the files that a running plan's verifier opens stay, and go when nobody holds them") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  REQUIRE(post.watch->current()->grid);
  const auto path = post.watch->current()->grid->path;
  CHECK(post.world.files.get(path));
  CHECK(path.rfind("/state/grids/", 0) == 0);
}

TEST_CASE("a bad newer file does not replace a good older one: it is said once, and not read again") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  const auto before = post.watch->current();
  post.shelf.publish_bad("b.nc", "truncated: the file has 10 bytes, its header needs 20");
  post.look();
  CHECK(post.watch->current() == before);
  CHECK(post.refused == std::vector<std::string>{"/data/b.nc: truncated: the file has 10 bytes, its header needs 20"});
  CHECK(post.watch->problem() == post.refused[0]);
  const auto children = post.shelf.children();
  for (int i = 0; i < 50; ++i) {
    post.world.pass(Seconds{60});
    post.look();
  }
  CHECK(post.shelf.children() == children);
  CHECK(post.refused.size() == 1);
  CHECK(post.loaded.size() == 1);
}

TEST_CASE("a refused file that is touched, copied or named anew is known by its content, a corrected one is read") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.shelf.publish_bad("b.nc", "every value is missing");
  post.follow();
  const auto parsed = [&] {
    // Children that got as far as reading the bad file's content.
    std::size_t count = 0;
    for (const auto& request : post.world.procs.requests)
      count += static_cast<std::size_t>(std::count(request.arguments.begin(), request.arguments.end(), "/data/b.nc"));
    return count;
  };
  REQUIRE(parsed() == 1);
  post.shelf.publish_bad("b.nc", "every value is missing");  // another inode, the same bytes
  post.look();
  // A child saw that the content is known; it did not read it as NetCDF, and the reason is the remembered one.
  CHECK(parsed() == 2);
  CHECK(post.world.procs.requests[post.world.procs.requests.size() - 1].input.size() == 65);
  CHECK(post.watch->problem() == "/data/b.nc: every value is missing");
  post.shelf.publish("b.nc", post.run(0.5, 1));
  post.look();
  CHECK(post.east() == 0.5);
  CHECK(post.watch->problem().empty());
}

TEST_CASE("a file that kills its reader is refused like another, and named") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.shelf.publish_deadly("b.nc", SIGSEGV);
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.125);
  CHECK(post.refused == std::vector<std::string>{
                            "/data/b.nc: glidehelm-ingest died of signal 11 (Segmentation fault) while reading it"});
  const auto children = post.shelf.children();
  post.start();  // also the next daemon does not let it kill a child again
  post.follow();
  CHECK(post.shelf.children() == children);
  CHECK(post.east() == 0.125);
}

TEST_CASE("the same files need no child after a restart") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  CHECK(post.shelf.children() == 1);
  post.start();
  post.follow();
  CHECK(post.shelf.children() == 1);
  CHECK(post.east() == 0.125);
  CHECK(post.loaded.size() == 2);
}

TEST_CASE("a grid that rotted in the cache is made again, and that is said") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  const auto path = post.watch->current()->grid->path;
  post.start();
  post.world.files.rot(path, [](std::string& bytes) { bytes.back() = static_cast<char>(bytes.back() ^ 1); });
  post.follow();
  CHECK(post.shelf.children() == 2);
  CHECK(post.east() == 0.125);
  REQUIRE(post.noted.size() == 1);
  CHECK(post.noted[0].find("a cached grid was damaged and is made anew (payload: ") == 0);
}

TEST_CASE("after a restart among bad files the last accepted forecast is in use again") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  post.shelf.publish_bad("a.nc", "replaced by an HTML page");
  post.start();
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.125);
  CHECK(post.refused == std::vector<std::string>{"/data/a.nc: replaced by an HTML page"});
  CHECK(post.watch->in_use().find(", 12.0 h old") != std::string::npos);
  post.world.pass(Seconds{5400});
  CHECK(post.watch->in_use().find(", 13.5 h old") != std::string::npos);
}

TEST_CASE("a set with a missing piece is not used, and says where the hole is") {
  WatchPost post;
  const double begin = post.now_s() - 36 * 3600;
  for (int day = 0; day < 4; ++day)
    post.shelf.publish("day" + std::to_string(day) + ".nc", {0.125, begin, begin + day * 86400.0, 24});
  post.follow();
  const auto before = post.watch->current();
  REQUIRE(before);
  // Day 2 becomes unreadable: without it there is nothing for a day and an hour.
  post.shelf.publish_bad("day2.nc", "truncated");
  post.look();
  CHECK(post.watch->current() == before);
  REQUIRE(post.refused.size() == 1);
  const auto at = [&](double hours) { return utc_text(instant_at(begin + hours * 3600)); };
  CHECK(post.refused[0] ==
        "/data/day2.nc: truncated (the others have nothing between " + at(47) + " and " + at(72) + ")");
  // The same at a start, with nothing accepted before: no forecast rather than one with a hole.
  WatchPost fresh;
  for (int day = 0; day < 4; ++day)
    fresh.shelf.publish("day" + std::to_string(day) + ".nc", {0.125, begin, begin + day * 86400.0, 24});
  fresh.shelf.publish_bad("day2.nc", "truncated");
  fresh.follow();
  CHECK_FALSE(fresh.watch->current());
  CHECK(fresh.refused.size() == 1);
}

TEST_CASE("what is left of a set is used when it is whole and later, never when it would take us back") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 24));
  post.shelf.publish("b.nc", post.run(0.25, 12));
  post.follow();
  CHECK(post.east() == 0.25);
  post.shelf.publish_bad("b.nc", "half of it is gone");  // only the older run is left
  post.look();
  CHECK(post.east() == 0.25);
  CHECK(post.refused.size() == 1);
  post.shelf.publish("c.nc", post.run(0.5, 1));  // a later run beside the bad file
  post.look();
  CHECK(post.east() == 0.5);
  CHECK(post.refused.size() == 2);
  CHECK(post.refused[1] == "/data/b.nc: half of it is gone");
  CHECK(post.watch->current()->left_out.size() == 1);
}

TEST_CASE("a file that is still being written is tried again after a while, and at once when it changed") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.shelf.publish_growing("b.nc", "10 bytes");
  post.follow();
  CHECK(post.east() == 0.125);
  const auto children = post.shelf.children();
  post.world.pass(Seconds{599});
  post.look();
  CHECK(post.shelf.children() == children);
  post.world.pass(Seconds{2});
  post.look();
  CHECK(post.shelf.children() == children + 1);  // that the rest of the set is known needs no child
  CHECK(post.refused.size() == 1);
  post.shelf.publish("b.nc", post.run(0.5, 1));
  post.look();
  CHECK(post.east() == 0.5);
}

TEST_CASE("a child that cannot be started or is killed by the system says nothing about the file") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.world.procs.script("glidehelm-ingest", {world::ProcessResult::End::not_started, EAGAIN, "", ""});
  post.follow();
  CHECK_FALSE(post.watch->current());
  CHECK(post.refused == std::vector<std::string>{"glidehelm-ingest cannot be started (error 11)"});
  post.world.procs.script("glidehelm-ingest", {world::ProcessResult::End::signalled, SIGKILL, "reading 0\n", ""});
  post.world.pass(Seconds{601});
  post.look();
  CHECK_FALSE(post.watch->current());
  post.world.procs.script("glidehelm-ingest", {world::ProcessResult::End::deadline, 0, "reading 0\n", ""});
  post.world.pass(Seconds{601});
  post.look();
  CHECK_FALSE(post.watch->current());
  post.world.pass(Seconds{601});
  post.look();
  CHECK(post.east() == 0.125);
}

TEST_CASE("a forecast of another time is refused: long expired, or far in the future") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12 + 96, 24));  // ended 85 h ago
  post.follow();
  CHECK_FALSE(post.watch->current());
  REQUIRE(post.refused.size() == 1);
  CHECK(post.refused[0].find(" has expired: its last field is of ") != std::string::npos);
  CHECK(post.refused[0].find(", 85.0 h ago; allowed are 72 h") != std::string::npos);
  post.shelf.take("a.nc");
  post.shelf.publish("b.nc", post.run(0.125, -30));
  post.look();
  CHECK_FALSE(post.watch->current());
  CHECK(post.refused.back().find(" lies in the future: its first field is of ") != std::string::npos);
  CHECK(post.refused.back().find(", in 30.0 h; allowed are 24 h") != std::string::npos);
  post.world.pass(Seconds{6.2 * 3600});
  post.look();  // its time has come
  REQUIRE(post.watch->current());
  CHECK(post.watch->in_use().find(", begins in 23.8 h") != std::string::npos);
}

TEST_CASE("files that are not there yet are waited for") {
  WatchPost post;
  post.follow();
  CHECK(post.refused == std::vector<std::string>{"no file matches /data/*.nc"});
  CHECK(post.settled == 1);
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.look();
  CHECK(post.east() == 0.125);
}

TEST_CASE("a plan waits for a load only when it has nothing, or when time stands still") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.watch->follow(post.mission);
  CHECK(post.watch->holds_up());
  post.world.net.settle();
  CHECK_FALSE(post.watch->holds_up());
  post.shelf.publish("b.nc", post.run(0.5, 1));
  post.watch->look();
  CHECK(post.watch->loading());
  CHECK_FALSE(post.watch->holds_up());
  post.world.clock.be_simulated();
  CHECK(post.watch->holds_up());
}

TEST_CASE("a file must have been left alone for ten seconds, but a simulated clock cannot wait") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 12));
  post.follow();
  const auto& asked = post.world.procs.requests.back().arguments;
  const auto settle = std::find(asked.begin(), asked.end(), "--settle");
  REQUIRE(settle != asked.end());
  CHECK(*(settle + 1) == "10");
  post.world.clock.be_simulated();
  post.start();
  post.shelf.publish("b.nc", post.run(0.5, 1));
  post.follow();
  const auto& then = post.world.procs.requests.back().arguments;
  CHECK(std::find(then.begin(), then.end(), "--settle") == then.end());
}

TEST_CASE("an address shows nothing from outside: it is asked anew when an hour has begun") {
  WatchPost post;
  const std::string address = "http://server/sea";
  post.world.files.make_folder_at("http://server");
  const auto serve = [&](double east) {
    std::ostringstream text;
    text.precision(17);
    text << "good " << east << " " << post.now_s() << " " << post.now_s() - 3600 << " 96";
    post.world.files.put(address, text.str());
  };
  serve(0.125);
  post.mission = mission_of({address});
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.125);
  const auto children = post.shelf.children();
  serve(0.5);
  post.look();
  CHECK(post.shelf.children() == children);
  for (int i = 0; i < 61; ++i) {
    post.world.pass(Seconds{60});
    post.look();
  }
  CHECK(post.shelf.children() == children + 1);
  CHECK(post.east() == 0.5);
}

namespace {

/// A watch of currents by formula.
struct Lookout {
  test::ManualWorld world;
  std::vector<std::string> story;
  std::unique_ptr<daemon::ForecastWatch> watch;

  Lookout() {
    for (const char* folder : {"/forecasts", "/grids"}) world.files.make_folder_at(folder);
    watch = std::make_unique<daemon::ForecastWatch>(
        world.world(), "/grids",
        daemon::ForecastWatch::Handlers{[this](const std::shared_ptr<const daemon::OceanSource>& ocean) {
                                          story.push_back("loaded " + name(*ocean));
                                        },
                                        [this](const std::string& problem) { story.push_back("refused " + problem); }});
  }
  static std::string name(const daemon::OceanSource& ocean) {
    return ocean.analytic.empty() ? "files" : ocean.analytic[0].kind;
  }
  void settle() { world.net.settle(); }
};

mission::Mission by_formula(double east = 0.1) {
  mission::Mission m;
  m.goal = geo_point(29.1667, -15.5);
  ocean::AnalyticSpec spec;
  spec.kind = "constant";
  spec.origin = geo_point(28, -15);
  spec.length_scale = Metres{1};
  spec.speed_scale = MetresPerSecond{1};
  spec.params = {{"u", east}, {"v", 0}};
  m.currents.analytic = {spec};
  return m;
}

}  // namespace

TEST_CASE("a formula is loaded once, from the loop, and looking again changes nothing") {
  Lookout lookout;
  lookout.watch->follow(by_formula());
  CHECK(lookout.watch->loading());
  CHECK(lookout.story.empty());
  lookout.settle();
  CHECK_FALSE(lookout.watch->loading());
  REQUIRE(lookout.watch->current());
  lookout.watch->look();
  lookout.watch->follow(by_formula());
  lookout.settle();
  CHECK(lookout.story == std::vector<std::string>{"loaded constant"});
}

TEST_CASE("other currents are loaded anew, and a plan that runs keeps the forecast that it began with") {
  Lookout lookout;
  lookout.watch->follow(by_formula(0.1));
  lookout.settle();
  const auto in_use = lookout.watch->current();
  lookout.watch->follow(by_formula(0.2));
  CHECK_FALSE(lookout.watch->current());  // nothing is planned on the currents of another mission
  lookout.settle();
  REQUIRE(lookout.watch->current());
  CHECK(lookout.watch->current() != in_use);
  CHECK(in_use->analytic[0].params.at(0).second == 0.1);
  CHECK(lookout.watch->current()->analytic[0].params.at(0).second == 0.2);
}

TEST_CASE("what was being loaded for a mission that is no longer followed is dropped") {
  Lookout lookout;
  lookout.watch->follow(by_formula(0.1));
  lookout.watch->follow(by_formula(0.2));
  lookout.settle();
  CHECK(lookout.story.size() == 1);
  REQUIRE(lookout.watch->current());
  CHECK(lookout.watch->current()->analytic[0].params.at(0).second == 0.2);
}

TEST_CASE("a watch that is gone is not called any more") {
  Lookout lookout;
  lookout.watch->follow(by_formula());
  lookout.watch.reset();
  lookout.settle();
  CHECK(lookout.story.empty());
}

TEST_CASE("a forecast in use grows old after 36 hours and is not to be planned on after 72, until a newer one comes") {
  WatchPost post;
  post.shelf.publish("a.nc", post.run(0.125, 0, 200));  // reaches 200 h: it is its age that counts
  post.follow();
  REQUIRE(post.watch->current());
  CHECK_FALSE(post.watch->old());
  post.world.pass(Seconds{36 * 3600.0 + 60});
  CHECK(post.watch->old());
  CHECK_FALSE(post.watch->expired());
  post.world.pass(Seconds{36 * 3600.0});
  REQUIRE(post.watch->expired());
  CHECK(post.watch->expired()->find(" is 72.0 h old; planned on are at most 72 h") != std::string::npos);
  post.shelf.publish("b.nc", post.run(0.25, 1, 200));
  post.look();
  CHECK_FALSE(post.watch->expired());
  CHECK(post.east() == 0.25);
}

TEST_CASE("a tide that comes again does not age") {
  WatchPost post;
  post.mission.currents.outside_time = ocean::OutsideTime::cycle;
  post.shelf.publish("a.nc", post.run(0.125, 0));
  post.follow();
  post.world.pass(Seconds{30 * 86400.0});
  CHECK_FALSE(post.watch->old());
  CHECK_FALSE(post.watch->expired());
}

namespace {

/// Two sources over one area: "bay" is trusted more than "globe".
mission::Mission two_sources() {
  auto m = mission_of({});
  for (const char* name : {"bay", "globe"}) {
    mission::CurrentSource source;
    source.name = name;
    source.files = {std::string{"/data/"} + name + "*.nc"};
    m.currents.sources.push_back(source);
  }
  return m;
}

}  // namespace

TEST_CASE("of several sources the most trusted answers, and the request of a verifier names every grid") {
  WatchPost post;
  post.mission = two_sources();
  // Begun long enough ago that the join at the begin of the newer one, 6 h, is over.
  post.shelf.publish("bay1.nc", post.run(0.125, 12));
  post.shelf.publish("globe1.nc", post.run(0.25, 13, 200));
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.125);
  verify::VerifyRequest request;
  put_ocean(*post.watch->current(), request);
  CHECK_FALSE(request.grid);
  REQUIRE(request.sources.size() == 2);
  CHECK(request.sources[0].name == "bay");
  CHECK(request.sources[0].grid.path != request.sources[1].grid.path);
  CHECK(post.watch->current()->forecast.facts().sources == std::vector<std::string>{"bay", "globe"});
  CHECK(post.watch->in_use().find("bay1.nc over globe1.nc") == 0);
  // Beyond the end of the trusted source, 83 h from now, the other one goes on.
  post.world.pass(Seconds{100 * 3600.0});
  CHECK(post.east() == 0.25);
}

TEST_CASE("a source that cannot be read is told, the others go on, and its last good grid stays in use") {
  WatchPost post;
  post.mission = two_sources();
  post.shelf.publish_bad("bay1.nc", "nonsense");
  post.shelf.publish("globe1.nc", post.run(0.25, 20));
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.25);
  REQUIRE(post.refused.size() == 1);
  CHECK(post.refused[0].find("source 'bay': ") == 0);
  post.shelf.take("bay1.nc");
  post.shelf.publish("bay2.nc", post.run(0.125, 12));
  post.look();
  CHECK(post.east() == 0.125);
  CHECK(post.watch->problem().empty());
  post.shelf.publish_bad("bay2.nc", "nonsense");  // replaced by something bad
  post.look();
  CHECK(post.east() == 0.125);
  CHECK(post.watch->problem().find("source 'bay': ") == 0);
  post.start();  // a daemon that starts anew
  post.follow();
  REQUIRE(post.watch->current());
  CHECK(post.east() == 0.125);
}

TEST_CASE("a source that has expired is left out while another one remains, and not before") {
  WatchPost post;
  post.mission = two_sources();
  post.shelf.publish("bay1.nc", post.run(0.125, 0, 300));
  post.shelf.publish("globe1.nc", post.run(0.25, 0, 300));
  post.follow();
  CHECK(post.east() == 0.125);
  post.world.pass(Seconds{48 * 3600.0});
  post.shelf.publish("globe2.nc", post.run(0.375, 0, 300));
  post.look();
  CHECK(post.east() == 0.125);
  post.world.pass(Seconds{24.1 * 3600.0});
  REQUIRE(post.watch->expired());
  post.look();
  CHECK_FALSE(post.watch->expired());
  CHECK(post.east() == 0.375);
  REQUIRE_FALSE(post.noted.empty());
  CHECK(post.noted.back().find("source 'bay' is left out: it is 72.1 h old, allowed are 72 h") == 0);
  post.world.pass(Seconds{60 * 3600.0});  // now the other one, too: both are kept, and nothing is planned
  post.look();
  CHECK(post.watch->expired());
}
