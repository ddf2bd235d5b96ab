#include "protocol/mafile_rules.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm::protocol;
using Mode = MafileOptions::Mode;

TEST_CASE("the mode decides how much a finding matters") {
  ProblemList lenient{Mode::lenient}, strict{Mode::strict};
  for (auto* list : {&lenient, &strict}) {
    list->add(3, 1, "note", Weight::note, "");
    list->add(2, 5, "doubt", Weight::doubt, "");
    list->add(2, 1, "fault", Weight::fault, "");
  }
  const auto loose = lenient.take(), tight = strict.take();
  REQUIRE(loose.size() == 2);
  CHECK((loose[0].code == "fault" && loose[0].severity == Severity::error));
  CHECK((loose[1].code == "doubt" && loose[1].severity == Severity::warning));
  REQUIRE(tight.size() == 3);
  for (const auto& p : tight) CHECK(p.severity == Severity::error);
  CHECK(tight[2].code == "note");
}

TEST_CASE("the behaviours that read a mafile are known in lower case") {
  CHECK(is_mafile_behavior("goto_list"));
  CHECK(is_mafile_behavior("prepare_to_dive"));
  CHECK_FALSE(is_mafile_behavior("Goto_list"));
  CHECK_FALSE(is_mafile_behavior(""));
}

TEST_CASE("a file without a position beside it is not compared with any") {
  Mafile file;
  file.behavior = "goto_list";
  MafileOptions options;
  ProblemList problems{Mode::lenient};
  check_mafile(file, options, problems);
  for (const auto& p : problems.take()) CHECK((p.code == "no-waypoints" || p.code == "missing-b-arg"));
}
