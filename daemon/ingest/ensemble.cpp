#include "daemon/ingest/ensemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/ingest/recognise.hpp"

namespace glidehelm::ingest {

namespace {

constexpr std::array<std::string_view, 12> kNames{
    "ensemble",    "ens",          "member",          "members",    "number",          "realization",
    "realisation", "realizations", "ensemble_member", "ens_member", "ensemble_number", "ensemble_members"};

bool lies_on(const Variable& variable, std::size_t dimension) {
  return std::find(variable.dimensions.begin(), variable.dimensions.end(), dimension) != variable.dimensions.end();
}

/// True when a field of numbers lies on the dimension, and no position of its entries does.
bool may_count_members(const NetcdfFile& file, std::size_t dimension) {
  bool field = false;
  for (const auto& variable : file.variables()) {
    if (!is_number(variable.type) || !lies_on(variable, dimension)) continue;
    if (variable.dimensions.size() >= 3) field = true;
    const auto role = variable.dimensions.size() == 1 ? role_of(variable) : Role::none;
    if (role == Role::latitude || role == Role::longitude) return false;
  }
  return field;
}

/// How a dimension is known to count members, the surest first.
enum class Sign { realization, marked, name };
struct Candidate {
  EnsembleMember member;
  Sign sign{};
  const Variable* coordinate{};
};

std::optional<Candidate> candidate(const NetcdfFile& file, std::size_t dimension) {
  if (!may_count_members(file, dimension)) return std::nullopt;
  const auto& [name, length] = file.dimensions()[dimension];
  const Variable* own = nullptr;
  for (const auto& variable : file.variables()) {
    if (variable.dimensions != std::vector<std::size_t>{dimension}) continue;
    if (variable.name == name) own = &variable;
    if (lower(variable.text("standard_name")) == "realization")
      return Candidate{{dimension, length, 0, name, "standard_name realization", {}}, Sign::realization, &variable};
  }
  if (own != nullptr && lower(own->text("_CoordinateAxisType")) == "ensemble")
    return Candidate{{dimension, length, 0, name, "_CoordinateAxisType Ensemble", {}}, Sign::marked, own};
  if (own != nullptr && own->text("axis") == "E")
    return Candidate{{dimension, length, 0, name, "axis E", {}}, Sign::marked, own};
  const bool known = std::find(kNames.begin(), kNames.end(), lower(name)) != kNames.end();
  if (!known || (own != nullptr && role_of(*own) != Role::none)) return std::nullopt;
  return Candidate{{dimension, length, 0, name, "by name", {}}, Sign::name, own};
}

/// The number that the file gives its member, where it gives one.
std::optional<double> label_of(const NetcdfFile& file, const Variable* coordinate, std::size_t index) {
  if (coordinate == nullptr || !is_number(coordinate->type)) return std::nullopt;
  const std::array<std::size_t, 1> start{index}, count{1};
  const auto value = file.read(*coordinate, start, count);
  if (!value || !std::isfinite(value->front())) return std::nullopt;
  return value->front();
}

Result<std::optional<Candidate>> surest(const NetcdfFile& file) {
  std::vector<Candidate> found;
  for (std::size_t d = 0; d < file.dimensions().size(); ++d)
    if (auto one = candidate(file, d)) found.push_back(std::move(*one));
  if (found.empty()) return std::optional<Candidate>{};
  std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.sign < b.sign; });
  if (found.size() > 1 && found[1].sign == found[0].sign)
    return fault("several dimensions count members of an ensemble: " + found[0].member.name + " and " +
                 found[1].member.name + "; allowed is one");
  return std::optional{std::move(found.front())};
}

std::string number_text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return buffer;
}

std::string members_text(const EnsembleMember& member) {
  return std::to_string(member.count) + (member.count == 1 ? " member" : " members") + " along " + member.name + " (" +
         member.why + ")";
}

/// "member 3, counted from 0, of an ensemble of 10 members along number (standard_name realization), number 4".
std::string words(const EnsembleMember& member) {
  return "member " + std::to_string(member.index) + ", counted from 0, of an ensemble of " + members_text(member) +
         (member.label ? ", " + member.name + " " + number_text(*member.label) : "");
}

}  // namespace

Result<std::optional<EnsembleMember>> recognise_ensemble(const NetcdfFile& file) {
  auto found = surest(file);
  if (!found) return unexpected(found.error());
  if (!*found) return std::optional<EnsembleMember>{};
  auto member = (*found)->member;
  if (member.count > 0) member.label = label_of(file, (*found)->coordinate, 0);
  return std::optional{std::move(member)};
}

Result<NetcdfFile> one_member(Result<NetcdfFile> file, std::optional<std::size_t> asked) {
  if (!file) return file;
  const auto found = surest(*file);
  if (!found) return unexpected(found.error());
  if (!*found) return file;
  auto member = (*found)->member;
  member.index = asked.value_or(0);
  if (member.index >= member.count)
    return fault("it has no member " + std::to_string(member.index) + ": " + members_text(member) +
                 (member.count > 0 ? ", allowed is 0 to " + std::to_string(member.count - 1) : ""));
  member.label = label_of(*file, (*found)->coordinate, member.index);
  file->narrow(std::move(member));
  return file;
}

Result<Done> tell_member(Part& part, const NetcdfFile& file, std::optional<std::size_t> asked) {
  auto& facts = part.grid.facts;
  const auto* read = file.find(facts.east_variable.empty() ? facts.north_variable : facts.east_variable);
  if (read == nullptr || read->narrowed.empty() || !file.member()) {
    if (asked.value_or(0) == 0) return Done{};
    return fault("member " + std::to_string(*asked) +
                 " is asked for and it holds no ensemble: " + (read == nullptr ? "the current" : file.shape_of(*read)) +
                 " lies on no dimension with the standard_name realization, nor one called ensemble, member or number");
  }
  part.member = file.member();
  facts.layout += (facts.layout.empty() ? "" : "; ") + words(*part.member);
  return Done{};
}

bool of_one_member(const Part& a, const Part& b) {
  if (!a.member || !b.member) return !a.member && !b.member;
  return a.member->index == b.member->index && a.member->count == b.member->count && a.member->label == b.member->label;
}

Result<Done> same_member(const std::vector<Part>& parts) {
  const auto text = [](const Part& part) { return part.member ? words(*part.member) : std::string{"no ensemble"}; };
  for (const auto& part : parts)
    if (!of_one_member(part, parts.front()))
      return fault(part.file + ": it is " + text(part) + ", and " + parts.front().file + " is " + text(parts.front()) +
                   "; files that are joined hold the same member");
  return Done{};
}

}  // namespace glidehelm::ingest
