#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/base/one_line.hpp"
#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/ingest/depth_file.hpp"
#include "daemon/ingest/join.hpp"
#include "daemon/ingest/opendap.hpp"
#include "daemon/ingest/read_files.hpp"
#include "daemon/ingest/sandbox.hpp"
#include "daemon/ingest/sources.hpp"
#include "daemon/world/real_files.hpp"
#include "daemon/world/real_rng.hpp"

// glidehelm-ingest FILE… -o GRID: published forecasts in, one flat grid out. Exit 0 done, 1 refused, 2 usage, 3 more memory
// is needed than there is, 4 refused before (--refused-before), 5 not to be had now: a later try may succeed.
//
// glidehelm-ingest --bathymetry FILE -o DEPTHS: a bathymetry in, a `.depth` file (core/chart/bathymetry.hpp) out. Exit 0, 1, 2, 3.
//
// With --tell, what it is doing stands on standard output, so that whoever started it knows which file it died of:
//   source N SHA256 DEVICE INODE SIZE MODIFIED_NS CHANGED_NS    file N (from 0) was copied; it looked like that. Of an
//                                                               address: it was read, and there was nothing to look at
//   copying N / reading N / joining / writing                   what comes next

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

constexpr std::uint64_t kFileAtMost = 4'000'000'000, kKeptAtMost = std::uint64_t{512} << 20;
constexpr std::size_t kRefusedListAtMost = std::size_t{4} << 20;

struct Arguments {
  std::vector<std::string> files, grid_files;
  std::string output, variables, epoch, area, heights, equator_band, fill_gaps, rotation, s_levels;
  double settle_s{};
  std::optional<std::size_t> member;
  std::string positive, crs, depth_variable;
  bool refused_before{}, tell{}, bathymetry{};
};

/// Says what comes next, at once: the next thing may be the last.
class Story {
 public:
  explicit Story(bool told) : told_{told} {}
  void tell(const std::string& what) const {
    if (told_) std::cout << what << std::endl;
  }

 private:
  bool told_;
};

constexpr int kRefused = 1, kMemory = 3, kRefusedBefore = 4, kNotNow = 5;

