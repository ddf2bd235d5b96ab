#include "daemon/verify/judge_request.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "core/chart/coast.hpp"
#include "tests/core/safety/sample_dossier.hpp"
#include "tests/support/verdict.hpp"

using namespace glidehelm;
using namespace glidehelm::verify;

namespace {

/// Files by name, in memory.
class FewFiles final : public world::Files {
 public:
  std::map<std::string, std::string> content;

  world::FileResult<std::unique_ptr<world::Mapping>> map(const std::string& path) override {
    struct Bytes final : world::Mapping {
      std::string held;
      [[nodiscard]] std::span<const std::byte> bytes() const override { return std::as_bytes(std::span{held}); }
    };
    const auto found = content.find(path);
    if (found == content.end()) return unexpected(world::FileError{"open", path, 2});
    auto bytes = std::make_unique<Bytes>();
    bytes->held = found->second;
    return std::unique_ptr<world::Mapping>{std::move(bytes)};
  }
  world::FileResult<std::unique_ptr<world::Folder>> open_folder(const std::string& path) override { return none(path); }
  world::FileResult<std::unique_ptr<world::Folder>> make_folder(const std::string& path, unsigned) override {
    return none(path);
  }
  world::FileResult<std::string> read(const std::string& path, std::size_t) override { return none(path); }
  world::FileResult<world::FileStat> stat(const std::string& path) override { return none(path); }
  std::vector<std::string> glob(const std::string&) override { return {}; }
  std::string scratch() override { return "/nowhere"; }

