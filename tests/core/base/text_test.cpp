#include "core/base/text.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace glidehelm;

TEST_CASE("a number is the whole text, finite, in the C locale") {
  CHECK(number_from("-11741.8").value() == -11741.8);
  CHECK(number_from("+170.0").value() == 170.0);
  CHECK(number_from("1e3").value() == 1000.0);
  for (const char* text : {"", " 1", "1 ", "1,5", "nan", "inf", "-inf", "1e999", "0x10", "--1", "+-1", "1.2.3", "1e"}) {
    CAPTURE(text);
    CHECK_FALSE(number_from(text));
  }
}

TEST_CASE("the nearest key is found for one slip, and nothing for a stranger") {
  const std::vector<std::string> keys{"headings", "cell_km", "budget_s", "horizon_h", "method"};
  CHECK(nearest_word("headigns", keys) == "headings");
  CHECK(nearest_word("Method", keys) == "method");
  CHECK(nearest_word("budget", keys) == "budget_s");
  CHECK_FALSE(nearest_word("temperature", keys));
  CHECK_FALSE(nearest_word("x", std::vector<std::string>{}));
}

TEST_CASE("trimming and lower case are independent of the locale") {
  CHECK(trimmed(" \t a b \r\n") == "a b");
  CHECK(trimmed(" \n").empty());
  CHECK(lower("TVR20233.MI") == "tvr20233.mi");
  CHECK(equal_without_case("Koskelo", "kOSKELO"));
}

TEST_CASE("the base name is what follows the last slash") {
  CHECK(base_name("/dock/forecasts/a.nc") == "a.nc");
  CHECK(base_name("a.nc") == "a.nc");
  CHECK(base_name("folder/").empty());
  CHECK(base_name("").empty());
}
