#include "daemon/ingest_client.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <utility>

#include "core/base/utc.hpp"
#include "tests/support/fields.hpp"

// The client against adapters that record what they are asked; the real child is run by tests/daemon/cli/field_test.cpp.

using namespace glidehelm;
using namespace glidehelm::daemon;
using End = world::ProcessResult::End;

namespace {

struct Bytes final : world::Mapping {
  explicit Bytes(std::string b) : held(std::move(b)) {}
  std::string held;
  std::span<const std::byte> bytes() const override { return std::as_bytes(std::span{held.data(), held.size()}); }
};

/// A disk of names and contents; only what the client uses does anything.
struct Disk final : world::Files {
  std::map<std::string, std::string> contents;
  std::map<std::string, std::vector<std::string>> globs;

  static world::FileError absent(const std::string& path) { return {"open", path, 2}; }

  struct Scratch final : world::Folder {
    Disk& disk;
    std::string where;
    Scratch(Disk& d, std::string w) : disk{d}, where{std::move(w)} {}
    const std::string& path() const override { return where; }
    world::FileResult<world::FileStat> stat_self() override { return world::FileStat{}; }
    world::FileResult<world::FileStat> stat(std::string_view) override { return world::FileStat{}; }
    world::FileResult<std::vector<std::string>> list() override {
      std::vector<std::string> names;
      for (const auto& [path, text] : disk.contents)
        if (path.compare(0, where.size() + 1, where + "/") == 0) names.push_back(path.substr(where.size() + 1));
      return names;
    }
    world::FileResult<std::string> read(std::string_view, std::size_t) override { return std::string{}; }
    world::FileResult<std::unique_ptr<world::OpenFile>> open(std::string_view name) override {
      return unexpected(absent(std::string{name}));
    }
    world::FileResult<world::FileStat> create(std::string_view, std::string_view, unsigned) override {
      return world::FileStat{};
    }
    world::FileResult<std::unique_ptr<world::AppendFile>> append_to(std::string_view name, bool) override {
      return unexpected(absent(std::string{name}));
    }
    world::FileResult<Done> truncate(std::string_view, std::uint64_t) override { return Done{}; }
    world::FileResult<Done> unlink(std::string_view name) override {
      disk.contents.erase(where + "/" + std::string{name});
      return Done{};
    }
    world::FileResult<Done> rename_new(std::string_view, world::Folder&, std::string_view) override { return Done{}; }
    world::FileResult<Done> exchange(std::string_view, world::Folder&, std::string_view) override { return Done{}; }
    world::FileResult<Done> rename_over(std::string_view, world::Folder&, std::string_view) override { return Done{}; }
    world::FileResult<Done> sync() override { return Done{}; }
    world::FileResult<std::unique_ptr<world::Lock>> lock(std::string_view name) override {
      return unexpected(absent(std::string{name}));
    }
  };

  world::FileResult<std::unique_ptr<world::Folder>> open_folder(const std::string& path) override {
    return std::unique_ptr<world::Folder>{std::make_unique<Scratch>(*this, path)};
  }
  world::FileResult<std::unique_ptr<world::Folder>> make_folder(const std::string& path, unsigned) override {
    return open_folder(path);
  }
  world::FileResult<std::string> read(const std::string& path, std::size_t) override {
    const auto found = contents.find(path);
    if (found == contents.end()) return unexpected(absent(path));
    return found->second;
  }
  world::FileResult<world::FileStat> stat(const std::string&) override { return world::FileStat{}; }
  world::FileResult<std::unique_ptr<world::Mapping>> map(const std::string& path) override {
    const auto found = contents.find(path);
    if (found == contents.end()) return unexpected(absent(path));
    return std::unique_ptr<world::Mapping>{std::make_unique<Bytes>(found->second)};
  }
  std::vector<std::string> glob(const std::string& pattern) override { return globs[pattern]; }
  std::string scratch() override { return "/scratch"; }
};

#if defined(GLIDEHELM_SANITIZED)
constexpr std::size_t kLimitOfMemory = 0;  // a sanitizer needs terabytes of address space
#else
constexpr std::size_t kLimitOfMemory = std::size_t{1} << 30;
#endif

/// A child that writes `grid` where it is told to, and ends as told.
struct Child final : world::Procs {
  Disk& disk;
  std::string grid;
  world::ProcessResult result{End::exited, 0, "", ""};
  world::ProcessRequest asked;
  std::function<void()> later;