int refuse(const std::string& what) {
  std::cerr << "glidehelm-ingest: " << one_line(what) << '\n';
  return kRefused;
}
int misuse(const std::string& what) {
  std::cerr << "glidehelm-ingest: " << what << '\n';
  return 2;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// How a model's own grid is read; a message when one of them cannot be read.
std::optional<std::string> read_model_options(const Arguments& arguments, ReadOptions& options) {
  const std::string& word = arguments.rotation;
  if (word == "angle")
    options.turning = Turning::angle;
  else if (word == "grid")
    options.turning = Turning::grid;
  else if (word == "none")
    options.turning = Turning::none;
  else if (!word.empty())
    return "--rotation " + word + ": allowed is angle, grid or none";
  if (arguments.s_levels.empty()) return std::nullopt;
  const auto choice = stretching_choice_from(arguments.s_levels);
  if (!choice) return "--s-levels: " + choice.error().what;
  options.stretching = *choice;
  return std::nullopt;
}

/// The options in their types; a message when one of them cannot be read.
std::optional<std::string> read_options(const Arguments& arguments, ReadOptions& options) {
  if (!arguments.variables.empty()) {
    const auto names = split(arguments.variables, ',');
    if (names.size() != 2 || names[0].empty() || names[1].empty())
      return "--variables " + arguments.variables + ": allowed is EAST,NORTH";
    options.east = names[0];
    options.north = names[1];
  }
  if (!arguments.epoch.empty()) {
    options.time_epoch = utc_from_text(arguments.epoch);
    if (!options.time_epoch) return "--time-epoch " + arguments.epoch + ": allowed is a time like 2000-01-01T00:00:00Z";
  }
  using Heights = ReadOptions::Heights;
  if (arguments.heights == "always")
    options.heights = Heights::always;
  else if (arguments.heights == "never")
    options.heights = Heights::never;
  else if (!arguments.heights.empty() && arguments.heights != "auto")
    return "--heights " + arguments.heights + ": allowed are auto, always, never";
  if (!arguments.equator_band.empty()) {
    const auto degrees = number_from(arguments.equator_band);
    if (!degrees || *degrees < 0 || *degrees > 90)
      return "--equator-band " + arguments.equator_band + ": allowed is 0 to 90 degrees";
    options.equator_band_deg = *degrees;
  }
  if (!arguments.fill_gaps.empty()) {
    const auto km = number_from(arguments.fill_gaps);
    if (!km || *km < 0 || *km > 500) return "--fill-gaps " + arguments.fill_gaps + ": allowed is 0 to 500 km";
    options.fill_gaps_m = *km * 1000;
  }
  options.member = arguments.member;
  if (auto wrong = read_model_options(arguments, options)) return wrong;
  if (arguments.area.empty()) return std::nullopt;
  std::vector<double> edges;
  for (const auto& part : split(arguments.area, '/'))
    if (const auto value = number_from(part)) edges.push_back(*value);
  const std::string allowed =
      "--area " + arguments.area +
      ": allowed is W/E/S/N in degrees, west and east within -180 to 360, south below north within -90 to 90";
  if (edges.size() != 4 || split(arguments.area, '/').size() != 4) return allowed;
  Area area{edges[0], edges[1], edges[2], edges[3]};
  if (area.east < area.west) area.east += 360;  // across the antimeridian
  const bool fits = area.west >= -180 && area.west <= 360 && area.east <= 540 && area.east > area.west &&
                    area.east - area.west <= 360 && area.south >= -90 && area.north <= 90 && area.south < area.north;
  if (!fits) return allowed;
  options.area = area;
  return std::nullopt;
}

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

/// Writes beside the target under a name of our own and renames: nobody ever sees half a grid.
world::FileResult<Done> write_file(world::Files& files, world::Rng& rng, const std::string& path,
                                   const std::string& bytes) {
  const auto slash = path.rfind('/');
  const std::string name = path.substr(slash == std::string::npos ? 0 : slash + 1);
  auto folder = files.open_folder(folder_of(path));
  if (!folder) return unexpected(folder.error());
  const std::string staged = "." + name + "." + std::to_string(rng.next());
  if (auto made = (*folder)->create(staged, bytes, 0644); !made) return unexpected(made.error());
  if (auto renamed = (*folder)->rename_over(staged, **folder, name); !renamed) {
    (void)(*folder)->unlink(staged);
    return renamed;
  }
  return (*folder)->sync();
}

void tell_source(const Story& story, const Sources& sources, std::size_t i) {
  const auto stat = sources.stat(i);
  std::string line = "source " + std::to_string(i) + " " + sources.identities()[i].hash.hex();
  for (const auto number : {stat.device, stat.inode, stat.size}) line += " " + std::to_string(number);
  for (const auto number : {stat.modified_ns, stat.changed_ns}) line += " " + std::to_string(number);
  story.tell(line);
}

int refuse(const Sources& sources, const SourceFault& fault) {
  const auto code = refuse(sources.name(fault.file) + ": " + fault.what);
  return fault.passing ? kNotNow : code;
}

/// The contents of which standard input says that they were refused before: one SHA-256 a line, of one file or over the
/// hashes of a set.
std::set<std::string> refused_before(world::Files& files) {
  std::set<std::string> hashes;
  const auto text = files.read_descriptor(0, kRefusedListAtMost);
  if (text)
    for (auto& line : split(*text, '\n')) hashes.insert(std::move(line));
  return hashes;
}

/// 4 when the whole set, or one of its files, is known to be bad.
int look_up(const Story& story, const Sources& sources, const std::set<std::string>& known) {
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (known.count(ocean::provenance_of({sources.identities()[i]}).hex()) != 0) {
      story.tell("reading " + std::to_string(i));
      return kRefusedBefore;
    }
  if (known.count(ocean::provenance_of(sources.identities()).hex()) == 0) return 0;
  story.tell("joining");
  return kRefusedBefore;
}

/// Files that cannot be opened have no `Sources` to be named by.
int refuse_to_open(const Story& story, const std::vector<std::string>& names, const SourceFault& fault) {
  story.tell("copying " + std::to_string(fault.file));
  const int code = refuse(names[fault.file] + ": " + fault.what);
  return fault.passing ? kNotNow : code;
}

Expected<std::vector<Part>, int> read_parts(const Story& story, Sources& sources, std::size_t grid_files,
                                            const Units& units, const ReadOptions& options) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sources.size(); ++i) names.push_back(sources.name(i));
  std::optional<SourceFault> not_had;
  FileAccess access;
  access.tell = [&](std::size_t i) { story.tell("reading " + std::to_string(i)); };
  access.load = [&](std::size_t i) -> Result<std::string> {
    auto bytes = sources.take(i);
    if (bytes) return std::move(*bytes);
    not_had = bytes.error();
    return fault(bytes.error().what);
  };
  access.read_address = [&](std::size_t i) -> Result<Part> {
    auto part = read_address(sources.name(i), units, options);
    if (!part) {
      not_had = SourceFault{i, part.error().what, part.error().passing};
      return fault(part.error().what);
    }
    sources.identify(i, part->grid.facts.sources.front().hash);
    tell_source(story, sources, i);
    return std::move(*part);
  };
  auto parts = read_files(names, grid_files, access, units, options);
  if (parts) return std::move(*parts);
  if (not_had) return unexpected(refuse(sources, *not_had));
  // A fault of the set is none of the file that was read last; of a set of one, nothing may be remembered: tomorrow the
  // file that it lacks may lie beside it.
  if (parts.error().alone) story.tell("joining");
  const int code = refuse(parts.error().what);
  return unexpected(parts.error().alone && names.size() == 1 ? kNotNow : code);
}

