#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/ocean/grid_format.hpp"
#include "daemon/verify/dossier_json.hpp"
#include "tests/core/safety/sample_dossier.hpp"

// The program itself, through a shell that opens descriptor 3: GLIDEHELM_VERIFY is its path.

using namespace glidehelm;
using namespace glidehelm::verify;

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code{};
  std::string out, err;
};

class Bench {
 public:
  Bench() {
    std::string pattern = (fs::temp_directory_path() / "glidehelm-verify-XXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()) != nullptr);
    folder_ = pattern;
    request.dossier = test::good_case().dossier;
    ocean::AnalyticSpec spec;
    spec.kind = "constant";
    spec.origin = geo_point(40, -30);
    spec.params = {{"u", 0.05}, {"v", 0.02}};
    request.analytic = {spec};
    staged = request.dossier.file_bytes;
    request.dossier.file_bytes = "not these";
  }
  ~Bench() { fs::remove_all(folder_); }

  Outcome run(const std::string& arguments = "", const std::string& third = "3<staged") {
    write("request", to_json(request));
    write("staged", staged);
    return run_on("request", arguments, third);
  }
  Outcome run_on(const std::string& input, const std::string& arguments, const std::string& third) {
    const std::string command = "cd '" + folder_.string() + "' && '" GLIDEHELM_VERIFY "' " + arguments + " <" + input +
                                " " + third + " >out 2>err";
    const int status = std::system(command.c_str());
    REQUIRE(WIFEXITED(status));
    return {WEXITSTATUS(status), read("out"), read("err")};
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream{folder_ / name, std::ios::binary} << bytes;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream{folder_ / name, std::ios::binary}.rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  VerifyRequest request;
  std::string staged;

 private:
  fs::path folder_;
};

}  // namespace

TEST_CASE("the program accepts the staged bytes of descriptor 3 and names them by hash") {
  Bench bench;
  const auto outcome = bench.run();
  CHECK(outcome.code == 0);
  CHECK(outcome.err == "");
  const auto verdict = verdict_from_json(outcome.out);
  REQUIRE(verdict.has_value());
  CHECK(verdict->accepted);
  CHECK(verdict->of == Sha256::of(bench.staged));
  CHECK(safety::accept("goto_l10.ma", bench.staged, *verdict).has_value());
  // The same judgement as in process.
  auto c = test::good_case();
  CHECK(verdict->margins.size() == c.judged().margins.size());
}

TEST_CASE("the program refuses a file in which one digit was changed after planning") {
  Bench bench;
  const auto digit = bench.staged.find("<start:waypoints>\n") + 22;
  REQUIRE((bench.staged[digit] >= '0' && bench.staged[digit] <= '9'));
  bench.staged[digit] = bench.staged[digit] == '9' ? '8' : static_cast<char>(bench.staged[digit] + 1);
  const auto outcome = bench.run();
  CHECK(outcome.code == 4);
  const auto verdict = verdict_from_json(outcome.out);
  REQUIRE(verdict.has_value());
  CHECK_FALSE(verdict->accepted);
  CHECK_FALSE(test::margin(*verdict, "4 points").holds);
  CHECK_FALSE(safety::accept("goto_l10.ma", bench.staged, *verdict).has_value());
}

TEST_CASE("the program explains itself to a person") {
  Bench bench;
  bench.request.dossier.deadline_s = bench.request.dossier.judged_s - 5;
  const auto outcome = bench.run("--explain");
  CHECK(outcome.code == 4);
  CHECK(outcome.out.rfind("REFUSED: goto_l10.ma", 0) == 0);
  CHECK(outcome.out.find("BROKEN  5 deadline: -5.0 s before the deadline") != std::string::npos);
  const auto help = bench.run("--help");
  CHECK(help.code == 0);
  CHECK(help.out.find("usage: glidehelm-verify") != std::string::npos);
}

TEST_CASE("wrong arguments and wrong requests are usage errors, missing inputs no verdict, nothing is printed then") {
  Bench bench;
  CHECK(bench.run("--judge").code == 2);
  CHECK(bench.run("--judge").out == "");
  CHECK(bench.run("", "3<&-").code == 1);
  CHECK(bench.run("", "3<&-").err.find("descriptor 3") != std::string::npos);
  const auto whole = to_json(bench.request);
  bench.write("cut", whole.substr(0, whole.size() / 2));
  const auto cut = bench.run_on("cut", "", "3<staged");
  CHECK(cut.code == 2);
  CHECK(cut.out == "");
  CHECK(cut.err.find("request: ") != std::string::npos);
  bench.request.grid = InputFile{bench.path("absent.grid"), Sha256{}};
  const auto absent = bench.run();
  CHECK(absent.code == 1);
  CHECK(absent.out == "");
  CHECK(absent.err.find("absent.grid") != std::string::npos);
  bench.request.grid.reset();
  bench.staged.assign(2U << 20, 'x');
  CHECK(bench.run().code == 1);
}

TEST_CASE("the program judges in a grid that it maps itself") {
  Bench bench;
  ocean::Grid grid;
  const auto& d = bench.request.dossier;
  for (int i = 0; i <= 80; ++i) grid.axes.times_s.push_back(d.fix_s - 3600 + 10'800.0 * i);
  grid.axes.depths_m = {0, 400};
  for (int i = 0; i <= 10; ++i) grid.axes.lats_deg.push_back(39.5 + 0.1 * i);
  for (int i = 0; i <= 10; ++i) grid.axes.lons_deg.push_back(-30.5 + 0.1 * i);
  for (std::size_t i = 0; i < grid.axes.nodes(); ++i) {
    grid.values.push_back(0.05F);
    grid.values.push_back(0.02F);
  }
  const auto bytes = ocean::write_grid(grid);
  bench.write("now.grid", bytes);
  bench.request.analytic.clear();
  bench.request.grid = InputFile{bench.path("now.grid"), *grid_identity(bytes)};
  CHECK(bench.run().code == 0);
  auto damaged = bytes;
  damaged[damaged.size() - 3] ^= 4;
  bench.write("now.grid", damaged);
  const auto outcome = bench.run();
  CHECK(outcome.code == 1);
  CHECK(outcome.err.find("payload") != std::string::npos);
}
