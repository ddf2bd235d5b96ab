#pragma once

#include <string>
#include <vector>

#include "tests/bench/case_suite.hpp"

/// The cases on published currents: ways through the samples of GLIDEHELM_DATA, whose bytes stay where they are.
namespace glidehelm::suite {

struct RealCases {
  std::vector<Case> cases;
  std::vector<std::string> notes;  ///< a line for every way: what it leads through, or why it is left out
};

/// Every way of the table in real_cases.cpp whose files can be read below `folder`/currents and whose ends lie in their water. The departure
/// is the product's first time, U = 0.3 m/s, stints of 8 h to 200 m. Fields with depths are averaged over the dive; after its last time a
/// field is held. There is no chart: land is the mask of the field. Runs `glidehelm-ingest` from the folder of this program, or from PATH.
RealCases real_cases(const std::string& folder);

}  // namespace glidehelm::suite
