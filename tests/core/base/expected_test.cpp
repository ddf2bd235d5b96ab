#include "core/base/expected.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <string>

using namespace glidehelm;

TEST_CASE("an Expected holds a value or its error, never both") {
  const Expected<int, std::string> value{7};
  const Expected<int, std::string> error = unexpected(std::string{"no"});
  CHECK(value);
  CHECK(*value == 7);
  CHECK_FALSE(error);
  CHECK(error.error() == "no");
  CHECK(error.value_or(3) == 3);
}

TEST_CASE("an Expected moves what can only be moved") {
  Expected<std::unique_ptr<int>, std::string> value{std::make_unique<int>(5)};
  auto taken = std::move(value).value();
  CHECK(*taken == 5);
}