/// Names and units are a stranger's words: from here on they stand in logs.
void clean_words(ocean::GridFacts& facts) {
  for (std::string* text : {&facts.cycle, &facts.east_variable, &facts.north_variable, &facts.east_unit,
                            &facts.north_unit, &facts.recognised_by, &facts.time_unit, &facts.layout})
    *text = one_line(*text);
  for (auto& warning : facts.warnings) warning = one_line(warning);
  facts.water.words = one_line(facts.water.words);
}

int run(const Arguments& arguments) {
  ReadOptions options;
  if (const auto wrong = read_options(arguments, options)) return misuse(*wrong);
  const Story story{arguments.tell};
  world::RealFiles files;
  world::RealRng rng;
  const auto units = Units::load();
  if (!units) return refuse(units.error().what);
  const auto known = arguments.refused_before ? refused_before(files) : std::set<std::string>{};
  auto names = arguments.files;
  names.insert(names.end(), arguments.grid_files.begin(), arguments.grid_files.end());
  auto sources = Sources::open(names, kFileAtMost, is_address);
  if (!sources) return refuse_to_open(story, names, sources.error());
  const bool network = std::any_of(names.begin(), names.end(), is_address);
  if (auto entered = enter_sandbox(folder_of(arguments.output), network); !entered) return refuse(entered.error());

  if (auto identified = sources->identify(Seconds{arguments.settle_s}, kKeptAtMost); !identified) {
    story.tell("copying " + std::to_string(identified.error().file));
    return refuse(*sources, identified.error());
  }
  for (std::size_t i = 0; i < sources->size(); ++i)
    if (!sources->is_elsewhere(i)) tell_source(story, *sources, i);
  if (const int code = look_up(story, *sources, known); code != 0) return code;
  auto parts = read_parts(story, *sources, arguments.grid_files.size(), *units, options);
  if (!parts) return parts.error();
  story.tell("joining");
  auto grid = join(std::move(*parts));
  if (!grid) return refuse(grid.error().what);
  grid->facts.sources = sources->identities();  // in the order of the arguments, a model's grid with them
  clean_words(grid->facts);
  for (const auto& warning : grid->facts.warnings) std::cerr << "glidehelm-ingest: warning: " << warning << '\n';
  story.tell("writing");
  const std::string bytes = ocean::write_grid(*grid);
  if (const auto view = ocean::open_grid(std::as_bytes(std::span{bytes.data(), bytes.size()})); !view)
    return refuse("the grid made of " + arguments.files.front() + " is not sound, " + view.error().message());
  if (auto written = write_file(files, rng, arguments.output, bytes); !written) {
    refuse(arguments.output + ": " + written.error().message());
    return kNotNow;
  }
  return 0;
}

constexpr std::size_t kPrjAtMost = 65'536;

