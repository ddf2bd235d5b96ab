#include "daemon/cli/mafile.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/mafile.hpp"
#include "protocol/mafile_b_args.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;
using protocol::Mafile;
using protocol::Severity;

void print_json(const Mafile& file, std::ostream& out) {
  Json j{{"behavior", file.behavior.empty() ? Json(nullptr) : Json(file.behavior)},
         {"b_args", Json::array()},
         {"waypoints", Json::array()},
         {"valid", file.valid()},
         {"problems", Json::array()}};
  for (const auto& arg : file.b_args)
    j["b_args"].push_back({{"name", arg.name},
                           {"value", arg.value ? Json(*arg.value) : Json(nullptr)},
                           {"unit", arg.unit},
                           {"line", arg.line}});
  for (const auto& waypoint : file.waypoints)
    j["waypoints"].push_back({{"lat_deg", waypoint.at ? Json(waypoint.at->lat.degrees()) : Json(nullptr)},
                              {"lon_deg", waypoint.at ? Json(waypoint.at->lon.degrees()) : Json(nullptr)},
                              {"line", waypoint.line}});
  for (const auto& problem : file.problems)
    j["problems"].push_back({{"line", problem.line},
                             {"column", problem.column},
                             {"code", problem.code},
                             {"severity", problem.severity == Severity::error ? "error" : "warning"},
                             {"message", problem.message}});
  // Units are bytes of the file; one that is not UTF-8 must not end the document.
  out << j.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

void print_text(const std::string& name, const Mafile& file, std::ostream& out, std::ostream& err) {
  out << name << ": " << (file.behavior.empty() ? "no behaviour" : file.behavior) << ", " << file.b_args.size()
      << " b_args, " << file.waypoints.size() << " waypoints, " << (file.valid() ? "valid" : "not valid") << '\n';
  for (const auto& arg : file.b_args)
    out << "  " << arg.name << " = " << arg.text << (arg.unit.empty() ? "" : " " + arg.unit) << '\n';
  for (const auto* rule : protocol::b_arg_rules(file.behavior))
    if (rule->fallback && file.b_arg(rule->name) == nullptr)
      out << "  " << rule->name << " = " << *rule->fallback << " " << rule->unit
          << " (not given: masterdata's default)\n";
  int number = 0;
  for (const auto& waypoint : file.waypoints) {
    char text[96] = "no position";
    if (waypoint.at)
      std::snprintf(text, sizeof text, "%.6f, %.6f", waypoint.at->lat.degrees(), waypoint.at->lon.degrees());
    out << "  waypoint " << ++number << ": " << text << " (line " << waypoint.line << ")\n";
  }
  for (const auto& problem : file.problems) err << name << ": " << problem.text() << '\n';
}

}  // namespace

int run_mafile(const MafileOptions& options, world::Files& files, std::ostream& out, std::ostream& err) {
  if (options.file.empty()) {
    err << "mafile: name a file\n";
    return 2;
  }
  const auto bytes = files.read(options.file, protocol::kLargestMafile);
  if (!bytes) {
    err << options.file << ": cannot be read: " << bytes.error().message() << '\n';
    return 1;
  }
  protocol::MafileOptions reading;
  reading.near = options.near;
  if (options.strict) reading.mode = protocol::MafileOptions::Mode::strict;
  const auto file = protocol::read_mafile(*bytes, reading);
  options.json ? print_json(file, out) : print_text(options.file, file, out, err);
  return file.valid() ? 0 : 1;
}

}  // namespace glidehelm::cli
