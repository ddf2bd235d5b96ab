#include "core/safety/judge.hpp"
#include "core/safety/margins.hpp"
#include "core/safety/rules.hpp"

namespace glidehelm::safety {

namespace {

Verdict refused(Verdict verdict, std::string rule, std::string message) {
  verdict.accepted = false;
  Margin margin = plain(false, std::move(message));
  margin.rule = std::move(rule);
  verdict.margins.push_back(std::move(margin));
  return verdict;
}

/// One margin for every rule, in the order of the rules: a verdict with fewer was not made by `judge`.
bool is_complete(const Verdict& verdict) {
  const auto all = rules();
  if (verdict.margins.size() != all.size()) return false;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (verdict.margins[i].rule != all[i].name) return false;
  return true;
}

}  // namespace

VerifiedFile::VerifiedFile(std::string name, std::string bytes, Verdict verdict)
    : name_{std::move(name)}, bytes_{std::move(bytes)}, verdict_{std::move(verdict)} {}

Expected<VerifiedFile, Verdict> accept(std::string name, std::string bytes, const Verdict& verdict) {
  if (Sha256::of(bytes) != verdict.of)
    return unexpected(refused(verdict, "4 hash", "these are not the bytes that were judged"));
  if (name != verdict.file_name)
    return unexpected(refused(verdict, "4 hash", "judged as '" + verdict.file_name + "', not as '" + name + "'"));
  if (!is_complete(verdict))
    return unexpected(refused(verdict, "4 verdict", "the verdict does not hold one margin per rule"));
  for (const auto& margin : verdict.margins)
    if (!margin.holds) return unexpected(refused(verdict, "4 verdict", "rule '" + margin.rule + "' does not hold"));
  if (!verdict.accepted) return unexpected(refused(verdict, "4 verdict", "the verdict says refused"));
  return VerifiedFile{std::move(name), std::move(bytes), verdict};
}

}  // namespace glidehelm::safety
