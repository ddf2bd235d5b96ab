#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/yaml_reader/fields.hpp"
#include "core/mission/mission.hpp"

/// `analytic` in the `currents` of a mission: a field by formula.
namespace glidehelm::config {

/// Parameters of every analytic kind; `parameters_of` says which belong to one.
struct AnalyticParams {
  std::optional<double> u, v, omega, rate, a, epsilon, b0, theta, k, c;
  std::optional<bool> dynamic;
  std::vector<std::vector<double>> list;
};

/// `analytic:` as it stands in the file.
struct AnalyticDraft : mission::AnalyticSpec {
  std::optional<double> lat_deg, lon_deg;
  AnalyticParams given;
};

Shape analytic_shape();
/// Reads `analytic`. Parameters that the file leaves out get their defaults; those that the kind does not have, or requires, are complained of.
void read_analytic(const At& at, AnalyticDraft& draft);
void print_analytic(const AnalyticDraft& draft, const std::string& path, Effective& out);
/// A field that was read without complaint as the mission has it.
mission::AnalyticSpec resolve_analytic(const AnalyticDraft& draft);

}  // namespace glidehelm::config
