#include "daemon/cli/check.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

using namespace glidehelm;
using nlohmann::json;

namespace {

/// Files that exist only in the test. `check` may read and match patterns, and nothing else: the rest throws.
class ReadOnlyFiles final : public world::Files {
 public:
  std::map<std::string, std::string> files;

  world::FileResult<std::string> read(const std::string& path, std::size_t at_most) override {
    const auto found = files.find(path);
    if (found == files.end()) return unexpected(world::FileError{"open", path, ENOENT});
    if (found->second.size() > at_most) return unexpected(world::FileError{"read", path, EFBIG});
    return found->second;
  }
  std::vector<std::string> glob(const std::string& pattern) override {
    std::vector<std::string> found;
    const auto star = pattern.find('*');
    for (const auto& [path, text] : files)
      if (star == std::string::npos ? path == pattern : path.rfind(pattern.substr(0, star), 0) == 0)
        found.push_back(path);
    return found;
  }
  world::FileResult<std::unique_ptr<world::Folder>> open_folder(const std::string&) override {
    throw std::logic_error{"open_folder"};
  }
  world::FileResult<std::unique_ptr<world::Folder>> make_folder(const std::string&, unsigned) override {
    throw std::logic_error{"make_folder"};
  }
  world::FileResult<world::FileStat> stat(const std::string&) override { throw std::logic_error{"stat"}; }
  world::FileResult<std::unique_ptr<world::Mapping>> map(const std::string&) override { throw std::logic_error{"map"}; }
  std::string scratch() override { throw std::logic_error{"scratch"}; }
};

class NoClock final : public world::Clock {
 public:
  Instant utc() const override { throw std::logic_error{"utc"}; }
  Tick tick() const override { throw std::logic_error{"tick"}; }
  world::TimerId call_at(Tick, std::function<void()>) override { throw std::logic_error{"call_at"}; }
  void cancel(world::TimerId) override { throw std::logic_error{"cancel"}; }
  bool simulated() const override { return false; }
};

class NoNet final : public world::Net {
 public:
  Expected<std::unique_ptr<world::Listener>, world::NetError> listen_tcp(const std::string&, std::uint16_t,
                                                                         Accepted) override {
    throw std::logic_error{"listen"};
  }
  Expected<std::unique_ptr<world::Listener>, world::NetError> listen_unix(const std::string&, unsigned,
                                                                          Accepted) override {
    throw std::logic_error{"listen"};
  }
  void connect_tcp(const std::string&, std::uint16_t, Connected) override { throw std::logic_error{"connect"}; }
  void connect_unix(const std::string&, Connected) override { throw std::logic_error{"connect"}; }
  void on_signal(int, std::function<void()>) override { throw std::logic_error{"on_signal"}; }
  void post(std::function<void()>) override { throw std::logic_error{"post"}; }
  void run() override { throw std::logic_error{"run"}; }
  void stop() override { throw std::logic_error{"stop"}; }
};

class NoRng final : public world::Rng {
 public:
  std::uint64_t next() override { throw std::logic_error{"next"}; }
};

class NoProcs final : public world::Procs {
 public:
  void run(world::ProcessRequest, std::function<void(world::ProcessResult)>) override { throw std::logic_error{"run"}; }
  world::ProcessResult run_and_wait(const world::ProcessRequest&) override { throw std::logic_error{"run_and_wait"}; }
};

struct Outcome {
  int code{};
  std::string out, err;
};

Outcome check(const std::map<std::string, std::string>& files, const cli::CheckOptions& options) {
  ReadOnlyFiles on_disk;
  on_disk.files = files;
  NoClock clock;
  NoNet net;
  NoRng rng;
  NoProcs procs;
  world::World world{clock, on_disk, net, rng, procs};
  std::ostringstream out, err;
  const int code = cli::run_check(options, world, out, err);
  return {code, out.str(), err.str()};
}

cli::CheckOptions options(std::vector<std::string> files, bool effective = false, bool json = false) {
  cli::CheckOptions result;
  result.files = std::move(files);
  result.effective = effective;
  result.json = json;
  return result;
}

std::string mission(const std::string& name, const std::string& glider, const std::string& more = {}) {
  return "schema: glidehelm/mission/v1\nname: " + name + "\nglider: " + glider +
         "\ngoal: {lat_deg: 29, lon_deg: -15}\ncurrents: {files: [c.nc]}\n" + more;
}
const char* const kDaemon =
    "schema: glidehelm/daemon/v1\nmissions: [m/*]\ngliders:\n"
    "  - {name: sim01, line: {listen: \"127.0.0.1:6500\"}, to_glider: /g/sim01}\n";

}  // namespace

TEST_CASE("a right mission gives one line and exit code 0") {
  const auto r = check({{"m.yaml", mission("leg-1", "sim01")}}, options({"m.yaml"}));
  CHECK(r.code == 0);
  CHECK(r.out == "m.yaml: mission leg-1 for glider sim01 is right\n");
  CHECK(r.err.empty());
}

TEST_CASE("every error of every file goes to stderr and the exit code is 1") {
  const auto r = check({{"a.yaml", mission("leg-1", "sim01", "planning: {headigns: 18}\nlist: {slot: 100}\n")},
                        {"b.yaml", mission("leg-2", "sim01")}},
                       options({"a.yaml", "b.yaml", "c.yaml"}));
  CHECK(r.code == 1);
  CHECK(r.out == "b.yaml: mission leg-2 for glider sim01 is right\n");
  CHECK(r.err.rfind("a.yaml:6:12: planning.headigns: unknown key; did you mean headings?\n"
                    "a.yaml:7:14: list.slot: out of range; found 100; allowed: 0 to 99\n"
                    "c.yaml: cannot be read: ",
                    0) == 0);
}

