#include <catch2/catch.hpp>
#include <type_traits>

#include "core/safety/judge.hpp"
#include "tests/support/verdict.hpp"

using namespace glidehelm;
using namespace glidehelm::safety;

static_assert(!std::is_default_constructible_v<VerifiedFile>);
static_assert(!std::is_constructible_v<VerifiedFile, std::string, std::string, Verdict>);
static_assert(!std::is_aggregate_v<VerifiedFile>);

TEST_CASE("a verdict proves the bytes it was made on") {
  const auto verdict = test::verdict_on("goto_l10.ma", "some bytes");
  const auto file = accept("goto_l10.ma", "some bytes", verdict);
  REQUIRE(file.has_value());
  CHECK(file->name() == "goto_l10.ma");
  CHECK(file->bytes() == "some bytes");
  CHECK(file->verdict() == verdict);
}

TEST_CASE("accept hashes again: other bytes, another name get no proof") {
  const auto verdict = test::verdict_on("goto_l10.ma", "some bytes");
  const auto bytes = accept("goto_l10.ma", "some byteS", verdict);
  REQUIRE_FALSE(bytes.has_value());
  CHECK_FALSE(bytes.error().accepted);
  CHECK(bytes.error().margins.back().rule == "4 hash");
  const auto name = accept("goto_l11.ma", "some bytes", verdict);
  REQUIRE_FALSE(name.has_value());
  CHECK(name.error().margins.back().rule == "4 hash");
}

TEST_CASE("accept takes no verdict that is refused, contradicts itself or lacks a rule") {
  auto refused = test::verdict_on("goto_l10.ma", "b", "2 land");
  CHECK_FALSE(accept("goto_l10.ma", "b", refused).has_value());
  refused.accepted = true;  // says accepted, but one margin does not hold
  const auto contradiction = accept("goto_l10.ma", "b", refused);
  REQUIRE_FALSE(contradiction.has_value());
  CHECK(contradiction.error().margins.back().message.find("2 land") != std::string::npos);
  auto said_no = test::verdict_on("goto_l10.ma", "b");
  said_no.accepted = false;
  CHECK_FALSE(accept("goto_l10.ma", "b", said_no).has_value());
  auto short_of_one = test::verdict_on("goto_l10.ma", "b");
  short_of_one.margins.pop_back();
  CHECK_FALSE(accept("goto_l10.ma", "b", short_of_one).has_value());
  auto renamed = test::verdict_on("goto_l10.ma", "b");
  renamed.margins.front().rule = "0 other";
  CHECK_FALSE(accept("goto_l10.ma", "b", renamed).has_value());
}
