#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/ingest/join.hpp"
#include "daemon/ingest/opendap.hpp"
#include "daemon/world/real_files.hpp"
#include "daemon/world/real_rng.hpp"

// glidehelm-ingest FILE… -o GRID: published forecasts in, one flat grid out. Exit 0 done, 1 refused, 2 usage.

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

constexpr std::size_t kFileAtMost = std::size_t{8} << 30;

struct Arguments {
  std::vector<std::string> files;
  std::string output, variables, epoch, area, heights, equator_band, fill_gaps;
};

int refuse(const std::string& what) {
  std::cerr << "glidehelm-ingest: " << what << '\n';
  return 1;
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

/// A private copy of a file that did not change while it was read.
Expected<std::string, std::string> read_whole(world::Files& files, const std::string& path) {
  const auto before = files.stat(path);
  if (!before) return unexpected(before.error().message());
  if (!before->regular) return unexpected(std::string{"not a regular file"});
  auto bytes = files.read(path, kFileAtMost);
  if (!bytes) return unexpected(bytes.error().message());
  const auto behind = files.stat(path);
  if (!behind) return unexpected(behind.error().message());
  if (before->size != behind->size || before->modified_ns != behind->modified_ns || before->inode != behind->inode ||
      bytes->size() != before->size)
    return unexpected(std::string{"changed while it was read: it is still being written"});
  return std::move(*bytes);
}

/// Writes beside the target under a name of our own and renames: nobody ever sees half a grid.
world::FileResult<Done> write_file(world::Files& files, world::Rng& rng, const std::string& path,
                                   const std::string& bytes) {
  const auto slash = path.rfind('/');
  const std::string folder_path = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
  const std::string name = path.substr(slash == std::string::npos ? 0 : slash + 1);
  auto folder = files.open_folder(folder_path);
  if (!folder) return unexpected(folder.error());
  const std::string staged = "." + name + "." + std::to_string(rng.next());
  if (auto made = (*folder)->create(staged, bytes, 0644); !made) return unexpected(made.error());
  if (auto renamed = (*folder)->rename_over(staged, **folder, name); !renamed) {
    (void)(*folder)->unlink(staged);
    return renamed;
  }
  return (*folder)->sync();
}

int run(const Arguments& arguments) {
  ReadOptions options;
  if (const auto wrong = read_options(arguments, options)) return misuse(*wrong);
  world::RealFiles files;
  world::RealRng rng;
  const auto units = Units::load();
  if (!units) return refuse(units.error().what);

  std::vector<Part> parts;
  for (const auto& name : arguments.files) {
    if (is_address(name)) {
      auto part = read_address(name, *units, options);
      if (!part) return refuse(name + ": " + part.error().what);
      parts.push_back(std::move(*part));
      continue;
    }
    const auto bytes = read_whole(files, name);
    if (!bytes) return refuse(name + ": " + bytes.error());
    auto part = read_part(name, std::as_bytes(std::span{bytes->data(), bytes->size()}), *units, options);
    if (!part) return refuse(name + ": " + part.error().what);
    parts.push_back(std::move(*part));
  }
  auto whole = pair_halves(std::move(parts));
  if (!whole) return refuse(whole.error().what);
  const auto grid = join(std::move(*whole));
  if (!grid) return refuse(grid.error().what);
  for (const auto& warning : grid->facts.warnings) std::cerr << "glidehelm-ingest: warning: " << warning << '\n';
  const std::string bytes = ocean::write_grid(*grid);
  if (const auto view = ocean::open_grid(std::as_bytes(std::span{bytes.data(), bytes.size()})); !view)
    return refuse("the grid made of " + arguments.files.front() + " is not sound, " + view.error().message());
  if (auto written = write_file(files, rng, arguments.output, bytes); !written)
    return refuse(arguments.output + ": " + written.error().message());
  return 0;
}

}  // namespace

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
  app.add_option("--fill-gaps", arguments.fill_gaps,
                 "km within which gaps of surface currents are filled (default: two cells of HF radar files)");
  app.add_option("--area", arguments.area, "part to keep, degrees: W/E/S/N");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    return run(arguments);
  } catch (const std::bad_alloc&) {
    return refuse(arguments.files.front() + ": needs more memory than there is");
  } catch (const std::exception& error) {  // a bug of ours, but this program must answer in its own words
    return refuse(arguments.files.front() + ": " + error.what());
  }
}
