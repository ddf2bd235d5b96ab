#include "daemon/cli/coast.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.hpp"
#include "core/chart/grown_land.hpp"
#include "core/chart/joined_areas.hpp"
#include "daemon/cli/coast_cut.hpp"

namespace glidehelm::cli {

namespace {

using chart::coast_degrees;
using chart::CoastArea;

constexpr std::int64_t kUnitsPerDegree = 10'000'000;
constexpr std::int64_t kSmallestSide = kUnitsPerDegree / 100;
/// Side of the parts in which a large area is cut, degrees: some seconds each.
constexpr std::int64_t kPart = 20;
/// Border stretches shorter than this (110 m) are not asked about: the shore is too near for one point to tell.
constexpr std::int64_t kShortestStretch = 10'000;
/// Questions are asked this far (1 m) inside the border.
constexpr std::int64_t kInwards = 100;
constexpr std::size_t kMostQuestions = 400;

constexpr const char* kAllowed =
    "--area is W/E/S/N in degrees: W from -180 to 180, E up to 180 degrees east of it (176/-176/-20/-14 crosses the "
    "antimeridian), S and N from -85 to 85, each side at least 0.01 degrees";
constexpr const char* kApt = "apt-get install gmt gmt-gshhg-full";

/// gmt with settings of its own: no history file in the current folder, plain degrees, and no download of what is missing
/// (the address is no server's).
world::ProcessRequest gmt(std::vector<std::string> arguments) {
  world::ProcessRequest request;
  request.program = "gmt";
  request.arguments = std::move(arguments);
  for (const char* setting : {"--GMT_HISTORY=false", "--GMT_DATA_SERVER=127.0.0.1:9", "--FORMAT_GEO_OUT=D",
                              "--FORMAT_FLOAT_OUT=%.10f", "--IO_SEGMENT_MARKER=>", "--IO_LONLAT_TOGGLE=false"})
    request.arguments.emplace_back(setting);
  request.deadline = Seconds{300};
  request.output_at_most = std::size_t{512} << 20;
  return request;
}

std::string last_line(std::string_view text) {
  const auto whole = trimmed(text);
  const auto from = whole.rfind('\n');
  return std::string{trimmed(from == std::string_view::npos ? whole : whole.substr(from + 1)).substr(0, 200)};
}

/// Why a run of gmt gave nothing, with the way to mend it.
std::string failure(const world::ProcessResult& result) {
  using End = world::ProcessResult::End;
  switch (result.end) {
    case End::not_started:
      return "the program gmt cannot be started; install it with: " + std::string{kApt};
    case End::deadline:
      return "gmt took longer than 300 s";
    case End::output_too_long:
      return "gmt wrote more than 512 MiB";
    case End::signalled:
      return "gmt was ended by signal " + std::to_string(result.code);
    case End::exited:
      break;
  }
  if (result.err.find("GSHHG") != std::string::npos && result.err.find("ERROR") != std::string::npos)
    return "gmt finds no full-resolution GSHHG coastlines; install them with: " + std::string{kApt};
  return "gmt failed with exit code " + std::to_string(result.code) + ": " + last_line(result.err);
}

struct Part {
  std::int64_t west, east, south, north;  ///< whole degrees
};

/// The area and at least a little around it, in whole degrees: GSHHG stores shorelines in bins of one degree, so that
/// there lines of neighbouring parts end in exactly the same points.
std::vector<Part> parts_of(const CoastArea& area) {
  const auto below = [](std::int64_t v) {
    return (v >= 0 ? (v + kUnitsPerDegree - 1) / kUnitsPerDegree : v / kUnitsPerDegree) - 1;
  };
  const auto above = [](std::int64_t v) {
    return (v >= 0 ? v / kUnitsPerDegree : -((-v + kUnitsPerDegree - 1) / kUnitsPerDegree)) + 1;
  };
  const auto west = below(area.west), east = above(area.east), south = below(area.south), north = above(area.north);
  std::vector<Part> parts;
  for (auto s = south; s < north; s += kPart)
    for (auto w = west; w < east; w += kPart)
      parts.push_back({w, std::min(w + kPart, east), s, std::min(s + kPart, north)});
  return parts;
}

/// What follows "GSHHG version " in gmt's notes.
std::string version_in(const std::string& notes) {
  constexpr std::string_view kBefore = "GSHHG version ";
  const auto at = notes.find(kBefore);
  if (at == std::string::npos) return "";
  const auto from = at + kBefore.size();
  const auto to = notes.find_first_not_of("0123456789.", from);
  return notes.substr(from, to == std::string::npos ? std::string::npos : to - from);
}

struct Shore {
  std::vector<ShoreLine> lines;
  std::string version;
};

Expected<Shore, std::string> shore_of(const CoastArea& area, world::Procs& procs, std::ostream& err) {
  Shore shore;
  std::size_t points = 0;
  const auto parts = parts_of(area);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto& part = parts[k];
    std::string region = "-R";
    for (const auto side : {part.west, part.east, part.south, part.north})
      region += (region.size() > 2 ? "/" : "") + std::to_string(side);
    const auto result = procs.run_and_wait(gmt({"coast", region, "-Df", "-W", "-M", "-Vi"}));
    if (!result.succeeded()) return unexpected(failure(result));
    const auto before = shore.lines.size();
    if (auto read = read_shore_lines(result.out, area, shore.lines); !read)
      return unexpected("gmt coast " + region + ": " + read.error());
    for (auto i = before; i < shore.lines.size(); ++i) points += shore.lines[i].size();
    if (shore.version.empty()) shore.version = version_in(result.err);
    if (parts.size() > 1)
      err << "glidehelm coast: part " << k + 1 << " of " << parts.size() << ", " << points << " points so far\n"
          << std::flush;
  }
  shore.lines = joined(shore.lines);
  return shore;
}

/// One point in the middle of each long stretch of border, or several round the border when no shore crosses it.
struct Question {
  ShorePoint at;
  std::size_t stretch;
};
std::vector<Question> questions_for(const CoastCut& cut) {
  const auto& stretches = cut.stretches();
  std::vector<Question> questions;
  if (stretches.size() == 1) {
    for (int k = 0; k < 16; ++k) questions.push_back({cut.border_point(cut.border_length() / 16 * k + 1, kInwards), 0});
    return questions;
  }
  std::vector<std::size_t> longest(stretches.size());
  for (std::size_t i = 0; i < longest.size(); ++i) longest[i] = i;
  std::stable_sort(longest.begin(), longest.end(),
                   [&](std::size_t a, std::size_t b) { return stretches[a].length > stretches[b].length; });
  for (const auto i : longest) {
    if (questions.size() == kMostQuestions || (stretches[i].length < kShortestStretch && !questions.empty())) break;
    questions.push_back({cut.border_point(stretches[i].from + stretches[i].length / 2, kInwards), i});
  }
  return questions;
}

/// Whether even stretches of the border are land. Nearly all of gmt's answers must say the same.
Expected<bool, std::string> even_is_land(const CoastCut& cut, const CoastArea& area, world::Procs& procs) {
  const auto questions = questions_for(cut);
  std::string input;
  for (std::size_t k = 0; k < questions.size(); ++k) {
    auto lon = area.west + questions[k].at.x;
    if (lon >= 180 * kUnitsPerDegree) lon -= 360 * kUnitsPerDegree;
    input += coast_degrees(lon) + " " + coast_degrees(questions[k].at.y) + " " + std::to_string(k) + "\n";
  }
  auto request = gmt({"select", "-Df", "-Ns/k/s/k/s"});
  request.input = std::move(input);
  const auto result = procs.run_and_wait(request);
  if (!result.succeeded()) return unexpected(failure(result));
  // The points on land come back, their numbers last in the line.
  std::vector<bool> land(questions.size(), false);
  for (std::string_view text = result.out; !text.empty();) {
    const auto line = trimmed(text.substr(0, text.find('\n')));
    text.remove_prefix(
        std::min(text.size(), text.find('\n') == std::string_view::npos ? text.size() : text.find('\n') + 1));
    if (line.empty() || line.front() == '>' || line.front() == '#') continue;
    const auto number = number_from(line.substr(line.find_last_of(" \t") + 1));
    if (!number || !(*number >= 0 && *number < static_cast<double>(questions.size())))
      return unexpected("gmt select gave a line that makes no sense: '" + std::string{line.substr(0, 60)} + "'");
    land[static_cast<std::size_t>(*number)] = true;
  }
  std::size_t even = 0;
  for (std::size_t k = 0; k < questions.size(); ++k) even += land[k] == (questions[k].stretch % 2 == 0) ? 1 : 0;
  const auto most = std::max(even, questions.size() - even);
  if (10 * most < 9 * questions.size())
    return unexpected("land and water do not alternate along the border of the area (" + std::to_string(most) + " of " +
                      std::to_string(questions.size()) + " places agree); try slightly different borders");
  return even == most;
}

struct FileName {
  std::string folder, name;
};
FileName split(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return {".", path};
  return {slash == 0 ? "/" : path.substr(0, slash), path.substr(slash + 1)};
}

/// A file beside the target, under a name that nobody else has.
std::string staged_name(const std::string& name, world::Rng& rng) {
  return "." + name + "." + std::to_string(rng.next());
}

/// Tries the folder of the target with an empty file: what would fail after minutes of cutting is said before.
Expected<Done, std::string> try_folder(const FileName& target, world::World& world) {
  auto folder = world.files.open_folder(target.folder);
  if (!folder) return unexpected(folder.error().message());
  const auto probe = staged_name(target.name, world.rng);
  if (auto made = (*folder)->create(probe, "", 0644); !made) return unexpected(made.error().message());
  if (auto gone = (*folder)->unlink(probe); !gone) return unexpected(gone.error().message());
  return Done{};
}

/// Writes beside the target and renames: a reader sees the old file or the new one.
Expected<Done, std::string> write(const FileName& target, const std::string& bytes, world::World& world) {
  auto folder = world.files.open_folder(target.folder);
  if (!folder) return unexpected(folder.error().message());
  const auto staged = staged_name(target.name, world.rng);
  if (auto made = (*folder)->create(staged, bytes, 0644); !made) return unexpected(made.error().message());
  auto renamed = (*folder)->rename_over(staged, **folder, target.name);
  if (!renamed) {
    auto removed = (*folder)->unlink(staged);
    return unexpected(renamed.error().message() + (removed ? "" : "; " + staged + " is left there"));
  }
  if (auto synced = (*folder)->sync(); !synced) return unexpected(synced.error().message());
  return Done{};
}

Expected<std::shared_ptr<const chart::Coast>, std::string> cut_coast(const CoastArea& area, world::World& world,
                                                                     std::ostream& err) {
  auto shore = shore_of(area, world.procs, err);
  if (!shore) return unexpected(shore.error());
  const auto cut = CoastCut::make(area, shore->lines);
  if (!cut) return unexpected(cut.error());
  const auto even = even_is_land(*cut, area, world.procs);
  if (!even) return unexpected(even.error());
  auto coast = chart::Coast::make(
      area,
      "GSHHG" + (shore->version.empty() ? "" : " " + shore->version) + " full resolution, levels 1 to 4, cut with gmt",
      cut->rings(*even));
  if (!coast) return unexpected(coast.error().message());
  return *std::move(coast);
}

using CoastPointer = std::shared_ptr<const chart::Coast>;

Expected<CoastPointer, std::string> coast_from(const std::string& path, world::World& world) {
  const auto bytes = world.files.read(path, chart::Coast::kLargestFile);
  if (!bytes) return unexpected("--from: " + bytes.error().message());
  auto coast = chart::Coast::parse(*bytes);
  if (!coast) return unexpected("--from " + path + ": " + coast.error().message());
  return std::move(coast).value();
}

Expected<CoastPointer, std::string> grown(const CoastPointer& coast, const CoastOptions& options) {
  if (!options.grow_m && !options.simplify_m) return coast;
  auto land = chart::grown_land(*coast, Metres{options.grow_m.value_or(0)}, Metres{options.simplify_m.value_or(100)});
  if (!land) return unexpected(land.error().problem);
  return std::move(land).value();
}

/// Every area cut and grown by itself, then all together.
Expected<CoastPointer, std::string> made(const std::vector<CoastArea>& areas, const CoastOptions& options,
                                         world::World& world, std::ostream& err) {
  std::vector<CoastPointer> parts;
  for (std::size_t k = 0; k < std::max<std::size_t>(areas.size(), 1); ++k) {
    const auto cut = areas.empty() ? coast_from(options.from, world) : cut_coast(areas[k], world, err);
    auto part = cut ? grown(*cut, options) : cut;
    if (!part) return part;
    parts.push_back(std::move(part).value());
  }
  auto joined = chart::joined_areas(parts);
  if (!joined) return unexpected(joined.error().problem);
  return std::move(joined).value();
}

}  // namespace

