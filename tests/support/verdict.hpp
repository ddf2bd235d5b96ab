#pragma once

#include <string>

#include "core/safety/rules.hpp"

namespace glidehelm::test {

/// A verdict as `judge` writes it, for tests of what comes after the judge: every rule holds, or all but `failing`.
inline safety::Verdict verdict_on(const std::string& name, const std::string& bytes, const std::string& failing = {}) {
  safety::Verdict verdict;
  verdict.of = Sha256::of(bytes);
  verdict.accepted = failing.empty();
  verdict.file_name = name;
  for (const auto& rule : safety::rules()) {
    safety::Margin margin;
    margin.rule = std::string{rule.name};
    margin.holds = rule.name != failing;
    verdict.margins.push_back(margin);
  }
  return verdict;
}

}  // namespace glidehelm::test