  explicit Child(Disk& d) : disk{d} {}
  world::ProcessResult run_and_wait(const world::ProcessRequest& request) override {
    asked = request;
    if (!grid.empty()) disk.contents[request.arguments.at(1)] = grid;
    return result;
  }
  void run(world::ProcessRequest request, std::function<void(world::ProcessResult)> then) override {
    later = [this, request = std::move(request), then = std::move(then)] { then(run_and_wait(request)); };
  }
};

struct Loop final : world::Net {
  std::vector<std::function<void()>> posted;
  Expected<std::unique_ptr<world::Listener>, world::NetError> listen_tcp(const std::string&, std::uint16_t,
                                                                         Accepted) override {
    return unexpected(world::NetError{});
  }
  Expected<std::unique_ptr<world::Listener>, world::NetError> listen_unix(const std::string&, unsigned,
                                                                          Accepted) override {
    return unexpected(world::NetError{});
  }
  void connect_tcp(const std::string&, std::uint16_t, Connected) override {}
  void connect_unix(const std::string&, Connected) override {}
  void on_signal(int, std::function<void()>) override {}
  void post(std::function<void()> work) override { posted.push_back(std::move(work)); }
  void turn() {
    for (auto& work : std::exchange(posted, {})) work();
  }
  void run() override {}
  void stop() override {}
};

struct Counter final : world::Rng {
  std::uint64_t n{41};
  std::uint64_t next() override { return ++n; }
};
struct Still final : world::Clock {
  Instant utc() const override { return {}; }
  Tick tick() const override { return {}; }
  world::TimerId call_at(Tick, std::function<void()>) override { return 0; }
  void cancel(world::TimerId) override {}
  bool simulated() const override { return true; }
};

struct Desk {
  Disk disk;
  Child child{disk};
  Loop loop;
  Counter rng;
  Still clock;
  world::World world{clock, disk, loop, rng, child};
  Desk() {
    disk.globs = {{"/data/*.nc", {"/data/a.nc", "/data/b.nc"}}, {"/more/c.nc", {"/more/c.nc"}}};
    auto made = test::make_grid(test::flat_axes({0, 1}, {0, 1}), [](double, double, double, double) {
      return std::pair{0.1, 0.2};
    });
    child.grid = ocean::write_grid(made);
  }
};

}  // namespace

TEST_CASE("the child is told which files, where to write and how to read, and nothing stays in the scratch folder") {
  Desk desk;
  IngestOptions options;
  options.east = "uo";
  options.north = "vo";
  options.time_epoch = utc_from_text("2000-01-01");
  options.area = IngestOptions::Area{-10.5, 5, 30, 45};
  options.heights = "always";
  options.equator_band_deg = 2.5;
  options.fill_gaps_km = 12;
  options.deadline = Seconds{7};
  options.memory_at_most = 1 << 30;
  const auto loaded = ingest_files({"/data/*.nc", "/more/c.nc"}, options, desk.world);
  REQUIRE(loaded);
  CHECK(desk.child.asked.program == "glidehelm-ingest");
  CHECK(desk.child.asked.arguments ==
        std::vector<std::string>{"-o", "/scratch/glidehelm-42.grid", "--tell", "--variables", "uo,vo", "--time-epoch",
                                 "2000-01-01T00:00:00Z", "--heights", "always", "--equator-band", "2.5", "--fill-gaps",
                                 "12", "--area=-10.5/5/30/45", "--", "/data/a.nc", "/data/b.nc", "/more/c.nc"});
  CHECK(desk.child.asked.deadline == Seconds{7});
  CHECK(desk.child.asked.memory_at_most == kLimitOfMemory);
  CHECK(desk.child.asked.file_at_most == 1 << 30);
  CHECK(desk.child.asked.cpu_at_most_s == 120);
  CHECK(desk.child.asked.descriptors_at_most == 67);  // three files and 64 of its own
  CHECK(desk.child.asked.disposable);
  CHECK((*loaded)->files == std::vector<std::string>{"/data/a.nc", "/data/b.nc", "/more/c.nc"});
  CHECK((*loaded)->view.axes.lats_deg == std::vector<double>{0, 1});
  CHECK((*loaded)->view.values[0] == 0.1F);  // still mapped, though the name is gone
  CHECK(desk.disk.contents.empty());
}

TEST_CASE("a model's grid is given as one, whether the pattern matches it too or not, and its options with it") {
  Desk desk;
  IngestOptions options;
  options.grid_file = "/data/b.nc";
  options.rotation = "grid";
  options.s_levels = "vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50";
  const auto loaded = ingest_files({"/data/*.nc", "/more/c.nc"}, options, desk.world);
  REQUIRE(loaded);
  CHECK(desk.child.asked.arguments ==
        std::vector<std::string>{"-o", "/scratch/glidehelm-42.grid", "--tell", "--rotation", "grid", "--s-levels",
                                 "vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50", "--grid-file", "/data/b.nc",
                                 "--", "/data/a.nc", "/more/c.nc"});
  CHECK((*loaded)->files == std::vector<std::string>{"/data/a.nc", "/more/c.nc", "/data/b.nc"});
  auto plain = options;
  plain.rotation.clear();
  CHECK(recipe_of(options) != recipe_of(plain));
  auto other = options;
  other.member = 3;
  CHECK(recipe_of(other) == recipe_of(options) + "\n--member\n3");
}

TEST_CASE("a refusal of the child is passed on without its name, its warnings left out") {
  Desk desk;
  desk.child.grid.clear();
  desk.child.result = {End::exited, 1, "",
                       "glidehelm-ingest: warning: a.nc: slow\nglidehelm-ingest: /data/a.nc: truncated\n"};
  CHECK(ingest_files({"/data/*.nc"}, {}, desk.world).error() == "/data/a.nc: truncated");
}

