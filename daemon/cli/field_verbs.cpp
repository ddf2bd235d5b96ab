#include "daemon/cli/field_verbs.hpp"

#include <iostream>

#include "daemon/cli/field_animate.hpp"
#include "daemon/cli/field_convert.hpp"
#include "daemon/cli/field_diff.hpp"
#include "daemon/cli/field_info.hpp"
#include "daemon/cli/field_sample.hpp"

namespace glidehelm::cli {

namespace {

/// How files are read, where they do not say it themselves or are to be read in another way.
void add_reading(CLI::App* verb, daemon::IngestOptions& ingest) {
  verb->add_option_function<std::string>(
      "--variables",
      [&ingest](const std::string& text) {
        const auto comma = text.find(',');
        if (comma == std::string::npos || comma == 0 || comma + 1 == text.size())
          throw CLI::ValidationError{"--variables", "allowed is EAST,NORTH"};
        ingest.east = text.substr(0, comma);
        ingest.north = text.substr(comma + 1);
      },
      "EAST,NORTH: names of the velocity variables");
  verb->add_option_function<std::string>(
      "--time-epoch", [&ingest](const std::string& text) { ingest.time_epoch = time_from(text, "--time-epoch"); },
      "Time 0 of a time axis that does not say it, UTC");
  verb->add_option("--heights", ingest.heights, "Currents from the slope of the sea surface")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  verb->add_option_function<double>(
          "--equator-band", [&ingest](double value) { ingest.equator_band_deg = value; },
          "Degrees of latitude within which that slope says nothing (default 5)")
      ->check(CLI::Range(0.0, 90.0));
  verb->add_option_function<double>(
          "--fill-gaps", [&ingest](double value) { ingest.fill_gaps_km = value; },
          "Km up to which gaps of surface currents are filled (default: two cells of HF radar)")
      ->check(CLI::Range(0.0, 500.0));
  verb->add_option("--grid-file", ingest.grid_file, "A model's grid that lies apart from its forecasts");
  verb->add_option("--rotation", ingest.rotation,
                   "Velocities on a turned grid: along its axes, turned by its angle or by the grid; or none of both")
      ->check(CLI::IsMember({"angle", "grid", "none"}));
  verb->add_option("--s-levels", ingest.s_levels,
                   "ROMS levels that the files do not describe: vtransform=,vstretching=,theta_s=,theta_b=,hc=");
  verb->add_option_function<std::uint32_t>(
          "--member", [&ingest](std::uint32_t member) { ingest.member = member; },
          "Member of an ensemble, counted from 0 in the order of the file (default 0)")
      ->check(CLI::Range(0, 99'999));
}

void add_info(CLI::App* field, Action& action) {
  auto info = std::make_shared<FieldInfoOptions>();
  auto* verb = field->add_subcommand("info", "Variables recognised and why, grid, times, depths, speeds, warnings");
  verb->add_option("FILE", info->files, "NetCDF files or shell patterns; several join into one field")->required();
  add_reading(verb, info->ingest);
  verb->add_flag("--json", info->json, "One JSON document on standard output");
  verb->callback(
      [info, &action] { action = [info](world::World& w) { return run_field_info(*info, w, std::cout, std::cerr); }; });
}

void add_sample(CLI::App* field, Action& action) {
  struct Words {
    FieldSampleOptions options;
    double lat{}, lon{}, depth{};
    std::string time, mean;
  };
  auto o = std::make_shared<Words>();
  auto* sample = field->add_subcommand("sample", "The current at a place, or at every place of a CSV");
  sample->add_option("FILE", o->options.files, "NetCDF files or shell patterns")->required();
  auto* lat = sample->add_option("--lat", o->lat, "Latitude, degrees");
  auto* lon = sample->add_option("--lon", o->lon, "Longitude, degrees");
  auto* time = sample->add_option("--time", o->time, "UTC");
  auto* depth = sample->add_option("--depth", o->depth, "Metres below the surface (default: the shallowest level)");
  auto* mean = sample->add_option("--depth-mean", o->mean, "MIN,MAX: mean between two depths, metres");
  sample
      ->add_option_function<std::string>(
          "--interpolation",
          [o](const std::string& word) {
            using enum ocean::Interpolation;
            o->options.interpolation = word == "nearest" ? nearest
                                       : word == "cubic" ? cubic
                                       : word == "akima" ? akima
                                                         : linear;
          },
          "Between nodes (default linear); cubic and akima are smooth in depth and time")
      ->check(CLI::IsMember({"nearest", "linear", "cubic", "akima"}));
  add_reading(sample, o->options.ingest);
  sample->add_option("--points", o->options.points, "CSV of lat,lon,time[,depth]");
  sample
      ->add_option("--members", o->options.members,
                   "Mean and spread of the members 0 to N - 1 too; the value stays that of member 0")
      ->check(CLI::Range(1, 100'000));
  sample->add_flag("--json", o->options.json, "One JSON document on standard output");
  sample->callback([=, &action] {
    if (*lat) o->options.lat_deg = o->lat;
    if (*lon) o->options.lon_deg = o->lon;
    if (*time) o->options.time = time_from(o->time, "--time");
    if (*depth) o->options.depth_m = o->depth;
    if (*mean) o->options.depth_mean = pair_from(o->mean, "--depth-mean");
    action = [o](world::World& w) { return run_field_sample(o->options, w, std::cout, std::cerr); };
  });
}

void add_diff(CLI::App* field, Action& action) {
  auto o = std::make_shared<FieldDiffOptions>();
  auto* verb = field->add_subcommand("diff", "How B differs from A on the nodes of A: rms, bias, correlation, largest");
  verb->add_option("A", o->a, "A file, an address or a shell pattern (quoted)")->required();
  verb->add_option("B", o->b, "Likewise")->required();
  verb->add_option("--tolerance", o->tolerance, "m/s that a current may differ by (default 0); more is exit 1")
      ->check(CLI::NonNegativeNumber);
  add_reading(verb, o->ingest);
  verb->add_flag("--json", o->json, "One JSON document on standard output");
  verb->callback(
      [o, &action] { action = [o](world::World& w) { return run_field_diff(*o, w, std::cout, std::cerr); }; });
}

/// "W/E/S/N".
daemon::IngestOptions::Area box_from(const std::string& text) {
  double sides[4]{};
  std::size_t at = 0;
  for (int k = 0; k < 4; ++k) {
    const auto end = k < 3 ? text.find('/', at) : text.size();
    const auto number =
        end == std::string::npos ? std::nullopt : number_from(trimmed(std::string_view{text}.substr(at, end - at)));
    if (!number) throw CLI::ValidationError{"--box", "'" + text + "' is not W/E/S/N in degrees, as -19/-12/26.5/30"};
    sides[k] = *number;
    at = end + 1;
  }
  return {sides[0], sides[1], sides[2], sides[3]};
}

void add_convert(CLI::App* field, Action& action) {
  struct Words {
    FieldConvertOptions options;
    std::string box, mean, times;
  };
  auto o = std::make_shared<Words>();
  auto* verb =
      field->add_subcommand("convert", "Write what was read as clean CF NetCDF (.nc) or as a flat grid (.grid)");
  verb->add_option("FILE", o->options.files, "NetCDF files or shell patterns; several join into one field")->required();
  verb->add_option("-o,--out", o->options.out, "A new file, .nc or .grid")->required();
  auto* box = verb->add_option("--box", o->box, "W/E/S/N: the part to keep, degrees");
  auto* mean = verb->add_option("--depth-mean", o->mean, "MIN,MAX: one level, the mean between two depths, metres");
  auto* times = verb->add_option("--times", o->times, "FROM,TO: the times to keep, UTC; either may be empty");
  add_reading(verb, o->options.ingest);
  verb->callback([=, &action] {
    if (*box) o->options.ingest.area = box_from(o->box);
    if (*mean) o->options.depth_mean = pair_from(o->mean, "--depth-mean");
    if (*times) {
      const auto comma = o->times.find(',');
      if (comma == std::string::npos)
        throw CLI::ValidationError{"--times",
                                   "'" + o->times + "' is not FROM,TO, as 2026-11-25T00:00Z,2026-11-26T00:00Z"};
      if (comma > 0) o->options.from = time_from(o->times.substr(0, comma), "--times");
      if (comma + 1 < o->times.size()) o->options.to = time_from(o->times.substr(comma + 1), "--times");
    }
    action = [o](world::World& w) { return run_field_convert(o->options, w, std::cout, std::cerr); };
  });
}

void add_animate(CLI::App* field, Action& action) {
  auto o = std::make_shared<FieldAnimateOptions>();
  auto* verb = field->add_subcommand("animate", "A page (.html) or a map (.kml) that plays");
  verb->add_option("FILE", o->files, "NetCDF files or shell patterns; several join into one field")->required();
  verb->add_option("-o,--out", o->out, "A new file, .html or .kml")->required();
  verb->add_option("--coast", o->coast, "A .coast file to draw (glidehelm coast)");
  verb->add_option_function<double>(
      "--depth", [o](double depth) { o->depth_m = depth; },
      "Draws the level nearest to this depth, metres (default: the shallowest)");
  add_reading(verb, o->ingest);
  verb->callback(
      [o, &action] { action = [o](world::World& w) { return run_field_animate(*o, w, std::cout, std::cerr); }; });
}

}  // namespace

void add_field(CLI::App& app, Action& action) {
  auto* field = app.add_subcommand("field", "What a forecast is, what it says at a place, and how two differ");
  field->require_subcommand(1);
  add_info(field, action);
  add_sample(field, action);
  add_diff(field, action);
  add_convert(field, action);
  add_animate(field, action);
}

}  // namespace glidehelm::cli