Expected<CoastArea, std::string> coast_area(const std::string& text) {
  std::vector<std::int64_t> sides;
  for (std::string_view rest = text;;) {
    const auto slash = rest.find('/');
    const auto value = number_from(rest.substr(0, slash));
    if (!value || std::abs(*value) > 360)
      return unexpected(kAllowed + std::string{"; found '"} + text.substr(0, 80) + "'");
    sides.push_back(std::llround(*value * static_cast<double>(kUnitsPerDegree)));
    if (slash == std::string_view::npos) break;
    rest.remove_prefix(slash + 1);
  }
  const auto refused = [&](const std::string& why) { return unexpected(why + ": " + kAllowed); };
  if (sides.size() != 4)
    return refused("'" + text.substr(0, 80) + "' has " + std::to_string(sides.size()) + " numbers");
  CoastArea area{sides[0], sides[1], sides[2], sides[3]};
  if (area.west < -180 * kUnitsPerDegree || area.west > 180 * kUnitsPerDegree)
    return refused("W is not from -180 to 180");
  if (area.west == 180 * kUnitsPerDegree) area.west = -180 * kUnitsPerDegree;
  while (area.east <= area.west) area.east += 360 * kUnitsPerDegree;
  while (area.east - area.west > 360 * kUnitsPerDegree) area.east -= 360 * kUnitsPerDegree;
  if (area.width() > CoastArea::kWidest) return refused("E is more than 180 degrees east of W");
  if (area.south > area.north) return refused("S is north of N");
  if (area.width() < kSmallestSide || area.height() < kSmallestSide) return refused("the area is too small");
  if (area.problem()) return refused("S or N is beyond 85 degrees");
  return area;
}

