#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"
#include "core/safety/judge.hpp"
#include "core/safety/list_reader.hpp"
#include "core/safety/reflight.hpp"

namespace glidehelm::safety {

/// All that a rule may look at. `list` is none when the bytes are no goto list of ours, `flight` when the dossier's
/// numbers cannot be flown; a rule that needs what is missing does not hold.
struct Evidence {
  const Dossier& dossier;
  const Expected<GotoFile, ListProblem>& list;
  const std::optional<Flight>& flight;
  ocean::FieldRef full;
  const chart::Chart& chart;
  std::optional<double> issued_s{};  ///< epoch second from which the forecast ages; none when it does not
};

/// One rule: its stable identifier and the function that finds the margin (which leaves `Margin::rule` empty).
///
/// | rule              | found                                              | limit                           | unit    |
/// |-------------------|----------------------------------------------------|---------------------------------|---------|
/// | 0 dossier         | NaN (numbers finite, positive, plausible)          | NaN                             |         |
/// | 4 name            | NaN (name is goto_lNN.ma of the slot)              | NaN                             |         |
/// | 4 size            | bytes of the file                                  | ≤ 4096                          | bytes   |
/// | 4 format          | line of the first problem, else NaN                | NaN                             | line    |
/// | 4 points          | largest difference to the promised points          | ≤ 0.5e-4 (see below)            | minutes |
/// | 1 waypoints       | smallest clearance of a waypoint                   | > 0                             | m       |
/// | 1 legs            | the leg that uses most of its limit                | ≤ 1.1·(Û + largest current)·t_s | m       |
/// | 1 first leg       | distance from the fix to w_1                       | > radius                        | m       |
/// | 1 neighbours      | smallest distance between successive waypoints     | > radius                        | m       |
/// | 1 reach           | largest distance to a waypoint steered to          | ≤ 0.9·max_wpt_distance, or NaN  | m       |
/// | 2 flight          | hours flown before the flight ended                | NaN (the end must be allowed)   | h       |
/// | 2 land            | smallest distance to the coast on the track        | ≥ coast_margin                  | m       |
/// | 2 depth           | shallowest water on the track                      | ≥ Chart::least_depth            | m       |
/// | 2 areas           | smallest clearance on the track                    | ≥ 0                             | m       |
/// | 2 tail            | the same, four flights: stint ±5 %, speed −10/+5 % | ≥ 0                             | m       |
/// | 5 surfacing       | seconds between dossier fix and surfacing's fix    | ≤ 1                             | s       |
/// | 5 glider          | NaN (names agree)                                  | NaN                             |         |
/// | 5 deadline        | seconds left                                       | > 0                             | s       |
/// | promise surfacing | re-flown to promised next surfacing                | ≤ 3 % of the stint, ≥ 20 m      | m       |
/// | promise arrival   | re-flown against promised arrival                  | ≤ 2 % of the travel, ≥ 60 s     | s       |
/// | forecast cover    | hours of forecast after the fix                    | ≥ second next surfacing         | h       |
/// | forecast age      | hours since it was issued; NaN when it does not age | ≤ 72                           | h       |
/// | forecast speed    | fastest current met                                | ≤ refused_speed                 | m/s     |
/// | forecast values   | NaN (every current met is a number)                | NaN                             |         |
struct Rule {
  std::string_view name;
  Margin (*judge)(const Evidence&);
};

/// Every rule, in the order of a verdict.
///
/// Choices where product.md 7 leaves room:
///  - "4 points" allows half a unit of the last digit, not the 1e-4 minute that the product asks at least: a correct
///    writer rounds to nearest, and only so is every file refused in which one digit was changed afterwards. Count,
///    order, and radius and end of the list (when the promise names them) must agree too.
///  - "1 legs": the largest believed current is the largest that the glider or the forecast believes in the stints the
///    list is made for: ĉ, the mean met, the drift. With correction 0 the glider believes none, but the forecast does.
///    Exempt: the last leg when it leads to the goal, and so a list of the goal alone (direct, station).
///  - "2 land", "2 areas" judge the re-flown track from the first dive on: the drift before it happens whatever is
///    sent. A start inside the margin may only increase its distance until it is outside. Beside the coast, water that the
///    coast file does not chart counts as land. After the arrival in the goal radius only land itself counts: at the
///    first surfacing inside it a new list goes out, and the closing leg of a loop, which is flown to the horizon, then
///    only has to miss the shore. Without a coast file the field's own land, which ends a flight, is all there is.
///  - "2 depth" judges the water under every piece of the same track, at the surface too: a glider that cannot dive drifts.
///    Unknown is land. A start in shallower water (or unknown) may not come into water more than 1 m shallower than at the
///    first dive until it is outside. After the arrival the water must only be known and no land, and so in "2 tail".
///    Without bathymetry it is not judged, and the margin says so.
///  - "2 flight": the horizon, 60 stints, the end of a waiting list are allowed ends; the end of the forecast's time
///    after the second surfacing, since "forecast cover" judges that; after an arrival everything but land.
///  - "2 tail" flies 72 h (T_silence of trust.md V-12): lost calls with another stint length and another speed.
std::span<const Rule> rules();

/// True when the numbers can be flown at all (rule "0 dossier"); else `why` says which cannot.
bool can_be_flown(const Dossier& dossier, std::string& why);
/// The flight of a list that was read.
FlightOrder order_for(const Dossier& dossier, const GotoFile& list);

}  // namespace glidehelm::safety
