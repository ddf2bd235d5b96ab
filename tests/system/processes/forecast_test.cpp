#include <set>
#include <variant>

#include "core/base/utc.hpp"
#include "daemon/event_json.hpp"
#include "simulator/netcdf_classic.hpp"
#include "tests/support/fields.hpp"
#include "tests/system/processes/sea.hpp"

using namespace glidehelm;
using namespace glidehelm::test;

namespace {

/// A sea whose forecasts arrive every six hours while the glider flies, beside what the test puts there.
struct ForecastSea {
  Sea sea;
  double start_s{epoch_seconds(*utc_from_text("2026-03-01T00:00:00Z"))};

  ForecastSea() {
    std::filesystem::create_directories(sea.folder.path / "published");
    sea.folder.write("missions.d/leg.yaml",
                     "schema: glidehelm/mission/v1\n"
                     "name: leg\n"
                     "glider: sim01\n"
                     "goal: {lat_deg: 40.71, lon_deg: 4.37, radius_m: 2000}\n"
                     "currents: {files: [\"" +
                         sea.path("published/*.nc") + "\", \"" + sea.path("run/forecasts/*.nc") +
                         "\"]}\n"
                         "approval: {mode: auto}\n"
                         "vehicle: {horizontal_speed_m_per_s: 0.3}\n");
    sea.folder.write("scenario.yaml", sea.folder.read("scenario.yaml") +
                                          "forecasts:\n"
                                          "  folder: run/forecasts\n"
                                          "  area: {west_deg: 3.5, east_deg: 5, south_deg: 40, north_deg: 41.5}\n"
                                          "  step_deg: 0.1\n"
                                          "  every_h: 6\n"
                                          "  delay_h: 1\n");
  }
  /// A run on the same grid as those that will arrive, of `hours_ago` before the start.
  [[nodiscard]] std::string run_of(double hours_ago, const Uniform& current) const {
    simulator::ForecastGrid grid{3.5, 5, 40, 41.5, 0.1, {}, {}};
    for (int k = 0; k <= 32; ++k) grid.times_s.push_back(start_s + 3600 * (3.0 * k - hours_ago));
    return simulator::forecast_file(ocean::FieldRef{current}, grid, start_s - 3600 * hours_ago);
  }
  void put(const std::string& name, const std::string& bytes) const { sea.folder.write("published/" + name, bytes); }
};

/// The forecast that each candidate of the journal was planned on, in order, runs of one together.
std::vector<std::string> planned_on(const std::vector<daemon::JournalRecord>& records) {
  std::vector<std::string> labels;
  for (const auto& record : records) {
    if (record.type != daemon::RecordType::event) continue;
    const auto read = daemon::event_from_json(record.payload);
    REQUIRE(read);
    if (const auto* found = std::get_if<mission::CandidateFound>(&read->event.what))
      if (labels.empty() || labels.back() != found->candidate.forecast) labels.push_back(found->candidate.forecast);
  }
  return labels;
}

}  // namespace

TEST_CASE("forecast cycles that arrive while a glider flies are used one after the other, a truncated one never") {
  const ForecastSea here;
  const Uniform current{0.05, -0.02};
  here.put("aa_old.nc", here.run_of(6, current));
  const auto whole = here.run_of(-1, current);  // it says that it is the newest of all when the glider starts
  here.put("zz_cut.nc", whole.substr(0, whole.size() * 2 / 3));
  auto daemon = here.sea.start_daemon();
  auto simulator = here.sea.start_simulator();
  const auto ended = simulator->wait(kFlightLimit);
  CAPTURE(here.sea.simulator_log(), here.sea.daemon_log());
  REQUIRE(ended.code == 0);
  CHECK(daemon->wait(kStepLimit).code == 0);

  const auto log = here.sea.daemon_log();
  const auto in_use = lines_with(log, "forecast in use: ");
  CHECK(in_use.size() >= 3);
  for (const auto& line : in_use) CHECK(line.find("zz_cut") == std::string::npos);
  // The bad file is named, with both lengths, and with what stays in use and its age; not again at every look.
  const auto refused = lines_with(log, "ALERT sim01 +a forecast is refused: .*zz_cut\\.nc: truncated: the file has " +
                                           std::to_string(whole.size() * 2 / 3) +
                                           " bytes, its header needs [0-9]+\\. In use stays .* h old");
  CHECK_FALSE(refused.empty());
  CHECK(refused.size() <= in_use.size());

  // Each plan was made on one whole forecast, and a later plan never on an older one than an earlier.
  const auto labels = planned_on(here.sea.journal());
  CHECK(labels.size() >= 2);
  CHECK(std::set<std::string>(labels.begin(), labels.end()).size() == labels.size());
  for (const auto& label : labels) CHECK(log.find("forecast in use: " + label) != std::string::npos);
  CHECK(here.sea.taken().size() >= 4);
}

TEST_CASE("a daemon that starts again among bad forecasts goes on with the last good one") {
  const ForecastSea here;
  const Uniform current{0.05, -0.02};
  here.put("only.nc", here.run_of(6, current));
  auto daemon = here.sea.start_daemon("planned");  // it dies in the first plan
  auto simulator = here.sea.start_simulator();
  REQUIRE(daemon->wait(kFlightLimit).signal == SIGKILL);
  const auto before = lines_with(here.sea.daemon_log(), "forecast in use: ");
  REQUIRE_FALSE(before.empty());
  // Meanwhile all that was published has become a page of a server; later cycles are still to come.
  for (const char* folder : {"published", "run/forecasts"})
    for (const auto& entry : std::filesystem::directory_iterator{here.sea.folder.path / folder})
      if (entry.path().extension() == ".nc")
        here.sea.folder.write(folder + ("/" + entry.path().filename().string()), "<html>maintenance</html>");
  auto again = here.sea.start_daemon();
  static_cast<void>(simulator->wait(kFlightLimit));
  static_cast<void>(again->wait(kStepLimit));
  CAPTURE(here.sea.daemon_log());
  const auto uses = lines_with(here.sea.daemon_log(), "forecast in use: ");
  REQUIRE(uses.size() > before.size());
  const auto label = [](const std::string& line) {
    const auto begin = line.find("in use: ") + 8;
    return line.substr(begin, line.find(')', begin) - begin);
  };
  CHECK(label(uses[before.size()]) == label(before.back()));
  CHECK_FALSE(lines_with(here.sea.daemon_log(), "a forecast is refused: .*a web page").empty());
  CHECK(here.sea.taken().size() >= 3);  // it flew on
}