TEST_CASE("without a file the exit code is 2") {
  const auto r = check({}, options({}));
  CHECK(r.code == 2);
  CHECK(r.out.empty());
  CHECK_FALSE(r.err.empty());
}

TEST_CASE("check --effective prints every value with its origin") {
  const auto r = check({{"m.yaml", mission("leg-1", "sim01", "list: {slot: 11}\n")}}, options({"m.yaml"}, true));
  CHECK(r.code == 0);
  CHECK(r.out.find("  slot: 11 ") != std::string::npos);
  CHECK(r.out.find("# m.yaml:6\n") != std::string::npos);
  CHECK(r.out.find("# default\n") != std::string::npos);
  const auto again = check({{"m.yaml", r.out}}, options({"m.yaml"}));
  CHECK(again.code == 0);
}

TEST_CASE("check --json has the contract's form, with places and keys") {
  const auto r = check(
      {{"a.yaml", mission("leg-1", "sim01", "planning: {headigns: 18}\n")}, {"b.yaml", mission("leg-2", "sim01")}},
      options({"a.yaml", "b.yaml", "c.yaml"}, false, true));
  CHECK(r.code == 1);
  CHECK(r.err.empty());
  const auto document = json::parse(r.out);
  REQUIRE(document.at("files").size() == 3);
  CHECK(document["files"][0] == json{{"file", "a.yaml"},
                                     {"kind", "mission"},
                                     {"valid", false},
                                     {"problems",
                                      {{{"line", 6},
                                        {"column", 12},
                                        {"key", "planning.headigns"},
                                        {"message", "planning.headigns: unknown key; did you mean headings?"}}}}});
  CHECK(document["files"][1] ==
        json{{"file", "b.yaml"}, {"kind", "mission"}, {"valid", true}, {"problems", json::array()}});
  CHECK(document["files"][2]["kind"] == "unknown");
  CHECK(document["files"][2]["problems"][0]["line"] == 0);
}

TEST_CASE("check --json --effective adds the values in force of right files") {
  const auto document =
      json::parse(check({{"m.yaml", mission("leg-1", "sim01")}}, options({"m.yaml"}, true, true)).out);
  CHECK(document["files"][0]["effective"].get<std::string>().find("name: leg-1") != std::string::npos);
}

TEST_CASE("the kind of a file is what its schema key says") {
  CHECK(check({{"d.yaml", kDaemon}}, options({"d.yaml"})).out ==
        "d.yaml: daemon file for 1 gliders and 0 mission files is right\n");
  CHECK(check({{"x.yaml", "name: a\n"}}, options({"x.yaml"})).err ==
        "x.yaml:1:1: schema: missing; a file says with it what it is; allowed: glidehelm/mission/v1, "
        "glidehelm/daemon/v1\n");
  CHECK(check({{"x.yaml", "schema: glidehelm/misson/v1\n"}}, options({"x.yaml"})).err ==
        "x.yaml:1:9: schema: not one of the words; found glidehelm/misson/v1; allowed: glidehelm/mission/v1, "
        "glidehelm/daemon/v1; "
        "did you mean glidehelm/mission/v1?\n");
  CHECK(check({{"x.yaml", "a: [\n"}}, options({"x.yaml"})).code == 1);
}

TEST_CASE("a daemon file is checked with its missions, and each error stands at its own file") {
  const auto document = json::parse(check({{"d.yaml", kDaemon},
                                           {"m/a.yaml", mission("leg-1", "sim01")},
                                           {"m/b.yaml", mission("leg-2", "sim02")},
                                           {"m/c.yaml", mission("leg-3", "sim01", "lst: 1\n")}},
                                          options({"d.yaml", "m/a.yaml"}, false, true))
                                        .out);
  REQUIRE(document["files"].size() == 4);  // a.yaml is not reported twice
  CHECK(document["files"][0]["valid"] == true);
  CHECK(document["files"][1]["valid"] == true);
  CHECK(document["files"][2]["problems"][0]["message"] ==
        "glider: no such glider in d.yaml; found sim02; did you mean sim01?");
  CHECK(document["files"][3]["problems"].size() == 1);
  CHECK(document["files"][3]["problems"][0]["key"] == "lst");
}

TEST_CASE("two missions for one glider are found across files") {
  const auto r =
      check({{"d.yaml", kDaemon}, {"m/a.yaml", mission("leg-1", "sim01")}, {"m/b.yaml", mission("leg-2", "sim01")}},
            options({"d.yaml"}));
  CHECK(r.code == 1);
  CHECK(r.err == "m/b.yaml:3:9: glider: two missions for glider sim01; the other is m/a.yaml\n");
}

TEST_CASE("a GeoJSON file is read beside the mission") {
  const std::string keep = "safety: {keep_in: area.geojson}\n";
  const char* area = R"({"type": "Polygon", "coordinates": [[[-16, 28], [-14, 28], [-14, 30], [-16, 28]]]})";
  CHECK(check({{"f/m.yaml", mission("leg-1", "sim01", keep)}, {"f/area.geojson", area}}, options({"f/m.yaml"})).code ==
        0);
  CHECK(check({{"f/m.yaml", mission("leg-1", "sim01", keep)}}, options({"f/m.yaml"})).code == 1);
}