int run_coast(const CoastOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (options.areas.empty() == options.from.empty()) {
    err << "glidehelm coast: give either --area (to cut a coast) or --from (to grow or simplify one)\n";
    return 2;
  }
  std::vector<CoastArea> areas;
  for (const auto& text : options.areas) {
    const auto area = coast_area(text);
    if (!area) {
      err << "glidehelm coast: " << area.error() << "\n";
      return 2;
    }
    areas.push_back(*area);
  }
  const auto target = split(options.output);
  if (target.name.empty() || target.name == "." || target.name == "..") {
    err << "glidehelm coast: -o names no file: '" << options.output << "'\n";
    return 2;
  }
  if (auto tried = try_folder(target, world); !tried) {
    err << "glidehelm coast: cannot write " << options.output << ": " << tried.error() << "\n";
    return 1;
  }
  const auto coast = made(areas, options, world, err);
  if (!coast) {
    err << "glidehelm coast: " << coast.error() << "\n";
    return 1;
  }
  const auto text = (*coast)->text();
  if (auto written = write(target, text, world); !written) {
    err << "glidehelm coast: cannot write " << options.output << ": " << written.error() << "\n";
    return 1;
  }
  out << options.output << ": " << (*coast)->rings().size() << " rings, " << (*coast)->points() << " points, "
      << text.size() << " bytes; " << (*coast)->source() << "\n";
  return 0;
}

}  // namespace glidehelm::cli