TEST_CASE("a child that dies, hangs, floods or does not start is named with what it was reading") {
  Desk desk;
  desk.child.grid.clear();
  const auto message = [&](End end, int code, const std::string& told = "") {
    desk.child.result = {end, code, told, ""};
    return ingest_files({"/data/*.nc"}, {}, desk.world).error();
  };
  CHECK(message(End::signalled, 11) ==
        "/data/a.nc and 1 more: glidehelm-ingest died of signal 11 (Segmentation fault) while reading it");
  CHECK(message(End::signalled, 11, "reading 0\nreading 1\n") ==
        "/data/b.nc: glidehelm-ingest died of signal 11 (Segmentation fault) while reading it");
  CHECK(message(End::signalled, 24, "reading 1\njoining\n") ==
        "/data/a.nc and 1 more: glidehelm-ingest used more CPU time than it may while reading it");
  CHECK(message(End::deadline, 9) == "/data/a.nc and 1 more: glidehelm-ingest took longer than 300 s and was stopped");
  CHECK(message(End::output_too_long, 0) ==
        "/data/a.nc and 1 more: glidehelm-ingest complained without end while reading it");
  CHECK(message(End::not_started, 2) == "glidehelm-ingest cannot be started (error 2)");
  CHECK(message(End::exited, 9) == "/data/a.nc and 1 more: glidehelm-ingest ended with code 9");
  if (kLimitOfMemory != 0)
    CHECK(message(End::exited, 3, "reading 0\n") ==
          "/data/a.nc: reading it needs more than the 8192 MiB of memory that are allowed; cut it to the area, times "
          "and depths of the mission");
}

TEST_CASE("what a killed child left behind is taken away") {
  Desk desk;
  desk.child.grid.clear();
  desk.child.result = {End::signalled, 9, "", ""};
  desk.disk.contents = {{"/scratch/.glidehelm-42.grid.777", "half"}, {"/scratch/somebody-elses", "file"}};
  CHECK_FALSE(ingest_files({"/data/*.nc"}, {}, desk.world));
  CHECK(desk.disk.contents.size() == 1);
  CHECK(desk.disk.contents.count("/scratch/somebody-elses") == 1);
}

TEST_CASE("a grid is not believed because a child ended well") {
  Desk desk;
  desk.child.grid[desk.child.grid.size() - 3] ^= 1;
  CHECK(ingest_files({"/data/*.nc"}, {}, desk.world).error() ==
        "the grid made of /data/a.nc is not sound, payload: the checksum is wrong");
  desk.child.grid.clear();
  CHECK_FALSE(ingest_files({"/data/*.nc"}, {}, desk.world));  // ended well and wrote nothing
}

TEST_CASE("a pattern without files is an error that names it, and no child is started") {
  Desk desk;
  CHECK(ingest_files({"/data/*.nc", "/none/*.nc"}, {}, desk.world).error() == "no file matches /none/*.nc");
  CHECK(ingest_files({}, {}, desk.world).error() == "no forecast file was named");
  CHECK(desk.child.asked.program.empty());
}

TEST_CASE("the daemon's variant answers from the loop, good or bad") {
  Desk desk;
  std::optional<bool> good;
  ingest_files_async({"/data/*.nc"}, {}, desk.world, [&](IngestOutcome result) { good = result.has_value(); });
  CHECK_FALSE(good);
  desk.child.later();
  CHECK_FALSE(good);
  desk.loop.turn();
  CHECK(good == true);
  CHECK(desk.disk.contents.empty());

  good.reset();
  ingest_files_async({"/none"}, {}, desk.world, [&](IngestOutcome result) { good = result.has_value(); });
  CHECK_FALSE(good);
  REQUIRE(desk.loop.posted.size() == 1);
  desk.loop.turn();
  CHECK(good == false);
}

TEST_CASE("a name with a scheme is no pattern of this machine: it goes to the child as it is") {
  Desk desk;
  REQUIRE(ingest_files({"https://example.org/dodsC/sea"}, {}, desk.world));
  CHECK(desk.child.asked.arguments.back() == "https://example.org/dodsC/sea");
}

TEST_CASE("the story of a child is read as far as it is one") {
  const auto hash = Sha256::of(std::string_view{"a"});
  const auto line = "source 0 " + hash.hex() + " 7 8 9 1700000000000000001 1700000000000000002\n";
  const auto story = read_story(line + "source 1 nonsense 1 2 3 4 5\nreading 0\nreading x\nsou");
  REQUIRE(story.sources.size() == 1);
  CHECK(story.sources[0].content == hash);
  CHECK(story.sources[0].identity == FileIdentity{7, 8, 9, 1'700'000'000'000'000'001, 1'700'000'000'000'000'002});
  CHECK(story.at == std::size_t{0});
  CHECK_FALSE(story.copying);
  CHECK(read_story("copying 3\n").copying);
  CHECK(read_story("copying 3\n").at == std::size_t{3});
  CHECK_FALSE(read_story("reading 3\njoining\n").at);
  CHECK(read_story("").sources.empty());
}
