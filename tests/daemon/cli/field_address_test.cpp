#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/utc.hpp"
#include "daemon/cli/field_info.hpp"
#include "daemon/cli/field_sample.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/dap_server.hpp"

// An OPeNDAP server on the loopback, read through the built child in its sandbox, by the verb and by the daemon's watch.

using namespace glidehelm;
using namespace glidehelm::cli;

namespace {

void put_child_in_path() {
  const std::string program = GLIDEHELM_INGEST;
  const char* path = std::getenv("PATH");
  REQUIRE(setenv("PATH", (program.substr(0, program.rfind('/')) + ":" + (path != nullptr ? path : "")).c_str(), 1) ==
          0);
}

}  // namespace

TEST_CASE("field info and sample read an address like a file") {
  put_child_in_path();
  const test::ScratchFolder folder;
  const test::DapServer server{"good", folder};
  world::RealWorld real;
  auto world = real.world();
  std::ostringstream out, err;
  FieldInfoOptions info;
  info.files = {server.address()};
  info.json = true;
  REQUIRE(run_field_info(info, world, out, err) == 0);
  const auto said = nlohmann::json::parse(out.str());
  CHECK(said["variables"]["recognised_by"] == "name u");
  CHECK(said["sources"][0]["file"] == server.address());
  CHECK(said["times"]["count"] == 3);

  FieldSampleOptions sample;
  sample.files = info.files;
  sample.lat_deg = 40.25;
  sample.lon_deg = -9.5;
  sample.time = utc_from_text("2024-01-01T03:00:00Z");
  sample.json = true;
  std::ostringstream answer;
  REQUIRE(run_field_sample(sample, world, answer, err) == 0);
  // The server's formula at column 2, row 1, half way between two times.
  CHECK(nlohmann::json::parse(answer.str())["east_m_per_s"].get<double>() == Approx(0.205).margin(1e-7));
}

TEST_CASE("a silent server holds up neither the loop nor the plans: the last forecast stays, the next try comes") {
  put_child_in_path();
  const test::ScratchFolder folder;
  const test::DapServer silent{"silent", folder}, good{"good", folder};
  world::RealLoop loop;
  world::RealClock clock{loop};
  world::RealFiles files;
  world::RealNet net{loop};
  world::RealRng rng;
  world::RealProcs procs{loop};
  const world::World world{clock, files, net, rng, procs};

  daemon::IngestOptions options;
  options.deadline = Seconds{2};
  std::optional<daemon::IngestOutcome> outcome;
  const auto ask = [&](const std::vector<std::string>& addresses) {
    outcome.reset();
    int turns = 0;
    std::function<void()> tick = [&] {
      ++turns;
      if (!outcome) clock.call_at(clock.tick() + std::chrono::milliseconds{10}, tick);
    };
    tick();
    daemon::ingest_files_async(addresses, options, world, [&](daemon::IngestOutcome got) { outcome = std::move(got); });
    CHECK_FALSE(outcome);  // it returned at once
    loop.context.restart();
    while (!outcome) loop.context.run_one();
    loop.context.poll();
    return turns;
  };

  const int turns = ask({silent.address()});
  REQUIRE_FALSE(*outcome);
  CHECK(outcome->error().what == silent.address() + ": glidehelm-ingest took longer than 2 s and was stopped");
  CHECK(outcome->error().passing);
  // Two seconds of waiting are two hundred turns of 10 ms; a loop that was held up would have had one or two.
  CHECK(turns > 50);

  // In a set it is left out, and the other is used.
  options.deadline = Seconds{20};
  ask({good.address()});
  REQUIRE(*outcome);
  CHECK((**outcome)->view.axes.times_s.size() == 3);
  options.deadline = Seconds{3};
  ask({silent.address(), good.address()});
  REQUIRE(*outcome);
  CHECK((**outcome)->left_out.size() == 1);
  CHECK((**outcome)->left_out[0].file == silent.address());
  CHECK((**outcome)->try_again);
}
