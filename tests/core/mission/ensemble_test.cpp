#include "core/mission/ensemble.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;

TEST_CASE("the files of a member have its number where the pattern says so") {
  const mission::Ensemble ensemble{12, 1, {"/a/m{member}/*.nc", "/b/{member:3}_u.nc"}};
  CHECK(ensemble.files_of(0) == std::vector<std::string>{"/a/m1/*.nc", "/b/001_u.nc"});
  CHECK(ensemble.files_of(11) == std::vector<std::string>{"/a/m12/*.nc", "/b/012_u.nc"});
}

TEST_CASE("a pattern that could match the files of another member is refused") {
  for (const auto* bad : {"m{member}*.nc", "*{member}.nc", "m0{member}.nc", "m{member}?.nc", "[ab]{member}.nc",
                          "m{member}[0-9].nc", "m{member}7.nc"})
    CHECK(mission::trouble_of_pattern(bad, 0, 9).find("beside a wildcard or a digit") != std::string::npos);
  for (const auto* good : {"m{member}_*.nc", "*/{member:2}.nc", "{member}", "{member:6}x"})
    CHECK(mission::trouble_of_pattern(good, 0, 99).empty());
}

TEST_CASE("a placeholder that is cut, too wide or twice is refused for what it is") {
  for (const auto* bad :
       {"m{member.nc", "m{member:0}.nc", "m{member:7}.nc", "m{member:}.nc", "m{member:2", "m{members}.nc"})
    CHECK(mission::trouble_of_pattern(bad, 0, 9) ==
          "the member is written {member}, or {member:W} with W digits from 1 to 6");
  CHECK(mission::trouble_of_pattern("m{member}_{member}.nc", 0, 9) == "a second {member}");
  CHECK(mission::trouble_of_pattern("m{member:2}.nc", 1, 100) == "the numbers 1 to 100 do not fit 2 digits");
  CHECK(mission::trouble_of_pattern("m{member:2}.nc", 0, 99).empty());
}

TEST_CASE("only a pattern with an opening brace and the word names its member") {
  CHECK(mission::names_member("m{member.nc"));
  CHECK_FALSE(mission::names_member("member_{a,b}.nc"));
}
