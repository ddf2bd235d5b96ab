#include "core/ocean/composite.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/support/fields.hpp"

// Sources in order of trust: far from seams the field is one source, across a seam it does not jump.

using namespace glidehelm;
using namespace glidehelm::ocean;
using test::kDry;

namespace {

constexpr double kHour = 3600;
const Seams kSeams{Metres{20'000}, Seconds{6 * kHour}};

template <class F>
CompositeSource source(const std::string& name, GridAxes axes, const F& current, GriddedOptions options = {}) {
  return {name, GriddedField{test::make_grid(std::move(axes), current), options}};
}

/// A regional model, 1/20° over 2° × 2°, in a coarse one, 1/4° over 8° × 8°; `inner` and `outer`: (lat, lon, depth, t) → current.
template <class F, class G>
CompositeField nested(const F& inner, const G& outer, const Seams& seams = kSeams) {
  std::vector<CompositeSource> sources;
  sources.push_back(source("regional", test::flat_axes(test::steps(39, 0.05, 41), test::steps(4, 0.05, 41)), inner));
  sources.push_back(source("coarse", test::flat_axes(test::steps(36, 0.25, 33), test::steps(1, 0.25, 33)), outer));
  return {std::move(sources), seams};
}

const auto kEastward = [](double, double, double, double) { return std::pair{0.5, 0.0}; };
const auto kWestward = [](double, double, double, double) { return std::pair{-0.5, 0.0}; };
std::pair<double, double> eddies(double lat, double lon, double, double) {
  return {0.4 * std::sin(3 * lat) * std::cos(2 * lon), 0.3 * std::cos(2 * lat + lon)};
}
std::pair<double, double> stream(double lat, double lon, double, double) { return {0.2 + 0.02 * lat, 0.05 * lon}; }

double sum_of(const std::vector<double>& weights) { return std::accumulate(weights.begin(), weights.end(), 0.0); }
double east_of(const CompositeField& field, GeoPoint p, double t_s = 0) {
  const auto sample = field.sample(p, Depth{}, t_s);
  REQUIRE(sample);
  return sample->current.east.si();
}

template <class F>
bool same(const CompositeField& field, const F& other, GeoPoint p) {
  const auto a = field.sample(p, Depth{}, 0), b = other.sample(p, Depth{}, 0);
  return a && b && *a == *b;
}

/// The claimed bound of the change of a weight: n·1.5·√2/blend. Between sources 1 m/s apart that is the field's slope.
double steepest(std::size_t sources, const Seams& seams) {
  return static_cast<double>(sources) * 1.5 * std::sqrt(2.0) / seams.blend.si();
}

/// Walks from a to b in steps of `step` metres of true length; the largest |change of east| per metre.
double roughest(const CompositeField& field, GeoPoint a, GeoPoint b, double step, double t_s = 0) {
  const auto way = geodesic(a, b);
  double worst = 0, before = east_of(field, a, t_s);
  for (double d = step; d <= way.length.si(); d += step) {
    const double here = east_of(field, destination(a, way.departing, Metres{d}), t_s);
    worst = std::max(worst, std::abs(here - before) / step);
    before = here;
  }
  return worst;
}

}  // namespace

TEST_CASE("deep inside the most trusted source the field is that source, outside it the next one, bit by bit") {
  const auto field = nested(eddies, stream);
  const auto &inner = field.sources()[0].field, &outer = field.sources()[1].field;
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> lat{39.3, 40.7}, lon{4.35, 5.65}, away{1.1, 3.8};
  for (int n = 0; n < 500; ++n) {
    const auto p = geo_point(lat(random), lon(random));  // 0.3° of latitude are 33 km, 0.35° of longitude 29 km
    CHECK(same(field, inner, p));
    const auto q = geo_point(lat(random), away(random));
    CHECK(same(field, outer, q));
  }
}

TEST_CASE("the weights sum to one wherever there is a value") {
  const auto field = nested(eddies, stream);
  std::mt19937_64 random{8};
  std::uniform_real_distribution<double> lat{36.01, 43.99}, lon{1.01, 8.99};
  for (int n = 0; n < 2000; ++n) {
    const auto weights = field.weights(geo_point(lat(random), lon(random)), Depth{}, 0);
    CHECK(sum_of(weights) == Approx(1).epsilon(1e-14));
    for (const double w : weights) CHECK((w >= 0 && w <= 1));
  }
  CHECK(sum_of(field.weights(geo_point(50, 5), Depth{}, 0)) == 0);
}

TEST_CASE("across the edge of the regional model the field goes from one to the other without a jump") {
  const auto field = nested(kEastward, kWestward);
  for (const auto& [a, b] :
       {std::pair{geo_point(40, 3), geo_point(40, 5)}, std::pair{geo_point(38, 5), geo_point(40, 5)},
        std::pair{geo_point(38.4, 3.2), geo_point(40, 5)}}) {
    CHECK(east_of(field, a) == Approx(-0.5).margin(1e-7));
    CHECK(east_of(field, b) == Approx(0.5).margin(1e-7));
    // One metre: a jump of 1 m/s would be 1 per metre, the bound is 2.1e-4.
    CHECK(roughest(field, a, b, 1.0 * 25) <= steepest(2, kSeams));
  }
}

TEST_CASE("a hole in the trusted source is filled by the next without a jump") {
  std::vector<CompositeSource> sources;
  sources.push_back(source("radar", test::flat_axes(test::steps(39, 0.05, 41), test::steps(4, 0.05, 41)),
                           [](double lat, double lon, double, double) {
                             const bool hole = std::hypot(lat - 40, 0.766 * (lon - 5)) < 0.15;
                             return hole ? std::pair{kDry, kDry} : std::pair{0.5, 0.0};
                           }));
  sources.push_back(source("model", test::flat_axes(test::steps(36, 0.25, 33), test::steps(1, 0.25, 33)), kWestward));
  const CompositeField field{std::move(sources), kSeams};
  CHECK(east_of(field, geo_point(40, 5)) == -0.5);
  CHECK(east_of(field, geo_point(39.55, 4.5)) == Approx(0.5).margin(1e-7));
  CHECK(roughest(field, geo_point(39.5, 4.4), geo_point(40.5, 5.6), 25) <= steepest(2, kSeams));
  CHECK(roughest(field, geo_point(40.0, 4.4), geo_point(40.0, 5.6), 25) <= steepest(2, kSeams));
}

namespace {

/// The same area, other times: the newer cycle is trusted more.
CompositeField cycles(double newer_from, double newer_to, double older_from, double older_to) {
  const auto axes = [](double from, double to) {
    return GridAxes{test::steps(from, kHour, static_cast<std::size_t>((to - from) / kHour) + 1),
                    {0.0},
                    test::steps(39, 0.5, 3),
                    test::steps(4, 0.5, 3),
                    true,
                    false};
  };
  std::vector<CompositeSource> sources;
  sources.push_back(source("newer", axes(newer_from, newer_to), kEastward));
  sources.push_back(source("older", axes(older_from, older_to), kWestward));
  return {std::move(sources), kSeams};
}

double roughest_in_time(const CompositeField& field, double from_s, double to_s) {
  double worst = 0, before = east_of(field, geo_point(39.4, 4.4), from_s);
  for (double t = from_s + 10; t <= to_s; t += 10) {
    const double here = east_of(field, geo_point(39.4, 4.4), t);
    worst = std::max(worst, std::abs(here - before) / 10);
    before = here;
  }
  return worst;
}

}  // namespace

TEST_CASE("cycles that overlap are joined without a jump: at the begin of the newer, at its end, and beyond both") {
  const double bound = 2 * 1.5 / kSeams.join.count();  // n·1.5/join, the sources 1 m/s apart
  const auto at = [](const CompositeField& field, double hour) {
    return east_of(field, geo_point(39.4, 4.4), hour * kHour);
  };
  const auto begins = cycles(24 * kHour, 96 * kHour, 0, 48 * kHour);
  CHECK(at(begins, 24) == -0.5);
  CHECK(at(begins, 27) == Approx(0).margin(1e-12));  // half-way: s(1/2) = 1/2
  CHECK(at(begins, 30) == 0.5);
  CHECK(roughest_in_time(begins, -10 * kHour, 120 * kHour) <= bound);
  const auto ends = cycles(0, 48 * kHour, -24 * kHour, 96 * kHour);
  CHECK(at(ends, 42) == 0.5);
  CHECK(at(ends, 48) == -0.5);
  CHECK(roughest_in_time(ends, -40 * kHour, 120 * kHour) <= bound);
  // A gap between the two: the trusted one, held, takes over at the end of the other, and its first value holds.
  CHECK(roughest_in_time(cycles(30 * kHour, 60 * kHour, 0, 20 * kHour), -10 * kHour, 80 * kHour) <= bound);
  // Equal ends: nobody to hand over to, the trusted one holds.
  CHECK(roughest_in_time(cycles(24 * kHour, 48 * kHour, 0, 48 * kHour), 24 * kHour, 80 * kHour) <= bound);
}

TEST_CASE("a lead time ends the use of a source before its data end") {
  auto both = cycles(0, 96 * kHour, 0, 96 * kHour);
  auto sources = both.sources();
  sources[0].to_s = 24 * kHour;
  const CompositeField field{sources, kSeams};
  CHECK(east_of(field, geo_point(39.4, 4.4), 18 * kHour) == 0.5);
  CHECK(east_of(field, geo_point(39.4, 4.4), 24 * kHour) == -0.5);
  CHECK(roughest_in_time(field, 0, 96 * kHour) <= 2 * 1.5 / kSeams.join.count());
  CHECK(field.coverage().last_s == 96 * kHour);
}

TEST_CASE("a region ends the use of a source, and an area across the antimeridian is one, too") {
  auto sources = nested(kEastward, kWestward).sources();
  sources[0].region =
      SourceRegion{{geo_point(39.3, 4.3), geo_point(39.3, 5.7), geo_point(40.7, 5.7), geo_point(40.7, 4.3)}};
  const CompositeField field{sources, kSeams};
  CHECK(east_of(field, geo_point(40, 5)) == Approx(0.5).margin(1e-7));
  CHECK(east_of(field, geo_point(40, 4.2)) == -0.5);
  CHECK(roughest(field, geo_point(40, 3.5), geo_point(40, 5), 25) <= steepest(2, kSeams));
  const SourceRegion pacific{{geo_point(-10, 170), geo_point(-10, -170), geo_point(10, -170), geo_point(10, 170)}};
  const auto in = [&](double lat, double lon) { return pacific.contains(lat * kPi / 180, lon * kPi / 180); };
  CHECK(in(0, 180));
  CHECK(in(0, -179.9));
  CHECK(in(9.9, 170.1));
  CHECK(in(0, 535));
  CHECK_FALSE(in(0, 169));
  CHECK_FALSE(in(0, -169));
  CHECK_FALSE(in(0, 0));
  CHECK_FALSE(in(10.1, 180));
}

TEST_CASE("a source without a value hands over, and without any the reason is that of the most trusted one there") {
  std::vector<CompositeSource> sources;
  const auto axes = test::flat_axes(test::steps(39, 0.1, 21), test::steps(4, 0.1, 21));
  const auto dry_north = [](double from) {
    return [from](double lat, double, double, double) {
      return lat > from ? std::pair{kDry, kDry} : std::pair{from / 100, 0.0};
    };
  };
  sources.push_back(source("a", axes, dry_north(39.51), {OutsideTime::hold, Interpolation::linear, 0, true}));
  sources.push_back(source("b", axes, dry_north(40.51), {OutsideTime::hold, Interpolation::linear, 0, false}));
  const CompositeField field{std::move(sources), kSeams};
  CHECK(east_of(field, geo_point(39.2, 5)) == Approx(0.3951).margin(1e-6));
  CHECK(east_of(field, geo_point(40.2, 5)) == Approx(0.4051).margin(1e-6));
  const auto none = field.sample(geo_point(40.8, 5), Depth{}, 0);
  REQUIRE_FALSE(none);
  CHECK(none.error() == NoCurrent::land);
  CHECK(field.sample(geo_point(45, 5), Depth{}, 0).error() == NoCurrent::outside_area);
  const auto apart = nested(kEastward, [](double, double, double, double) { return std::pair{kDry, kDry}; });
  CHECK(apart.sample(geo_point(37, 2), Depth{}, 0).error() == NoCurrent::no_data);  // only the second holds the place
}

TEST_CASE("below the bottom of one source the next answers") {
  std::vector<CompositeSource> sources;
  const auto axes = [](double last) {
    return GridAxes{{0.0}, {0, 50, last}, test::steps(39, 0.5, 3), test::steps(4, 0.5, 3), false, true};
  };
  sources.push_back(source("shelf", axes(100), kEastward));
  sources.push_back(source("deep", axes(500), kWestward));
  const CompositeField field{std::move(sources), kSeams};
  CHECK(field.sample(geo_point(39.4, 4.4), Depth{Metres{80}}, 0)->current.east.si() == 0.5);
  CHECK(field.sample(geo_point(39.4, 4.4), Depth{Metres{300}}, 0)->current.east.si() == -0.5);
  CHECK(field.sample(geo_point(39.4, 4.4), Depth{Metres{600}}, 0).error() == NoCurrent::below_bottom);
}

TEST_CASE("the kernel and the samples move lanes alike: inside a source, across seams, near coasts and edges") {
  const auto coast = [](double lat, double lon, double z, double t) {
    return std::sin(31 * lat) * std::sin(17 * lon) > 0.7 ? std::pair{kDry, kDry} : eddies(lat, lon, z, t);
  };
  std::mt19937_64 random{11};
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>{a, b}(random); };
  for (const bool with_coast : {false, true}) {
    const auto field = with_coast ? nested(coast, stream) : nested(eddies, stream);
    for (int round = 0; round < 20; ++round) {
      Lanes lanes{};
      lanes.count = Lanes::kMax;
      for (std::size_t k = 0; k < Lanes::kMax; ++k) {
        lanes.lat[k] = between(38, 42) * kPi / 180;
        lanes.lon[k] = between(3, 7) * kPi / 180 + (round % 2) * 2 * kPi;
        const double heading = between(0, 2 * kPi);
        lanes.water_east[k] = 0.3 * std::sin(heading);
        lanes.water_north[k] = 0.3 * std::cos(heading);
        lanes.lost[k] = k % 9 == 8 ? std::uint8_t{3} : std::uint8_t{0};
      }
      Lanes slow = lanes;
      for (int n = 0; n < 4; ++n) {
        field.advance(lanes, n * 1800.0, 1800);
        advance_by_samples(field, slow, n * 1800.0, 1800);
      }
      for (std::size_t k = 0; k < Lanes::kMax; ++k) {
        INFO("lane " << k << " at " << slow.lat[k] * 180 / kPi << ", " << slow.lon[k] * 180 / kPi);
        CHECK(lanes.lost[k] == slow.lost[k]);
        // As for one source: the metric table's 5e-7 and float weights over steps below 1.1e-3 rad.
        CHECK(std::abs(lanes.lat[k] - slow.lat[k]) < 4e-9);
        CHECK(std::abs(lanes.lon[k] - slow.lon[k]) < 4e-9 / 0.7);
      }
    }
  }
}

TEST_CASE("coverage holds every place with a value, and nothing is faster than promised") {
  const auto field = nested(eddies, stream);
  const auto box = field.coverage();
  CHECK(box.south == Approx(36 * kPi / 180));
  CHECK(box.east == Approx(9 * kPi / 180));
  std::mt19937_64 random{12};
  std::uniform_real_distribution<double> lat{34, 46}, lon{-1, 11};
  for (int n = 0; n < 3000; ++n) {
    const auto p = geo_point(lat(random), lon(random));
    const auto sample = field.sample(p, Depth{}, 0);
    if (!sample) continue;
    CHECK(box.contains(p));
    CHECK(sample->current.speed().si() <= field.fastest().si());
  }
}

TEST_CASE("one source alone is itself, and a global grid has no seam at its cut") {
  std::vector<CompositeSource> sources;
  sources.push_back(source("globe", test::flat_axes(test::steps(-60, 2, 61), test::steps(0, 2, 180)), stream));
  const CompositeField alone{sources, kSeams};
  sources.insert(sources.begin(),
                 source("bay", test::flat_axes(test::steps(-1, 0.1, 21), test::steps(-1, 0.1, 21)), eddies));
  const CompositeField both{sources, kSeams};
  for (const double lon : {-179.9, -1.5, -0.01, 0.0, 0.01, 1.5, 90.0, 359.3}) {
    const auto p = geo_point(10, lon > 180 ? lon - 360 : lon);
    CHECK(same(alone, sources[1].field, p));
    CHECK(same(both, sources[1].field, p));
  }
  CHECK(same(both, sources[0].field, geo_point(0, 0.01)));
  CHECK(alone.faults().empty());
  CHECK(both.faults().empty());
}

TEST_CASE("what is wrong with sources taken together is told") {
  const auto of = [](const std::vector<CompositeSource>& sources) {
    std::string all;
    for (const auto& fault : CompositeField{sources, kSeams}.faults()) all += fault + "\n";
    return all;
  };
  auto sources = nested(kEastward, kWestward).sources();
  CHECK(of(sources).empty());
  auto far = sources;
  far[0] = source("far", test::flat_axes(test::steps(10, 0.5, 5), test::steps(50, 0.5, 5)), kEastward);
  CHECK(of(far) == "source 'far' overlaps no other source\nsource 'coarse' overlaps no other source\n");
  auto tiny = sources;
  tiny[0].region = SourceRegion{{geo_point(40, 5), geo_point(40, 5.08), geo_point(40.08, 5.08), geo_point(40.08, 5)}};
  CHECK(of(tiny) == "source 'regional' is nowhere wider than the cells at its edges: it is never used\n");
  tiny[0].region = SourceRegion{{geo_point(10, 5), geo_point(10, 5.08), geo_point(10.08, 5.08), geo_point(10.08, 5)}};
  CHECK(of(tiny).find("source 'regional' has no node with a current at all its times inside its region") == 0);
  auto times = cycles(24 * kHour, 96 * kHour, 0, 27 * kHour).sources();
  CHECK(of(times) == "source 'older' and source 'newer' overlap by 3.0 h, join_h is 6.0\n");
  times[1].from_s = 200 * kHour;
  CHECK(of(times).find("source 'older' has no times in the time that it is to be used") == 0);
}
