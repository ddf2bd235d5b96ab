#include "daemon/cli/check.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "config/areas.hpp"
#include "config/daemon.hpp"
#include "config/load.hpp"
#include "config/mission.hpp"
#include "core/base/text.hpp"
#include "daemon/places.hpp"

namespace glidehelm::cli {

namespace {

using config::ConfigError;

struct Report {
  std::string file;
  std::string kind{"unknown"};
  std::vector<ConfigError> problems;
  std::string summary;  ///< of a right file
  std::string effective;
};

class Checker {
 public:
  explicit Checker(world::World& world)
      : sources_{[&world](const std::string& path) -> Expected<std::string, config::Unreadable> {
                   // GeoJSON may be larger than any YAML file; each reader has its own limit below this one.
                   auto bytes = world.files.read(path, config::kLargestGeoJson);
                   if (!bytes) return unexpected(config::Unreadable{bytes.error().message()});
                   return std::move(*bytes);
                 },
                 [&world](const std::string& pattern) { return world.files.glob(pattern); }},
        places_{world.files} {}

  void check(const std::string& file) {
    if (known(file)) return;
    Report report;
    report.file = file;
    const auto text = sources_.read(file);
    if (!text) {
      report.problems.push_back(at_start(file, "", "cannot be read: " + text.error().reason));
      reports.push_back(std::move(report));
      return;
    }
    const auto schema = schema_of(*text, file, report);
    if (schema == config::kMissionSchema)
      check_mission(*text, std::move(report));
    else if (schema == config::kDaemonSchema)
      check_daemon(*text, std::move(report));
    else
      reports.push_back(std::move(report));
  }

  std::vector<Report> reports;

 private:
  [[nodiscard]] bool known(const std::string& file) const {
    return std::any_of(reports.begin(), reports.end(), [&](const Report& r) { return r.file == file; });
  }

  static ConfigError at_start(const std::string& file, const std::string& key, std::string problem) {
    ConfigError error;
    error.file = file;
    error.key = key;
    error.problem = std::move(problem);
    return error;
  }

  /// What the file says it is; without an answer the reason is in `report`.
  static std::string schema_of(const std::string& text, const std::string& file, Report& report) {
    const auto document = config::read_yaml(text, file);
    const std::vector<std::string> allowed{config::kMissionSchema, config::kDaemonSchema};
    const auto* schema = document.readable ? document.root.find("schema") : nullptr;
    if (schema != nullptr && std::find(allowed.begin(), allowed.end(), schema->text) != allowed.end())
      return schema->text;
    report.problems = document.errors;
    if (!document.readable) return {};
    auto error = at_start(file, "schema",
                          schema == nullptr ? "missing; a file says with it what it is" : "not one of the words");
    error.line = schema == nullptr ? document.root.place.line : schema->place.line;
    error.column = schema == nullptr ? document.root.place.column : schema->place.column;
    error.allowed = allowed[0] + ", " + allowed[1];
    if (schema != nullptr) {
      error.found = config::shown(schema->text);
      if (schema->text.size() <= 64) error.nearest = nearest_word(schema->text, allowed).value_or("");
    }
    report.problems.push_back(std::move(error));
    return {};
  }

  void check_mission(const std::string& text, Report report) {
    report.kind = "mission";
    auto mission = config::read_mission_file(text, report.file, sources_.read);
    if (mission) report.problems = places_.errors_of(mission->mission, text, report.file);
    if (mission) {
      report.summary = "mission " + mission->mission.name + " for glider " + mission->mission.glider + " is right";
      report.effective = std::move(mission->effective);
    } else {
      report.problems = mission.error();
    }
    reports.push_back(std::move(report));
  }

  void check_daemon(const std::string& text, Report report) {
    report.kind = "daemon";
    auto daemon = config::read_daemon_file(text, report.file);
    if (!daemon) {
      report.problems = daemon.error();
      reports.push_back(std::move(report));
      return;
    }
    report.effective = std::move(daemon->effective);
    std::vector<std::string> missions;
    for (const auto& pattern : daemon->config.missions)
      for (const auto& file : sources_.matches(pattern))
        if (std::find(missions.begin(), missions.end(), file) == missions.end()) missions.push_back(file);
    report.summary = "daemon file for " + std::to_string(daemon->config.gliders.size()) + " gliders and " +
                     std::to_string(missions.size()) + " mission files is right";
    const auto own = report.file;
    reports.push_back(std::move(report));
    for (const auto& file : missions) check(file);
    add_errors_across(own);
  }

  /// Errors that only the files together have: each goes to the file that it names.
  void add_errors_across(const std::string& daemon_file) {
    const auto all = config::load(daemon_file, sources_);
    for (const auto& error : all ? places_.errors_of(*all) : all.error())
      for (auto& report : reports)
        if (report.file == error.file &&
            std::find(report.problems.begin(), report.problems.end(), error) == report.problems.end())
          report.problems.push_back(error);
  }

  config::Sources sources_;
  daemon::Places places_;
};

void print_text(const std::vector<Report>& reports, bool effective, std::ostream& out, std::ostream& err) {
  for (const auto& report : reports) {
    for (const auto& problem : report.problems) err << problem.message() << '\n';
    if (!report.problems.empty()) continue;
    if (effective)
      out << (reports.size() > 1 ? "# " + config::shown(report.file) + "\n" : "") << report.effective;
    else
      out << config::shown(report.file) << ": " << report.summary << '\n';
  }
}

void print_json(const std::vector<Report>& reports, bool effective, std::ostream& out) {
  auto files = nlohmann::ordered_json::array();
  for (const auto& report : reports) {
    auto problems = nlohmann::ordered_json::array();
    for (const auto& problem : report.problems)
      problems.push_back(
          {{"line", problem.line}, {"column", problem.column}, {"key", problem.key}, {"message", problem.text()}});
    nlohmann::ordered_json file{{"file", report.file},
                                {"kind", report.kind},
                                {"valid", report.problems.empty()},
                                {"problems", std::move(problems)}};
    if (effective && report.problems.empty()) file["effective"] = report.effective;
    files.push_back(std::move(file));
  }
  // A file name or an excerpt may be no UTF-8: it is shown with replacement characters instead of failing.
  const nlohmann::ordered_json document{{"files", std::move(files)}};
  out << document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

}  // namespace

int run_check(const CheckOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (options.files.empty()) {
    err << "glidehelm check: name at least one mission or daemon file\n";
    return 2;
  }
  Checker checker{world};
  for (const auto& file : options.files) checker.check(file);
  if (options.json)
    print_json(checker.reports, options.effective, out);
  else
    print_text(checker.reports, options.effective, out, err);
  const bool right =
      std::all_of(checker.reports.begin(), checker.reports.end(), [](const Report& r) { return r.problems.empty(); });
  return right ? 0 : 1;
}

}  // namespace glidehelm::cli
