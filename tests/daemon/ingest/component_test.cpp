#include "daemon/ingest/component.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

const Units& units() {
  static const auto loaded = Units::load();
  REQUIRE(loaded);
  return *loaded;
}

Variable variable(Type type, std::vector<Attribute> attributes) {
  attributes.push_back({"units", Type::text, "m/s", {}});
  Variable made{0, "u", type, {}, std::move(attributes), false};
  made.is_unsigned = made.text("_Unsigned") == "true";
  return made;
}
Attribute number(const char* name, Type type, double value) { return {name, type, {}, {value}}; }

Component component(const Variable& of) {
  std::vector<std::string> warnings;
  auto made = Component::of(of, units(), warnings);
  REQUIRE(made);
  CHECK(warnings.empty());
  return *made;
}

}  // namespace

TEST_CASE("a fill value and a missing value both mark, and in whatever precision they are kept") {
  const auto both = component(variable(
      Type::float32, {number("_FillValue", Type::float32, -999), number("missing_value", Type::float32, 1e20F)}));
  CHECK(std::isnan(both(-999)));
  CHECK(std::isnan(both(static_cast<double>(1e20F))));
  CHECK(std::isnan(both(std::nan(""))));
  CHECK(both(0.25) == 0.25);
  // The mark in a file's text has six digits, the values were written from the full number, 2^100.
  const auto rounded = component(variable(Type::float32, {number("_FillValue", Type::float64, 1.26765e30)}));
  CHECK(std::isnan(rounded(0x1p100)));
  const auto wider = component(variable(Type::float64, {number("_FillValue", Type::float64, 9.99999993381581e+36)}));
  CHECK(std::isnan(wider(static_cast<double>(1e37F))));
  // A mark of 0 marks 0 only.
  const auto zero = component(variable(Type::float32, {number("missing_value", Type::float32, 0)}));
  CHECK(std::isnan(zero(0)));
  CHECK(zero(1e-30) == 1e-30);
}

TEST_CASE("misspelt and quoted marks count") {
  for (const char* name : {"FillValue", "FillValue_", "_fillvalue", "fill_value"})
    CHECK(std::isnan(component(variable(Type::float32, {number(name, Type::float64, 1e5)}))(1e5)));
  CHECK(std::isnan(
      component(variable(Type::float32, {{"missing_value", Type::text, "-99.9", {}}}))(static_cast<double>(-99.9F))));
}

TEST_CASE("the type's own fill value marks where no fill value is named") {
  CHECK(std::isnan(component(variable(Type::int16, {number("scale_factor", Type::float64, 1e-4)}))(-32767)));
  CHECK(std::isnan(component(variable(Type::float32, {}))(static_cast<double>(9.9692099683868690e+36F))));
  CHECK(component(variable(Type::int8, {number("scale_factor", Type::float64, 0.01)}))(-127) == Approx(-1.27));
  const auto named = component(
      variable(Type::int16, {number("_FillValue", Type::int16, -1), number("scale_factor", Type::float64, 1e-4)}));
  CHECK(named(-32767) == Approx(-3.2767));
}

TEST_CASE("unsigned numbers in signed types are what their bits say") {
  const auto bytes = variable(Type::int8, {{"_Unsigned", Type::text, "true", {}},
                                           number("_FillValue", Type::int8, -1),
                                           number("scale_factor", Type::float64, 0.01)});
  CHECK(bytes.as_meant(-56) == 200);
  CHECK(bytes.as_meant(100) == 100);
  const auto made = component(bytes);
  CHECK(made(bytes.as_meant(-56)) == Approx(2.0));
  CHECK(std::isnan(made(bytes.as_meant(-1))));
  const auto shorts = variable(Type::int16, {{"_Unsigned", Type::text, "true", {}}});
  CHECK(shorts.as_meant(-1) == 65535);
  CHECK(variable(Type::int16, {}).as_meant(-1) == -1);
}

TEST_CASE("a missing value that is written unpacked marks unpacked values") {
  const auto packed = component(
      variable(Type::int16, {number("scale_factor", Type::float64, 0.001), number("add_offset", Type::float64, 10),
                             number("missing_value", Type::float32, static_cast<double>(-9.999F))}));
  CHECK(std::isnan(packed(-19999)));  // −19.999 + 10
  CHECK(packed(-9000) == Approx(1.0));
}

TEST_CASE("the valid range masks nothing, and what lies outside is known") {
  const auto stored =
      component(variable(Type::int16, {number("scale_factor", Type::float64, 0.01),
                                       number("valid_min", Type::int16, -300), number("valid_max", Type::int16, 300)}));
  CHECK(stored(301) == Approx(3.01));
  CHECK(stored.outside_valid(301));
  CHECK_FALSE(stored.outside_valid(300));
  CHECK(stored.valid_text() == "-300 to 300");
  // Of another type than the packed one: meant unpacked.
  const auto unpacked = component(variable(
      Type::int16, {number("scale_factor", Type::float64, 0.01), {"valid_range", Type::float64, {}, {-3, 3}}}));
  CHECK(unpacked.outside_valid(301));
  CHECK_FALSE(unpacked.outside_valid(299));
  CHECK_FALSE(component(variable(Type::float32, {})).outside_valid(1e9));
}

TEST_CASE("impossible packings are refused") {
  std::vector<std::string> warnings;
  CHECK_FALSE(Component::of(variable(Type::int16, {number("scale_factor", Type::float64, 0)}), units(), warnings));
  CHECK_FALSE(Component::of(variable(Type::int16, {number("add_offset", Type::float64, NAN)}), units(), warnings));
}
