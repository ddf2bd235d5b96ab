#pragma once

#include <string_view>

#include "protocol/mafile.hpp"

namespace glidehelm::protocol {

/// How much a finding matters: `note` is an error in strict mode and not said in lenient mode; `doubt` is an error in
/// strict mode and a warning in lenient mode; `fault` is an error in both.
enum class Weight { note, doubt, fault };

/// Collects problems with the severity that the mode gives them.
class ProblemList {
 public:
  explicit ProblemList(MafileOptions::Mode mode) : mode_{mode} {}
  void add(int line, int column, std::string_view code, Weight weight, std::string_view message);
  /// In the order of the file; of one place in the order of finding.
  std::vector<MafileProblem> take();

 private:
  MafileOptions::Mode mode_;
  std::vector<MafileProblem> problems_;
};

/// True for the behaviours that read a mafile (slocum.md 2.6); lower case.
bool is_mafile_behavior(std::string_view behavior);

/// What masterdata is known to say (slocum.md 2.2, 2.6) against what the file says: names, units, ranges, duplicates,
/// defaults, counts, the end of the list, and, with a glider position, the place of each waypoint.
void check_mafile(const Mafile& file, const MafileOptions& options, ProblemList& problems);

}  // namespace glidehelm::protocol