 private:
  static Unexpected<world::FileError> none(const std::string& path) {
    return unexpected(world::FileError{"open", path, 2});
  }
};

/// The good case's uniform current as a grid around its way, three-hourly for ten days.
ocean::Grid uniform_grid(const safety::Dossier& d) {
  ocean::Grid grid;
  for (int i = 0; i <= 80; ++i) grid.axes.times_s.push_back(d.fix_s - 3600 + 10'800.0 * i);
  grid.axes.depths_m = {0};
  grid.axes.has_depth = false;
  for (int i = 0; i <= 10; ++i) grid.axes.lats_deg.push_back(39.5 + 0.1 * i);
  for (int i = 0; i <= 10; ++i) grid.axes.lons_deg.push_back(-30.5 + 0.1 * i);
  for (std::size_t i = 0; i < grid.axes.nodes(); ++i) {
    grid.values.push_back(0.05F);
    grid.values.push_back(0.02F);
  }
  return grid;
}

ocean::AnalyticSpec constant(double u, double v) {
  ocean::AnalyticSpec spec;
  spec.kind = "constant";
  spec.origin = geo_point(40, -30);
  spec.params = {{"u", u}, {"v", v}};
  return spec;
}

struct Desk {
  FewFiles files;
  VerifyRequest request;
  Desk() {
    request.dossier = test::good_case().dossier;
    put_grid(uniform_grid(request.dossier));
  }
  void put_grid(const ocean::Grid& grid) {
    files.content["now.grid"] = ocean::write_grid(grid);
    request.grid = InputFile{"now.grid", *grid_identity(files.content["now.grid"])};
  }
  [[nodiscard]] std::string failing() {
    const auto verdict = judge_request(request, files);
    if (!verdict) return verdict.error().message();
    std::string names;
    for (const auto& m : verdict->margins)
      if (!m.holds) names += (names.empty() ? "" : ", ") + m.rule;
    CHECK(verdict->accepted == names.empty());
    return names;
  }
};

}  // namespace

TEST_CASE("a request with a grid is judged in that grid") {
  Desk desk;
  CHECK(desk.failing() == "");
  auto other = uniform_grid(desk.request.dossier);
  for (std::size_t i = 0; i < other.values.size(); i += 2) other.values[i] = 0.25F;
  desk.put_grid(other);
  CHECK(desk.failing() == "promise surfacing, promise arrival");
}

TEST_CASE("the verifier reads the forecast's age from the grid itself: older than 72 h is refused, a tide is not") {
  Desk desk;
  const double judged = desk.request.dossier.judged_s;
  auto grid = uniform_grid(desk.request.dossier);
  grid.facts.reference_s = judged - 71.9 * 3600;
  desk.put_grid(grid);
  CHECK(desk.failing() == "");
  grid.facts.reference_s = judged - 72.1 * 3600;
  desk.put_grid(grid);
  CHECK(desk.failing() == "forecast age");
  desk.request.grid_options.outside_time = ocean::OutsideTime::cycle;
  CHECK(desk.failing() == "");
}

TEST_CASE("another grid than the one planned on, a damaged or a missing one give no verdict") {
  Desk desk;
  const std::string good = desk.files.content["now.grid"];
  auto other = uniform_grid(desk.request.dossier);
  other.values[0] = 0.06F;
  desk.files.content["now.grid"] = ocean::write_grid(other);
  CHECK(desk.failing() == "now.grid: is not the grid that was planned on");
  desk.files.content["now.grid"] = good;
  desk.files.content["now.grid"][good.size() - 1] ^= 1;
  CHECK(desk.failing().find("payload") != std::string::npos);
  desk.files.content["now.grid"] = good.substr(0, 50);
  CHECK(desk.failing() == "now.grid: is not the grid that was planned on");
  desk.files.content.clear();
  CHECK(desk.failing().rfind("now.grid: ", 0) == 0);
}

TEST_CASE("analytic currents are judged alone, and add to a grid") {
  Desk desk;
  desk.request.grid.reset();
  desk.request.analytic = {constant(0.05, 0.02)};
  CHECK(desk.failing() == "");
  desk.request.analytic = {constant(0.02, 0.02), constant(0.03, 0.0)};
  CHECK(desk.failing() == "");
  auto half = uniform_grid(desk.request.dossier);
  for (auto& value : half.values) value *= 0.5F;
  desk.put_grid(half);
  desk.request.analytic = {constant(0.025, 0.01)};
  CHECK(desk.failing() == "");
  desk.request.analytic[0].kind = "whirl";
  CHECK(desk.failing().rfind("analytic currents: ", 0) == 0);
  desk.request.analytic.clear();
  desk.request.grid.reset();
  CHECK(desk.failing() == "request: names neither a grid nor analytic currents");
}

TEST_CASE("areas of the request bound the track, an area without extent gives no verdict") {
  Desk desk;
  const auto goal = desk.request.dossier.promise.goal;
  const auto corner = [&](double bearing) { return destination(goal, Bearing{degrees(bearing)}, Metres{600}); };
  desk.request.keep_out = {{"goal", {corner(0), corner(120), corner(240)}}};
  CHECK(desk.failing() == "1 waypoints");
  desk.request.keep_out = {{"line", {corner(0), corner(120)}}};
  CHECK(desk.failing() == "area 'line': has fewer than three corners");
}

TEST_CASE("without a coast file the grid's dry nodes are land, even when the request says otherwise") {
  Desk desk;
  auto grid = uniform_grid(desk.request.dossier);
  // The last rows, from 40.3° on, are dry: beyond the goal at 40.127°, but a coastal fill of many cells would hide that.
  auto near = grid;
  const std::size_t rows = grid.axes.lats_deg.size(), columns = grid.axes.lons_deg.size();
  for (std::size_t i = 0; i < grid.axes.nodes(); ++i)
    if (i / columns % rows >= 6) near.values[2 * i] = near.values[2 * i + 1] = std::numeric_limits<float>::quiet_NaN();
  desk.put_grid(near);
  desk.request.grid_options.mask_is_land = false;
  desk.request.grid_options.coastal_fill_cells = 50;
  // dry from 40.1° on: the goal lies on it and the flight ends there
  CHECK(desk.failing().find("1 waypoints") != std::string::npos);
}

TEST_CASE("a named coast file that is another or cannot be read gives no verdict") {
  Desk desk;
  desk.request.coast = InputFile{"here.coast", Sha256::of("coast bytes")};
  CHECK(desk.failing().rfind("here.coast: ", 0) == 0);
  desk.files.content["here.coast"] = "other bytes";
  CHECK(desk.failing() == "here.coast: is not the coast file that was planned on");
  desk.files.content["here.coast"] = "coast bytes";
  CHECK(desk.failing().rfind("here.coast: ", 0) == 0);
}

TEST_CASE("a coast file of the request is the land that is judged") {
  Desk desk;
  const auto with = [&](std::int32_t x) {
    // a rectangle from x (1e-7 degrees east of 31° W) to 2 km east of it, across the latitude of the second waypoint
    chart::CoastRing ring{{{x, 400'000'000}, {x + 200'000, 400'000'000}, {x + 200'000, 401'000'000}, {x, 401'000'000}},
                          std::vector<bool>(4, false)};
    const auto coast = chart::Coast::make({-310'000'000, -290'000'000, 390'000'000, 410'000'000}, "a test", {ring});
    REQUIRE(coast.has_value());
    desk.files.content["here.coast"] = (*coast)->text();
    desk.request.coast = InputFile{"here.coast", Sha256::of((*coast)->text())};
    return desk.failing();
  };
  CHECK(with(5'000'000) == "");  // 43 km to the west
  CHECK(with(10'500'000).find("2 land") != std::string::npos);
}

TEST_CASE("an explanation names broken rules first and leaves absent numbers out") {
  auto verdict = test::verdict_on("goto_l10.ma", "bytes", "2 land");
  for (auto& m : verdict.margins) {
    m.message = "said";
    m.found = m.limit = std::numeric_limits<double>::quiet_NaN();
    if (m.rule == "2 land") m.found = 1500, m.limit = 2000, m.unit = "m";
  }
  const auto text = explain(verdict);
  CHECK(text.rfind("REFUSED: goto_l10.ma, sha256 " + Sha256::of("bytes").hex() +
                       "\n  BROKEN  2 land: said [found 1500, limit 2000 m]\n  holds",
                   0) == 0);
  CHECK(text.find("nan") == std::string::npos);
  CHECK(explain(test::verdict_on("goto_l10.ma", "bytes")).rfind("accepted: ", 0) == 0);
}

namespace {

/// The grid of the dossier's ocean as the most trusted of two sources; the other one runs three times as fast.
void put_sources(Desk& desk) {
  const auto good = uniform_grid(desk.request.dossier);
  auto other = good;
  for (auto& value : other.values) value *= 3;
  desk.files.content["first.grid"] = ocean::write_grid(good);
  desk.files.content["second.grid"] = ocean::write_grid(other);
  desk.request.grid.reset();
  for (const char* name : {"first", "second"}) {
    const auto path = std::string{name} + ".grid";
    desk.request.sources.push_back(
        {name, InputFile{path, *grid_identity(desk.files.content[path])}, {}, {}, -1e18, 1e18});
  }
}

}  // namespace

TEST_CASE("a request with sources is judged in their composite, the most trusted first") {
  Desk desk;
  put_sources(desk);
  desk.request.seams.blend = Metres{1000};
  CHECK(desk.failing() == "");
  std::swap(desk.request.sources[0], desk.request.sources[1]);
  CHECK(desk.failing().find("promise surfacing") != std::string::npos);
}

TEST_CASE("sources that are not those planned on, or make no sense, give no verdict") {
  Desk desk;
  put_sources(desk);
  const auto good = desk.request;
  desk.request.sources[1].grid.hash = Sha256::of("another");
  CHECK(desk.failing() == "second.grid: is not the grid that was planned on");
  desk.request = good;
  desk.request.seams.join = Seconds{0};
  CHECK(desk.failing() == "request: the seams between its sources have no width");
  desk.request = good;
  desk.request.sources[0].region = {geo_point(1, 1), geo_point(2, 2)};
  CHECK(desk.failing() == "source 'first': has a region of fewer than three corners");
  desk.request = good;
  desk.request.sources[0].to_s = -2e18;
  CHECK(desk.failing() == "source 'first': ends before it begins");
}
