#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <set>
#include <thread>

#include "core/base/utc.hpp"
#include "daemon/forecast_watch.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/netcdf.hpp"
#include "tests/support/processes.hpp"

// Every way in which a published forecast is bad (trust.md I-7), with the daemon's own watch, the real child and real
// files: a good older forecast is in use, then the bad one appears beside it.

using namespace glidehelm;
using namespace glidehelm::daemon;
using namespace std::chrono_literals;

namespace {

using Edits = std::vector<std::pair<std::string, std::string>>;

std::string replaced(std::string text, const Edits& edits) {
  for (const auto& [from, to] : edits) {
    const auto at = text.find(from);
    INFO(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string repeated(const std::string& value, int count) {
  std::string text = value;
  for (int i = 1; i < count; ++i) text += ", " + value;
  return text;
}

/// A plain forecast of four times, three rows, four columns that began `hours_ago`: u 0.11 to 0.58, v its half.
std::string plain(double hours_ago, double now_s) {
  std::string u, v;
  for (int i = 0; i < 48; ++i) {
    u += (i > 0 ? ", " : "") + std::to_string(0.11 + 0.01 * i);
    v += (i > 0 ? ", " : "") + std::to_string(0.055 + 0.005 * i);
  }
  const auto since = utc_text(instant_at(std::floor(now_s / 3600) * 3600 - 3600 * hours_ago));
  return "netcdf f {\ndimensions: time = 4 ; lat = 3 ; lon = 4 ;\nvariables:\n"
         "  double time(time) ; time:units = \"hours since " +
         since.substr(0, 10) + " " + since.substr(11, 8) +
         "\" ;\n"
         "  double lat(lat) ; lat:units = \"degrees_north\" ;\n"
         "  double lon(lon) ; lon:units = \"degrees_east\" ;\n"
         "  float u(time, lat, lon) ; u:units = \"m/s\" ; u:_FillValue = -99.f ;\n"
         "  float v(time, lat, lon) ; v:units = \"m/s\" ; v:_FillValue = -99.f ;\n"
         "data:\n  time = 0, 6, 12, 18 ;\n  lat = 27, 28, 29 ;\n  lon = -17, -16, -15, -14 ;\n  u = " +
         u + " ;\n  v = " + v + " ;\n}\n";
}

/// A pattern whose file is gone when somebody comes to open it.
struct Ghosts final : world::Files {
  explicit Ghosts(world::Files& f) : real{f} {}
  world::Files& real;
  std::vector<std::string> ghosts;
  world::FileResult<std::unique_ptr<world::Folder>> open_folder(const std::string& path) override {
    return real.open_folder(path);
  }
  world::FileResult<std::unique_ptr<world::Folder>> make_folder(const std::string& path, unsigned mode) override {
    return real.make_folder(path, mode);
  }
  world::FileResult<std::string> read(const std::string& path, std::size_t most) override {
    return real.read(path, most);
  }
  world::FileResult<world::FileStat> stat(const std::string& path) override { return real.stat(path); }
  world::FileResult<std::unique_ptr<world::Mapping>> map(const std::string& path) override { return real.map(path); }
  std::vector<std::string> glob(const std::string& pattern) override {
    auto found = real.glob(pattern);
    found.insert(found.end(), ghosts.begin(), ghosts.end());
    return found;
  }
  std::string scratch() override { return real.scratch(); }
};

/// A daemon's watch over a folder, in which "good.nc" is accepted already.
struct Post {
  test::ScratchFolder scratch;
  world::RealWorld real;
  Ghosts files{real.world().files};
  world::World world{real.world().clock, files, real.world().net, real.world().rng, real.world().procs};
  std::vector<std::string> refused, loaded;
  std::unique_ptr<ForecastWatch> watch;
  double now_s{epoch_seconds(world.clock.utc())};

  Post() {
    std::filesystem::create_directory(scratch / "published");
    watch = std::make_unique<ForecastWatch>(
        world, scratch / "grids",
        ForecastWatch::Handlers{[this](const std::shared_ptr<const OceanSource>& ocean) {
                                  std::string text;
                                  for (const auto& warning : ocean->forecast.facts().warnings) text += warning + "; ";
                                  loaded.push_back(text);
                                },
                                [this](const std::string& problem) { refused.push_back(problem); },
                                {},
                                [this] { world.net.stop(); }},
        nullptr, Seconds{0.5});
  }
  [[nodiscard]] std::string path(const std::string& name) const { return scratch / ("published/" + name); }

  /// A file that nobody has touched for a minute.
  void put(const std::string& name, const std::string& bytes) const {
    test::write_bytes(path(name), bytes);
    settle(name);
  }
  void settle(const std::string& name) const {
    std::filesystem::last_write_time(path(name), std::filesystem::file_time_type::clock::now() - 60s);
  }
  void put_cdl(const std::string& name, const std::string& cdl, const std::string& kind = "classic") const {
    std::filesystem::rename(test::make_netcdf(scratch, "made.nc", cdl, kind), path(name));
    settle(name);
  }
  [[nodiscard]] std::string newer(const Edits& edits = {}) const { return replaced(plain(6, now_s), edits); }
  [[nodiscard]] std::string bytes_of(const std::string& cdl, const std::string& kind = "classic") const {
    return test::file_bytes(test::make_netcdf(scratch, "made.nc", cdl, kind));
  }

  void follow() {
    mission::Mission m;
    m.name = "leg";
    m.glider = "sim01";
    m.goal = geo_point(28.5, -15.5);
    m.currents.files = {path("*.nc")};
    watch->follow(m);
    world.net.run();
  }
  void look() {
    watch->look();
    if (watch->loading()) world.net.run();
  }
};

struct Row {
  const char* kind;
  std::function<void(Post&)> publish;
  const char* says;  ///< part of what the daemon says
  bool read{};       ///< it is not bad after all: read as it is meant, with a warning or without
  bool looked{};     ///< `publish` has let the watch look already
};

Row edited(const char* kind, Edits edits, const char* says, bool read = false, const char* format = "classic") {
  return {kind, [edits, format](Post& post) { post.put_cdl("newer.nc", post.newer(edits), format); }, says, read};
}
Row bytes(const char* kind, const std::string& content, const char* says) {
  return {kind, [content](Post& post) { post.put("newer.nc", content); }, says};
}
Row cut(const char* kind, const char* format, double share, const char* says) {
  return {kind,
          [format, share](Post& post) {
            const auto whole = post.bytes_of(post.newer(), format);
            post.put("newer.nc", whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
          },
          says};
}

/// What somebody does to the folder, again and again, until the watch has answered.
Row meddled(const char* kind, std::function<void(const Post&, int)> meddle, const char* says) {
  return {kind,
          [meddle = std::move(meddle)](Post& post) {
            post.put_cdl("newer.nc", post.newer());
            std::atomic<bool> done{false};
            std::thread other{[&] {
              for (int i = 0; !done; ++i) {
                meddle(post, i);
                std::this_thread::sleep_for(20ms);
              }
            }};
            std::this_thread::sleep_for(50ms);
            post.look();
            done = true;
            other.join();
          },
          says, false, true};
}

using namespace std::string_literals;

std::vector<Row> things_that_are_no_file() {
  return {
      {"vanished between glob and open", [](Post& post) { post.files.ghosts = {post.path("newer.nc")}; },
       "newer.nc: is not there (any more)"},
      {"a FIFO", [](Post& post) { REQUIRE(mkfifo(post.path("newer.nc").c_str(), 0644) == 0); }, "is a FIFO"},
      {"a folder", [](Post& post) { std::filesystem::create_directory(post.path("newer.nc")); }, "is a folder"},
      {"a symbolic link",
       [](Post& post) { std::filesystem::create_symlink(post.path("good.nc"), post.path("newer.nc")); },
       "is a symbolic link"},
      {"a device", [](Post& post) { post.files.ghosts = {"/dev/zero"}; }, "/dev/zero: is a device"},
      {"40 GB",
       [](Post& post) {
         post.put("newer.nc", "CDF\1");
         std::filesystem::resize_file(post.path("newer.nc"), 40'000'000'000);
         post.settle("newer.nc");
       },
       "has 40.0 GB, allowed is 4.0 GB"},
      meddled(
          "growing",
          [](const Post& post, int) {
            std::ofstream{post.path("newer.nc"), std::ios::app | std::ios::binary} << "more";
          },
          "is still being written: it went from "),
      meddled(
          "changed in place",
          [](const Post& post, int i) {
            std::fstream file{post.path("newer.nc"), std::ios::in | std::ios::out | std::ios::binary};
            file.seekp(-4, std::ios::end);
            file << static_cast<char>(i);
          },
          "is still being written: it changed while it was read"),
      meddled(
          "replaced while it is read",
          [](const Post& post, int) {
            // A young file each time, under a name that no pattern matches until it is renamed.
            std::filesystem::copy_file(post.path("good.nc"), post.scratch / "next",
                                       std::filesystem::copy_options::overwrite_existing);
            std::filesystem::rename(post.scratch / "next", post.path("newer.nc"));
          },
          "was replaced while it was read"),
      meddled(
          "taken away while it is read",
          [](const Post& post, int i) {
            if (i == 0) {
              test::write_bytes(post.path("newer.nc"), "young");
              return;
            }
            // Long after the child has opened it, long before it has settled.
            std::this_thread::sleep_for(400ms);
            std::filesystem::remove(post.path("newer.nc"));
          },
          "was taken away while it was read"),
  };
}

std::vector<Row> files_of_another_kind() {
  return {
      bytes("empty", "", "the file is empty"),
      bytes("text", "quota exceeded\n", "not a NetCDF file: plain text"),
      bytes("an HTML error page", "<!DOCTYPE html>\n<html><title>503</title></html>", "a web page"),
      bytes("an XML error of a server", "<?xml version=\"1.0\"?><ExceptionReport/>", "an XML document"),
      bytes("gzip", "\x1f\x8b\x08\0\0\0\0\0"s, "compressed with gzip"),
      bytes("zstd", "\x28\xb5\x2f\xfd\0\0"s, "compressed with zstd"),
      bytes("GRIB", "GRIB\0\0\0\2"s, "a GRIB file"),
      bytes("a ZIP archive", "PK\3\4\0\0"s, "a ZIP archive"),
      bytes("HDF4", "\x0e\x03\x13\x01\0\0"s, "an HDF4 file"),
      bytes("CDL", "netcdf f {\n}\n", "CDL, the text form"),
      bytes("room made and nothing written", std::string(5000, '\0'), "nothing but zero bytes"),
      bytes("a classic version that does not exist", "CDF\3\0\0\0\0"s, "classic NetCDF of version 3"),
      cut("a classic file cut in its data", "classic", 0.7, "truncated: the file has "),
      cut("a classic file cut in its header", "classic", 0.2, "its header does not end within"),
      cut("a CDF-5 file cut", "64-bit data", 0.9, "truncated: the file has "),
      cut("a NetCDF-4 file cut", "netCDF-4", 0.9, "truncated: the file has "),
      {"a classic file still streamed",
       [](Post& post) {
         auto whole = post.bytes_of(post.newer({{"time = 4", "time = UNLIMITED"}}));
         whole.replace(4, 4, "\xff\xff\xff\xff");
         post.put("newer.nc", whole);
       },
       "its header does not say how many records it has"},
      {"a NetCDF-4 file with a damaged root",
       [](Post& post) {
         auto whole = post.bytes_of(post.newer(), "netCDF-4");
         for (std::size_t at = 48; at < 400; ++at) whole[at] = static_cast<char>(0x5a);
         post.put("newer.nc", whole);
       },
       "newer.nc: unreadable while opening"},
  };
}

std::vector<Row> numbers_that_are_no_sea() {
  return {
      {"all NaN",
       [](Post& post) {
         const auto cdl = post.newer();
         const auto at = cdl.find("  u = ");
         post.put_cdl("newer.nc",
                      cdl.substr(0, at) + "u = " + repeated("NaNf", 48) + " ; v = " + repeated("NaNf", 48) + " ; }");
       },
       "u is NaN everywhere"},
      {"all fill values",
       [](Post& post) {
         const auto cdl = post.newer();
         const auto at = cdl.find("  u = ");
         post.put_cdl("newer.nc",
                      cdl.substr(0, at) + "u = " + repeated("-99", 48) + " ; v = " + repeated("-99", 48) + " ; }");
       },
       "u is the fill value everywhere"},
      {"land everywhere",
       [](Post& post) {
         const auto cdl = post.newer({{"u:_FillValue = -99.f", "u:missing_value = 1.e20f"}});
         const auto at = cdl.find("  u = ");
         post.put_cdl("newer.nc",
                      cdl.substr(0, at) + "u = " + repeated("1.e20", 48) + " ; v = " + repeated("0", 48) + " ; }");
       },
       "u is marked as missing everywhere: to its producer all of this area is land"},
      {"all zero",
       [](Post& post) {
         const auto cdl = post.newer();
         const auto at = cdl.find("  u = ");
         post.put_cdl("newer.nc",
                      cdl.substr(0, at) + "u = " + repeated("0", 48) + " ; v = " + repeated("0", 48) + " ; }");
       },
       "every value is exactly zero: no sea is that still"},
      {"the last time still zero",
       [](Post& post) {
         const auto cdl = post.newer();
         const auto at = cdl.find("  u = ");
         const auto three = repeated("0.2", 36) + ", " + repeated("0", 12);
         post.put_cdl("newer.nc", cdl.substr(0, at) + "u = " + three + " ; v = " + three + " ; }");
       },
       "the file is probably still being written"},
      edited("speeds above 5 m/s", {{"0.110000", "5.5"}}, "a current of 5.50 m/s at 27.0000, -17.0000"),
      {"knots said to be m/s",  // a jet of 3 m/s is 5.8 kn
       [](Post& post) {
         post.put_cdl("newer.nc", post.newer({{"0.110000", "5.83"}, {"0.120000", "5.64"}}));
       },
       "a current of 5.83 m/s"},
      edited("cm/s without a unit", {{"u:units = \"m/s\" ; ", ""}, {"v:units = \"m/s\" ; ", ""}, {"0.110000", "11"}},
             "allowed is at most 5 m/s (is the unit right?)"),
      edited("a unit of another quantity", {{"u:units = \"m/s\"", "u:units = \"kg\""}},
             "the unit \"kg\" does not convert to m/s"),
      edited("a unit that is none", {{"u:units = \"m/s\"", "u:units = \"furlongs per fortnigt\""}},
             "furlongs per fortnigt"),
      edited("packed with a scale of zero", {{"u:units = \"m/s\"", "u:units = \"m/s\" ; u:scale_factor = 0.f"}},
             "u has the impossible packing scale_factor 0"),
      edited("packed with an offset that is no number",
             {{"u:units = \"m/s\"", "u:units = \"m/s\" ; u:add_offset = NaN"}}, "add_offset nan"),
  };
}

std::vector<Row> variables_that_are_none() {
  return {
      edited("no velocity",
             {{"float u(", "float temp("},
              {"u:units", "temp:units"},
              {"u:_Fill", "temp:_Fill"},
              {"float v(", "float salt("},
              {"v:units", "salt:units"},
              {"v:_Fill", "salt:_Fill"},
              {"  u = ", "  temp = "},
              {"  v = ", "  salt = "}},
             "no east and north velocity is recognised"),
      edited(
          "one component missing",
          {{"float v(", "float salt("}, {"v:units", "salt:units"}, {"v:_Fill", "salt:_Fill"}, {"  v = ", "  salt = "}},
          "it has the eastward velocity only"),
      edited("components of different shapes", {{"float v(time, lat, lon)", "float v(time, lon, lat)"}},
             "lie on different dimensions"),
      edited("without latitude and longitude",
             {{"double lat(lat) ; lat:units = \"degrees_north\" ;", "double y(lat) ; y:units = \"m\" ;"},
              {"double lon(lon) ; lon:units = \"degrees_east\" ;", "double x(lon) ; x:units = \"m\" ;"},
              {"  lat = ", "  y = "},
              {"  lon = ", "  x = "}},
             "dimension lat of u(time, lat, lon) is neither time, depth, latitude nor longitude"),
      edited("an unknown dimension",
             {{"time = 4 ; lat", "batch = 4 ; lat"},
              {"double time(time)", "double w(batch)"},
              {"time:units", "w:units"},
              {"hours since", "runs"},
              {"u(time,", "u(batch,"},
              {"v(time,", "v(batch,"},
              {"  time = 0", "  w = 0"}},
             "dimension batch of u(batch, lat, lon) is neither time, depth, latitude nor longitude"),
      {"velocities that are texts",
       [](Post& post) {
         const auto cdl = post.newer(
             {{"float u(time, lat, lon) ; u:units = \"m/s\" ; u:_FillValue = -99.f", "char u(time, lat, lon)"},
              {"float v(time, lat, lon) ; v:units = \"m/s\" ; v:_FillValue = -99.f", "char v(time, lat, lon)"}});
         const auto at = cdl.find("  u = ");
         const std::string letters(48, 'x');
         post.put_cdl("newer.nc", cdl.substr(0, at) + "u = \"" + letters + "\" ; v = \"" + letters + "\" ; }");
       },
       "it has none with two dimensions"},
      edited("two eastward velocities",
             {{"v:_FillValue = -99.f ;",
               "v:_FillValue = -99.f ; u:standard_name = \"eastward_sea_water_velocity\" ; v:standard_name = "
               "\"northward_sea_water_velocity\" ; float a(time, lat, lon) ; a:standard_name = "
               "\"eastward_sea_water_velocity\" ; float b(time, lat, lon) ; b:standard_name = "
               "\"northward_sea_water_velocity\" ;"},
              {"float u(", "float p("},
              {"u:units", "p:units"},
              {"u:_Fill", "p:_Fill"},
              {"u:standard", "p:standard"},
              {"float v(", "float q("},
              {"v:units", "q:units"},
              {"v:_Fill", "q:_Fill"},
              {"v:standard", "q:standard"},
              {"  u = ", "  p = "},
              {"  v = ", "  q = "}},
             "several eastward velocities (p, a)"),
      edited("an unstructured mesh",
             {{"lat = 3 ; lon = 4", "node = 12"},
              {"double lat(lat)", "double lat(node)"},
              {"double lon(lon)", "double lon(node)"},
              {"u(time, lat, lon)", "u(time, node)"},
              {"v(time, lat, lon)", "v(time, node)"},
              {"lat = 27, 28, 29", "lat = 27, 27, 27, 27, 28, 28, 28, 28, 29, 29, 29, 29"},
              {"lon = -17, -16, -15, -14", "lon = -17, -16, -15, -14, -17, -16, -15, -14, -17, -16, -15, -14"}},
             "unstructured grid"),
  };
}

std::vector<Row> axes_that_lead_nowhere() {
  return {
      edited("latitude beyond the pole", {{"lat = 27, 28, 29", "lat = 89, 90, 91"}},
             "latitude 91 in lat, allowed is -90 to 90"),
      edited("latitudes that turn round", {{"lat = 27, 28, 29", "lat = 27, 29, 28"}},
             "axis lat neither ascends nor descends at index 2"),
      edited("a latitude that is no number", {{"lat = 27, 28, 29", "lat = 27, NaN, 29"}},
             "axis lat has no value at index 1"),
      edited("one latitude alone", {{"lat = 3", "lat = 1"}, {"lat = 27, 28, 29", "lat = 27"}},
             "axis lat has one value"),
      edited("the same longitude twice", {{"lon = -17, -16, -15, -14", "lon = -17, -16, -16, -14"}},
             "axis lon neither ascends nor descends at index 2"),
      edited("a longitude that is missing", {{"lon = -17, -16, -15, -14", "lon = -17, NaN, -15, -14"}},
             "axis lon has no value at index 1"),
      edited("longitudes of no globe", {{"lon = -17, -16, -15, -14", "lon = 1700, 1600, 1500, 1400"}},
             "longitude 1700 in lon, allowed is -360 to 360"),
      edited("the same time twice", {{"time = 0, 6, 12, 18", "time = 0, 6, 6, 18"}},
             "axis time neither ascends nor descends at index 2"),
      edited("times that jump to and fro", {{"time = 0, 6, 12, 18", "time = 0, 12, 6, 18"}},
             "axis time neither ascends nor descends at index 2"),
      edited("a time that is no number", {{"time = 0, 6, 12, 18", "time = 0, NaN, 12, 18"}},
             "axis time has no value at index 1"),
      edited("times without an epoch", {{"hours since", "hours ; \" ; time:long_name = \"hours from"}},
             "without an epoch; say its epoch with --time-epoch"),
      edited("a calendar that is none", {{"time:units", "time:calendar = \"mayan\" ; time:units"}},
             "the calendar \"mayan\"; allowed are "),
      edited("a time unit that is none", {{"hours since", "moons since"}}, "the time unit \"moons since "),
      edited("an epoch that is no day", {{"since 20", "since 20-13-45 "}}, "counts from a date that does not exist"),
      {"unlimited, and no record yet",
       [](Post& post) {
         auto cdl = post.newer({{"time = 4", "time = UNLIMITED"}, {"  time = 0, 6, 12, 18 ;\n", ""}});
         const auto at = cdl.find("  u = ");
         post.put_cdl("newer.nc", cdl.substr(0, at) + "}");
       },
       "axis time is empty"},
  };
}

std::vector<Row> sets_that_do_not_fit() {
  return {
      edited("another grid than the rest of the set", {{"lat = 27, 28, 29", "lat = 27, 28.5, 30"}},
             "files that are joined lie on the same grid"),
      edited("another number of columns", {{"lon = 4", "lon = 2"}, {"lon = -17, -16, -15, -14", "lon = -17, -16"}},
             "its longitudes differ from those of "),
      {"no times beside files that have some",
       [](Post& post) {
         auto cdl = post.newer({{"time = 4 ; ", ""},
                                {"float u(time, ", "float u("},
                                {"float v(time, ", "float v("},
                                {"  time = 0, 6, 12, 18 ;\n", ""}});
         const auto begin = cdl.find("  double time"), end = cdl.find("  double lat");
         cdl.erase(begin, end - begin);
         const auto at = cdl.find("  u = ");
         post.put_cdl("newer.nc",
                      cdl.substr(0, at) + "u = " + repeated("0.2", 12) + " ; v = " + repeated("0.1", 12) + " ; }");
       },
       "several files are joined by their times"},
      {"two files of one cycle that contradict each other",
       [](Post& post) {
         const auto reference = [&](const Edits& more) {
           Edits edits = more;
           edits.push_back({"data:", "  :forecast_reference_time = \"2026-11-25T00:00:00Z\" ;\ndata:"});
           return post.newer(edits);
         };
         post.put_cdl("a.nc", reference({}));
         post.put_cdl("b.nc", reference({{"0.110000", "0.91"}}));
         std::filesystem::remove(post.path("good.nc"));
       },
       "contradict"},
      {"a day of the set missing",
       [](Post& post) {
         // good.nc, then a day that is cut, then another: the rest has a hole.
         post.put("newer-1.nc", "CDF\1 cut");
         post.put_cdl("newer-2.nc", replaced(plain(-24, post.now_s), {}));
       },
       "the others have nothing between "},
      {"long expired", [](Post& post) { post.put_cdl("good.nc", replaced(plain(24 * 9, post.now_s), {})); },
       " has expired: its last field is of "},
      {"far in the future", [](Post& post) { post.put_cdl("good.nc", replaced(plain(-24 * 9, post.now_s), {})); },
       " lies in the future: its first field is of "},
  };
}

/// What looks bad and is not: read as it is meant.
std::vector<Row> odd_but_readable() {
  return {
      edited("times that descend", {{"time = 0, 6, 12, 18", "time = 18, 12, 6, 0"}}, "", true),
      edited("longitudes from 0 to 360", {{"lon = -17, -16, -15, -14", "lon = 343, 344, 345, 346"}}, "", true),
      edited("latitudes from north to south", {{"lat = 27, 28, 29", "lat = 29, 28, 27"}}, "", true),
      edited("knots that say so",
             {{"u:units = \"m/s\"", "u:units = \"knot\""}, {"v:units = \"m/s\"", "v:units = \"knot\""}}, "", true),
      edited("no units at all", {{"u:units = \"m/s\" ; ", ""}, {"v:units = \"m/s\" ; ", ""}},
             "u has no unit; taken as m/s", true),
      edited("4 m/s", {{"0.110000", "3.99"}}, "a current of 3.99 m/s at 27.0000, -17.0000", true),
  };
}

}  // namespace

TEST_CASE("every kind of bad forecast is refused in words of its own, and the good one stays in use") {
  std::vector<Row> rows;
  for (auto& some : {things_that_are_no_file(), files_of_another_kind(), numbers_that_are_no_sea(),
                     variables_that_are_none(), axes_that_lead_nowhere(), sets_that_do_not_fit(), odd_but_readable()})
    rows.insert(rows.end(), some.begin(), some.end());
  std::set<std::string> messages;
  std::size_t refused = 0;
  std::ostringstream table;
  for (const auto& row : rows) {
    INFO(row.kind);
    Post post;
    post.put_cdl("good.nc", plain(12, post.now_s));
    post.follow();
    const auto good = post.watch->current();
    REQUIRE(good);
    REQUIRE(post.loaded.size() == 1);
    row.publish(post);
    if (!row.looked) post.look();
    std::string said;
    if (row.read) {
      CAPTURE(post.refused);
      CHECK(post.refused.empty());
      CHECK(post.watch->current() != good);
      CHECK(post.loaded.size() == 2);
      said = "read. " + post.loaded.back();
      CHECK(said.find(row.says) != std::string::npos);
    } else {
      ++refused;
      CAPTURE(good->key->hex(), post.watch->current()->key->hex(), post.loaded, post.refused);
      CHECK(post.watch->current() == good);
      CHECK_FALSE(post.refused.empty());
      if (post.refused.empty()) continue;
      said = post.refused.back();
      CAPTURE(said);
      CHECK(said.find(row.says) != std::string::npos);
      CHECK(said.find('\n') == std::string::npos);
      // The same reason for two kinds of file is one message; where the file lies is not part of it.
      auto plain_words = said;
      for (auto at = plain_words.find(post.scratch.path()); at != std::string::npos;
           at = plain_words.find(post.scratch.path()))
        plain_words.erase(at, post.scratch.path().size() + std::string{"/published/"}.size());
      said = plain_words;
      // Two numbers do not make two messages.
      auto words = plain_words;
      words.erase(std::remove_if(words.begin(), words.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
                  words.end());
      messages.insert(words);
      // Nothing new: no child is started for it, and it is not said again.
      const auto before = post.refused.size();
      if (!row.looked && post.watch->problem() == post.refused.back()) {
        post.watch->look();
        CHECK_FALSE(post.watch->loading());
        CHECK(post.refused.size() == before);
      }
    }
    table << std::left << std::setw(48) << row.kind << said << "\n";
  }
  std::cout << "bad forecasts, what the daemon says of each:\n" << table.str();
  std::cout << "bad forecasts: kinds=" << refused << " messages=" << messages.size()
            << " read=" << rows.size() - refused << "\n";
  CHECK(refused >= 40);
  CHECK(messages.size() >= 50);
}
