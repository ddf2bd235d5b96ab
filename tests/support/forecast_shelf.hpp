#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/manual_world.hpp"

namespace glidehelm::test {

/// A folder of made-up published files, and a child that reads them: it keeps to the contract of glidehelm-ingest (its
/// arguments, its story, its exit codes), and its files are one line of text each.
class ForecastShelf {
 public:
  /// What a file says: a steady eastward current over hourly times from `first_s`, of the model run of `reference_s`; and where it has a
  /// temperature of the surface, `water` of it.
  struct Says {
    double east{}, reference_s{}, first_s{};
    int hours{24};
    std::optional<double> surface_c{};
  };
  /// From `surface_c` to 4 °C at 1000 m, salinity 35.
  static std::vector<ocean::WaterLayer> water(double surface_c) {
    return {{Metres{0}, surface_c, 35}, {Metres{1000}, 4, 35}};
  }

  explicit ForecastShelf(ManualWorld& world) : world_{world} {
    world_.files.make_folder_at("/data");
    world_.procs.play("glidehelm-ingest", [this](const world::ProcessRequest& request) { return read(request); });
  }

  void publish(const std::string& name, const Says& says) {
    std::ostringstream text;
    text.precision(17);
    text << "good " << says.east << " " << says.reference_s << " " << says.first_s << " " << says.hours;
    if (says.surface_c) text << " " << *says.surface_c;
    world_.files.put("/data/" + name, text.str());
  }
  /// A file that is refused with `reason`.
  void publish_bad(const std::string& name, const std::string& reason) {
    world_.files.put("/data/" + name, "bad " + reason);
  }
  /// A file on which the child dies of `signal`.
  void publish_deadly(const std::string& name, int signal) {
    world_.files.put("/data/" + name, "deadly " + std::to_string(signal));
  }
  void publish_growing(const std::string& name, const std::string& how_far) {
    world_.files.put("/data/" + name, "growing " + how_far);
  }
  void take(const std::string& name) { world_.files.take("/data/" + name); }
  /// How often a child was started.
  [[nodiscard]] std::size_t children() const { return world_.procs.requests.size(); }

 private:
  using Result = world::ProcessResult;

  Result read(const world::ProcessRequest& request) {
    const auto& words = request.arguments;
    const auto dashes = std::find(words.begin(), words.end(), "--");
    const std::vector<std::string> paths(dashes + 1, words.end());
    std::set<std::string> refused;
    std::istringstream known{request.input};
    for (std::string line; std::getline(known, line);) refused.insert(line);

    std::string story;
    const auto exit_with = [&](int code, const std::string& complaint) {
      return Result{Result::End::exited, code, story, "glidehelm-ingest: " + complaint + "\n"};
    };
    std::vector<ocean::GridSource> sources;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const auto text = world_.files.get(paths[i]);
      if (!text || text->rfind("growing ", 0) == 0) {
        story += "copying " + std::to_string(i) + "\n";
        return exit_with(5, paths[i] + ": " + (text ? "is still being written: " + text->substr(8) : "is not there"));
      }
      const auto stat = *world_.files.stat(paths[i]);
      sources.push_back({paths[i], Sha256::of(std::string_view{*text})});
      std::ostringstream line;
      line << "source " << i << " " << sources.back().hash.hex() << " " << stat.device << " " << stat.inode << " "
           << stat.size << " " << stat.modified_ns << " " << stat.changed_ns << "\n";
      story += line.str();
    }
    for (std::size_t i = 0; i < paths.size(); ++i)
      if (refused.count(ocean::provenance_of({sources[i]}).hex()) != 0) {
        story += "reading " + std::to_string(i) + "\n";
        return Result{Result::End::exited, 4, story, ""};
      }
    std::map<double, std::pair<double, double>> east_at;  // time: reference, current; the newest run wins
    double reference = 0;
    std::optional<double> surface_c;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      story += "reading " + std::to_string(i) + "\n";
      std::istringstream in{*world_.files.get(paths[i])};
      std::string kind;
      in >> kind;
      if (kind == "bad") return exit_with(1, paths[i] + ":" + in.str().substr(3));
      if (kind == "deadly") return Result{Result::End::signalled, std::stoi(in.str().substr(7)), story, ""};
      Says says;
      in >> says.east >> says.reference_s >> says.first_s >> says.hours;
      if (double at_surface{}; says.reference_s >= reference && in >> at_surface) surface_c = at_surface;
      reference = std::max(reference, says.reference_s);
      for (int h = 0; h < says.hours; ++h) {
        auto& at = east_at[says.first_s + 3600.0 * h];
        at = std::max(at, {says.reference_s, says.east});
      }
    }
    story += "joining\nwriting\n";
    auto axes = flat_axes({27, 28, 29, 30}, {-17, -16, -15, -14});
    axes.has_time = true;
    axes.times_s.clear();
    for (const auto& [time, what] : east_at) axes.times_s.push_back(time);
    auto grid = make_grid(axes, [&](double, double, double, double time) {
      return std::pair{east_at.at(time).second, 0.0};
    });
    grid.facts.sources = sources;
    grid.facts.reference_s = reference;
    if (surface_c) grid.facts.water = {water(*surface_c), "made up"};
    grid.facts.cycle = paths.back().substr(paths.back().rfind('/') + 1);
    world_.files.put(words.at(1), ocean::write_grid(grid));
    return Result{Result::End::exited, 0, story, ""};
  }

  ManualWorld& world_;
};

}  // namespace glidehelm::test
