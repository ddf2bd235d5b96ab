#include "daemon/cli/field_convert.hpp"

#include <cmath>
#include <cstring>

#include "core/base/utc.hpp"
#include "core/ocean/depth_average.hpp"
#include "tests/daemon/cli/field_verb.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;

namespace {

/// Numbers that no decimal holds, a dry column, one that ends at the second level.
test::SeaFile uneven_sea() {
  test::SeaFile file;
  const auto dry = [](int z, int j, int i) { return (i == 0 && j == 0) || (i == 1 && j == 1 && z == 2); };
  file.u = [dry](int t, int z, int j, int i) {
    return dry(z, j, i) ? test::kDryNode : std::sin(1 + t + 3 * z + 7 * j + 11 * i);
  };
  file.v = [dry](int t, int z, int j, int i) {
    return dry(z, j, i) ? test::kDryNode : std::cos(2 + t + 5 * z + 3 * j + i) / 3;
  };
  return file;
}

test::Ran convert(const FieldConvertOptions& options) { return test::run_verb(run_field_convert, options); }

std::unique_ptr<daemon::LoadedGrid> load(const std::string& file) {
  auto loaded = daemon::ingest_files({file}, {}, test::field_world());
  REQUIRE(loaded);
  return std::move(*loaded);
}
bool same_bits(const ocean::GridView& a, const ocean::GridView& b) {
  return a.axes == b.axes && std::memcmp(a.values, b.values, 8 * a.axes.nodes()) == 0;
}

}  // namespace

TEST_CASE("field convert: a converted file reads back to the same floats bit for bit") {
  const test::ScratchFolder folder;
  FieldConvertOptions options;
  options.files = {test::make_sea(folder, "a.nc", uneven_sea())};
  options.out = folder / "b.nc";
  const auto said = convert(options);
  INFO(said.err);
  REQUIRE(said.code == 0);
  CHECK(said.out.find("3 times, 3 depths, 4 by 4 nodes") != std::string::npos);
  const auto before = load(options.files[0]), after = load(options.out);
  CHECK(same_bits(before->view, after->view));
  CHECK(after->view.facts.warnings.empty());
}

TEST_CASE("field convert: the NetCDF library reads the same numbers and missing where they are missing") {
  const test::ScratchFolder folder;
  FieldConvertOptions options;
  options.files = {test::make_sea(folder, "a.nc", uneven_sea())};
  options.out = folder / "b.nc";
  REQUIRE(convert(options).code == 0);
  test::write_bytes(folder / "compare.py", R"(import sys, netCDF4
a, b = (netCDF4.Dataset(name) for name in sys.argv[1:])
for name in ("uo", "vo"):
    x, y = a[name][:], b[name][:]
    assert x.shape == y.shape and (x.mask == y.mask).all() and x.mask.any()
    assert x.compressed().tobytes() == y.compressed().tobytes()
assert (netCDF4.num2date(a["time"][:], a["time"].units) == netCDF4.num2date(b["time"][:], b["time"].units)).all()
assert b.Conventions == "CF-1.8"
for axis in ("lat", "lon", "depth"):
    assert (a[axis][:] == b[axis][:]).all()
)");
  const auto ran = test::run_command(
      "/usr/bin/python3 " + (folder / "compare.py") + " " + options.files[0] + " " + options.out, folder);
  if (ran.err.find("No module named") != std::string::npos) {
    WARN("python3-netcdf4 is not installed: not compared with it");
    return;
  }
  INFO(ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("field convert: box and times keep what they need and no more") {
  const test::ScratchFolder folder;
  FieldConvertOptions options;
  options.files = {test::make_sea(folder, "a.nc", uneven_sea())};
  options.out = folder / "part.nc";
  options.ingest.area = daemon::IngestOptions::Area{-19.4, -19.2, 30.2, 31};
  options.from = utc_from_text("2024-05-01T00:30:00Z");
  REQUIRE(convert(options).code == 0);
  const auto whole = load(options.files[0]), part = load(options.out);
  const auto& axes = part->view.axes;
  // The nodes around the box are kept, so that all of it lies between nodes: 30.2 and -19.2 lie within it.
  CHECK(axes.lats_deg == std::vector<double>{30, 30.5, 31.25});
  CHECK(axes.lons_deg == std::vector<double>{-19.5, -19});
  REQUIRE(axes.times_s.size() == 2);
  // Time 0, level 0, row 0, column 0 of the part is time 1, row 0, column 1 of the whole: 4 · 4 · 3 nodes a time.
  CHECK(part->view.values[0] == whole->view.values[2 * (48 + 1)]);

  options.out = folder / "none.nc";
  options.from = utc_from_text("2025-01-01T00:00:00Z");
  const auto none = convert(options);
  CHECK(none.code == 1);
  CHECK(none.err.find("no time is within --times; the files have 3, 2024-05-01T00:00:00Z to 2024-05-01T03:00:00Z") !=
        std::string::npos);
}

TEST_CASE("field convert: a depth mean is the one that planners take") {
  const test::ScratchFolder folder;
  FieldConvertOptions options;
  options.files = {test::make_sea(folder, "a.nc", uneven_sea())};
  options.out = folder / "mean.nc";
  options.depth_mean = {0, 40};
  REQUIRE(convert(options).code == 0);
  const auto whole = load(options.files[0]), mean = load(options.out);
  const auto expected = ocean::depth_average(whole->view, ocean::DiveProfile::between(Metres{0}, Metres{40}));
  CHECK(same_bits(ocean::view_of(expected), mean->view));
}

TEST_CASE("field convert: the flat grid opens as the one of the child") {
  const test::ScratchFolder folder;
  FieldConvertOptions options;
  options.files = {test::make_sea(folder, "a.nc", uneven_sea())};
  options.out = folder / "b.grid";
  REQUIRE(convert(options).code == 0);
  const auto bytes = test::file_bytes(options.out);
  const auto opened = ocean::open_grid(std::as_bytes(std::span{bytes.data(), bytes.size()}));
  REQUIRE(opened);
  CHECK(same_bits(*opened, load(options.files[0])->view));
}

TEST_CASE("field convert: nothing is replaced and an ending that means nothing is refused before reading") {
  const test::ScratchFolder folder;
  FieldConvertOptions options;
  options.files = {folder / "missing.nc"};
  options.out = folder / "b.txt";
  CHECK(convert(options).code == 2);
  options.out = folder / "b.nc";
  test::write_bytes(options.out, "mine");
  const auto said = convert(options);
  CHECK(said.code == 1);
  CHECK(said.err.find("is there already") != std::string::npos);
  CHECK(test::file_bytes(options.out) == "mine");
}