/// Reads one bathymetry behind the same walls, and says what was decided about it.
int run_bathymetry(const Arguments& arguments) {
  ReadOptions common;
  if (const auto wrong = read_options(arguments, common)) return misuse(*wrong);
  if (arguments.files.size() != 1) return misuse("--bathymetry takes one FILE");
  DepthOptions options;
  using Positive = DepthOptions::Positive;
  options.positive = arguments.positive == "up"     ? Positive::up
                     : arguments.positive == "down" ? Positive::down
                                                    : Positive::unknown;
  options.crs = arguments.crs;
  options.variable = arguments.depth_variable;
  options.area = common.area;
  world::RealFiles files;
  world::RealRng rng;
  const auto units = Units::load();
  if (!units) return refuse(units.error().what);
  const std::string& name = arguments.files.front();
  const auto dot = name.rfind('.');
  if (auto prj = files.read(name.substr(0, dot) + ".prj", kPrjAtMost)) options.prj = std::move(*prj);
  auto sources = Sources::open(arguments.files, kFileAtMost);
  if (!sources) return refuse(name + ": " + sources.error().what);
  if (auto entered = enter_sandbox(folder_of(arguments.output), false); !entered) return refuse(entered.error());
  if (auto identified = sources->identify(Seconds{arguments.settle_s}, kKeptAtMost); !identified)
    return refuse(*sources, identified.error());
  const auto bytes = sources->take(0);
  if (!bytes) return refuse(*sources, bytes.error());
  auto grid = read_depths(*bytes, options, *units);
  if (!grid) return refuse(name + ": " + grid.error().what);
  grid->source += ", sha256 " + sources->identities().front().hash.hex();
  if (auto written = write_file(files, rng, arguments.output, chart::Bathymetry::text_of(*grid)); !written)
    return refuse(arguments.output + ": " + written.error().message());
  std::size_t known = 0;
  float shoalest = std::numeric_limits<float>::infinity(), deepest = -shoalest;
  for (const float depth : grid->depths_m)
    if (!std::isnan(depth)) {
      ++known;
      shoalest = std::min(shoalest, depth);
      deepest = std::max(deepest, depth);
    }
  std::cout << one_line(name) << ": " << grid->source << "\n  " << grid->decided << "\n  " << grid->columns << " by "
            << grid->rows << " nodes from " << grid->west_deg << " E, " << grid->south_deg << " N, steps "
            << grid->lon_step_deg << ", " << grid->lat_step_deg << " degrees; depths " << shoalest << " to " << deepest
            << " m; " << known << " of " << grid->depths_m.size() << " nodes known\n";
  return 0;
}

}  // namespace

#if defined(GLIDEHELM_SANITIZED_ADDRESS)
// libnetcdf and HDF5 keep what they had read of a damaged file when they give up; this process ends then. Our own leaks count.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libnetcdf\nleak:libhdf5\n"; }
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

int main(int argc, char** argv) {
  CLI::App app{"Reads CF NetCDF currents and writes one flat grid.", "glidehelm-ingest"};
  Arguments arguments;
  app.add_option("FILE", arguments.files, "NetCDF files; several are joined in time, the newest cycle wins")
      ->required();
  app.add_option("-o,--output", arguments.output, "grid to write (replaced by rename)")->required();
  app.add_option("--variables", arguments.variables, "names of the velocity variables: EAST,NORTH");
  app.add_option("--time-epoch", arguments.epoch, "epoch of a time axis whose unit names none, UTC");
  app.add_option("--heights", arguments.heights,
                 "currents from the height of the sea surface: auto (where there is no velocity), always, never");
  app.add_option("--equator-band", arguments.equator_band, "degrees of latitude within which heights say nothing");
  app.add_option("--settle", arguments.settle_s,
                 "seconds that a file must have been left alone; a younger one is waited for")
      ->check(CLI::Range(0.0, 600.0));
  app.add_flag("--refused-before", arguments.refused_before,
               "standard input has one SHA-256 a line: contents that are refused without reading them again");
  app.add_flag("--tell", arguments.tell,
               "say on standard output what is being done, for the program that started this one");
  app.add_option("--fill-gaps", arguments.fill_gaps,
                 "km within which gaps of surface currents are filled (default: two cells of HF radar files)");
  app.add_option("--grid-file", arguments.grid_files,
                 "a model's grid: positions, masks, angle, depth (found among the files too)")
      ->expected(1);
  app.add_option("--rotation", arguments.rotation,
                 "velocities along a model's axes, turned by its angle or by its grid; or none: east and north");
  app.add_option("--s-levels", arguments.s_levels,
                 "s-levels that the files do not describe: vtransform=,vstretching=,theta_s=,theta_b=,hc=");
  app.add_option("--member", arguments.member, "member of an ensemble, counted from 0 in the order of the file")
      ->check(CLI::Range(0, 99'999));
  app.add_flag("--bathymetry", arguments.bathymetry,
               "FILE holds depths (NetCDF or ESRI ASCII): write the depth file that safety.bathymetry names");
  app.add_option("--positive", arguments.positive,
                 "with --bathymetry: what its numbers mean: up (heights), down (depths)")
      ->check(CLI::IsMember({"up", "down"}));
  app.add_option("--crs", arguments.crs,
                 "with --bathymetry: where an ASCII grid lies: degrees, utm33n, EPSG:32633 (else its .prj file)");
  app.add_option("--depth-variable", arguments.depth_variable, "with --bathymetry: name of the variable");
  app.add_option("--area", arguments.area, "part to keep, degrees: W/E/S/N");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    return arguments.bathymetry ? run_bathymetry(arguments) : run(arguments);
  } catch (const std::bad_alloc&) {
    refuse(arguments.files.front() + ": needs more memory than there is");
    return kMemory;
  } catch (const std::exception& error) {  // a bug of ours, but this program must answer in its own words
    return refuse(arguments.files.front() + ": " + error.what());
  }
}
