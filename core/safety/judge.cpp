#include "core/safety/judge.hpp"

#include "core/safety/rules.hpp"

namespace glidehelm::safety {

Verdict judge(const Dossier& dossier, ocean::FieldRef forecast, const chart::Chart& chart,
              std::optional<double> issued_s) {
  std::optional<ocean::CorrectedField> corrected;
  if (dossier.correction && dossier.correction->plausible()) corrected.emplace(forecast, *dossier.correction);
  const ocean::FieldRef full = corrected ? ocean::FieldRef{*corrected} : forecast;
  const auto list = read_list(dossier.file_bytes, dossier.rules.max_waypoints);
  std::string why;
  std::optional<Flight> flight;
  if (list && can_be_flown(dossier, why)) flight = fly(order_for(dossier, *list), full);
  const Evidence evidence{dossier, list, flight, full, chart, issued_s};

  Verdict verdict;
  verdict.of = Sha256::of(dossier.file_bytes);
  verdict.file_name = dossier.file_name;
  verdict.accepted = true;
  for (const auto& rule : rules()) {
    Margin margin = rule.judge(evidence);
    margin.rule = rule.name;
    verdict.accepted = verdict.accepted && margin.holds;
    verdict.margins.push_back(std::move(margin));
  }
  return verdict;
}

}  // namespace glidehelm::safety
