#pragma once

#include <string>

#include "core/base/expected.hpp"
#include "core/safety/judge.hpp"
#include "daemon/verify/dossier_json.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::verify {

/// An input without which nothing can be judged: no verdict then, and so no file.
struct InputProblem {
  std::string path;  ///< the file, or the part of the request
  std::string what;
  [[nodiscard]] std::string message() const { return path + ": " + what; }
  friend bool operator==(const InputProblem&, const InputProblem&) = default;
};

/// Opens grid and coast of the request (mapped read-only), proves that they are the ones that were meant, and judges
/// the dossier. Without a coast file the grid's own dry nodes are land, whatever `grid_options` says: somebody must know
/// where land is. A request whose coast is named but cannot be read has no verdict.
Expected<safety::Verdict, InputProblem> judge_request(const VerifyRequest& request, world::Files& files);

/// The verdict for a person: one line per rule, those that do not hold first.
std::string explain(const safety::Verdict& verdict);

}  // namespace glidehelm::verify
