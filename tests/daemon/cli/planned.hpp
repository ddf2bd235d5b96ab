#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "daemon/cli/plan.hpp"
#include "tests/daemon/cli/field_verb.hpp"

/// `glidehelm plan --json` in process, without a clock: no --budget, every stage to the end of its work.
namespace glidehelm::test {

/// The document of a plan that ends with one of the exit codes.
inline nlohmann::json planned(cli::PlanOptions options, std::initializer_list<int> codes) {
  options.json = true;
  const auto said = run_verb(cli::run_plan, options);
  INFO(said.err << said.out);
  REQUIRE(std::count(codes.begin(), codes.end(), said.code) == 1);
  return nlohmann::json::parse(said.out);
}
/// The same of a mission's text, which is written into the folder.
inline nlohmann::json planned(const ScratchFolder& folder, const std::string& mission,
                              std::initializer_list<int> codes) {
  write_bytes(folder / "m.yaml", mission);
  cli::PlanOptions options;
  options.mission = folder / "m.yaml";
  return planned(std::move(options), codes);
}

}  // namespace glidehelm::test
