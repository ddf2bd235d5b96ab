#include "config/analytic_field.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace glidehelm::config {

namespace {

Range any_number() { return {}; }

/// A parameter of a kind: where it stands, and its value when the file leaves it out.
struct Parameter {
  const char* name;
  std::optional<double> AnalyticParams::*member;
  std::optional<double> standard;  ///< none: required
};

/// Numbers that each kind takes (product.md 5), with the values of Thesis 5.1.2.4 (double eddy) and 5.1.2.7 = Eichhorn
/// 6.1 (jet).
const std::vector<std::pair<std::string, std::vector<Parameter>>>& parameters() {
  static const std::vector<std::pair<std::string, std::vector<Parameter>>> kTable{
      {"constant", {{"u", &AnalyticParams::u, std::nullopt}, {"v", &AnalyticParams::v, std::nullopt}}},
      {"source", {}},
      {"sink", {}},
      {"solid-body", {{"omega", &AnalyticParams::omega, 1.0}}},
      {"shear", {{"rate", &AnalyticParams::rate, 1.0}}},
      {"double-eddy",
       {{"A", &AnalyticParams::a, 0.1},
        {"epsilon", &AnalyticParams::epsilon, 0.25},
        {"omega", &AnalyticParams::omega, 2 * kPi}}},
      {"stuart", {}},
      {"tiled", {}},
      {"jet",
       {{"B0", &AnalyticParams::b0, 1.2},
        {"epsilon", &AnalyticParams::epsilon, 0.3},
        {"omega", &AnalyticParams::omega, 0.4},
        {"theta", &AnalyticParams::theta, kPi / 2},
        {"k", &AnalyticParams::k, 0.84},
        {"c", &AnalyticParams::c, 0.12}}},
      {"gaussians", {}}};
  return kTable;
}

const std::vector<Parameter>& parameters_of(const std::string& kind) {
  static const std::vector<Parameter> kNone;
  for (const auto& row : parameters())
    if (row.first == kind) return row.second;
  return kNone;
}

std::vector<std::string> names_of(const std::string& kind) {
  std::vector<std::string> names;
  for (const auto& parameter : parameters_of(kind)) names.emplace_back(parameter.name);
  if (kind == "tiled") names.emplace_back("dynamic");
  if (kind == "gaussians") names.emplace_back("list");
  return names;
}

void read_gaussians(const At& at, AnalyticParams& params) {
  if (!expect_list(at, 1, std::numeric_limits<int>::max())) return;
  for (std::size_t i = 0; i < at.node.items.size(); ++i) {
    const auto row_at = at.item(i);
    if (!expect_list(row_at, 8, 8)) continue;
    std::vector<double> row;
    for (std::size_t j = 0; j < 8; ++j)
      if (const auto value = read_number(row_at.item(j), any_number())) row.push_back(*value);
    if (row.size() != 8) continue;
    if (!(row[3] > 0 && row[5] > 0 && row[3] * row[5] > row[4] * row[4]))
      row_at.complain("sxx, sxy, syy are no covariance", {}, "sxx > 0, syy > 0, sxx·syy > sxy²");
    params.list.push_back(std::move(row));
  }
}

std::string gaussians_text(const std::vector<std::vector<double>>& rows) {
  std::string text = "[";
  for (const auto& row : rows) {
    text += text.size() == 1 ? "[" : ", [";
    for (std::size_t j = 0; j < row.size(); ++j) text += (j == 0 ? "" : ", ") + yaml_number(row[j]);
    text += "]";
  }
  return text + "]";
}

Fields<AnalyticParams> params_fields() {
  using P = AnalyticParams;
  const auto& none = "by the kind";
  Shape flag;
  flag.kind = Shape::Kind::flag;
  Shape rows;
  rows.kind = Shape::Kind::list;
  rows.at_least = 1;
  Shape row;
  row.kind = Shape::Kind::list;
  row.at_least = row.at_most = 8;
  row.parts.push_back(Fields<P>::number_shape(any_number()));
  rows.parts.push_back(row);
  Fields<P> f;
  f.maybe_number({"u", "`constant`: eastward part, times `speed_scale_m_per_s`", false, none}, &P::u, 1, any_number());
  f.maybe_number({"v", "`constant`: northward part", false, none}, &P::v, 1, any_number());
  f.maybe_number({"omega", "`solid-body` (1), `double-eddy` (2π), `jet` (0.4): angular rate", false, none}, &P::omega,
                 1, any_number());
  f.maybe_number({"rate", "`shear` (1): change of the eastward part with y", false, none}, &P::rate, 1, any_number());
  f.maybe_number({"A", "`double-eddy` (0.1): amplitude", false, none}, &P::a, 1, any_number());
  f.maybe_number({"epsilon", "`double-eddy` (0.25), `jet` (0.3): size of the oscillation", false, none}, &P::epsilon, 1,
                 any_number());
  f.custom(
      {"dynamic", "`tiled` (false): the eddies travel", false, none}, flag, "",
      [](const At& at, P& p) {
        if (const auto value = read_flag(at)) p.dynamic = *value;
      },
      [](const P& p, const std::string& path, Effective& out) {
        out.leaf(path, "dynamic", p.dynamic.value_or(false) ? "true" : "false");
      });
  f.maybe_number({"B0", "`jet` (1.2): mean width of the meander", false, none}, &P::b0, 1, any_number());
  f.maybe_number({"theta", "`jet` (π/2): phase", false, none}, &P::theta, 1, any_number());
  f.maybe_number({"k", "`jet` (0.84): wave number", false, none}, &P::k, 1, any_number());
  f.maybe_number({"c", "`jet` (0.12): phase speed", false, none}, &P::c, 1, any_number());
  f.custom(
      {"list", "`gaussians`: rows of weight, centre x and y, covariance sxx, sxy, syy, velocity vx, vy", false, none},
      rows, "", read_gaussians,
      [](const P& p, const std::string& path, Effective& out) { out.leaf(path, "list", gaussians_text(p.list)); });
  return f;
}

void read_params(const At& at, AnalyticDraft& draft) {
  static const auto kFields = params_fields();
  if (expect_map(at)) kFields.read(at, draft.given);
}

void print_params(const AnalyticDraft& draft, const std::string& path, Effective& out) {
  const auto names = names_of(draft.kind);
  if (names.empty()) {
    out.leaf(path, "params", "{}");
    return;
  }
  out.open("params");
  for (const auto& parameter : parameters_of(draft.kind))
    out.leaf(path + "." + parameter.name, parameter.name, yaml_number((draft.given.*parameter.member).value_or(0)));
  if (draft.kind == "tiled")
    out.leaf(path + ".dynamic", "dynamic", draft.given.dynamic.value_or(false) ? "true" : "false");
  if (draft.kind == "gaussians") out.leaf(path + ".list", "list", gaussians_text(draft.given.list));
  out.close();
}

const Fields<AnalyticDraft>& analytic_fields() {
  using A = AnalyticDraft;
  static const Fields<A> kFields = [] {
    std::vector<std::pair<std::string, std::string>> kinds;
    for (const auto& row : parameters()) kinds.emplace_back(row.first, row.first);
    Fields<A> origin;
    origin.latitude({"lat_deg", "latitude of x = y = 0", true}, &A::lat_deg);
    origin.longitude({"lon_deg", "longitude of x = y = 0", true}, &A::lon_deg);
    Fields<A> f;
    f.word({"kind", "which field", true}, &A::kind, kinds);
    f.section({"origin", "position of x = y = 0", true}, origin);
    f.number({"length_scale_m", "L: metres to one unit of x and y", true}, &A::length_scale, 1, above(0, 1e7));
    f.number({"speed_scale_m_per_s", "V: speed to one unit of (u, v)", true}, &A::speed_scale, 1, above(0, 5));
    f.maybe_number({"time_scale_s", "T: seconds to one unit of time", false, "L/V"}, &A::time_scale, 1, above(0, 1e10));
    f.time({"t0", "when the time of the field is 0", false, "the start time"}, &A::t0);
    f.flag({"south", "both components change sign, as on the southern hemisphere (Thesis 5.4–5.5)"}, &A::south);
    f.custom({"params", "parameters of the kind; in brackets the value when left out"}, params_fields().shape(), "",
             read_params, print_params);
    return f;
  }();
  return kFields;
}

void check_params(const At& at, AnalyticDraft& draft) {
  if (draft.kind.empty()) return;
  const auto names = names_of(draft.kind);
  const auto path = at.path + ".params";
  auto& places = at.reading.places;
  for (auto it = places.lower_bound(path + "."); it != places.end() && it->first.rfind(path + ".", 0) == 0; ++it) {
    const auto name = it->first.substr(path.size() + 1);
    if (name.find_first_of(".[") != std::string::npos) continue;
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      std::string allowed;
      for (const auto& known : names) allowed += (allowed.empty() ? "" : ", ") + known;
      at.reading.complain(it->first, "no parameter of the kind " + draft.kind, {}, allowed.empty() ? "none" : allowed);
    }
  }
  for (const auto& parameter : parameters_of(draft.kind)) {
    auto& value = draft.given.*parameter.member;
    if (!value && !parameter.standard && places.count(path + "." + parameter.name) == 0)
      at.reading.complain(path + "." + parameter.name, "missing; the kind " + draft.kind + " requires it");
    if (!value) value = parameter.standard;
  }
  if (draft.kind == "gaussians" && places.count(path + ".list") == 0)
    at.reading.complain(path + ".list", "missing; the kind gaussians requires it");
}

}  // namespace

Shape analytic_shape() { return analytic_fields().shape(); }

void read_analytic(const At& at, AnalyticDraft& draft) {
  analytic_fields().read(at, draft);
  check_params(at, draft);
}

void print_analytic(const AnalyticDraft& draft, const std::string& path, Effective& out) {
  analytic_fields().print(draft, path, out);
}

mission::AnalyticSpec resolve_analytic(const AnalyticDraft& draft) {
  mission::AnalyticSpec spec = draft;
  spec.origin = GeoPoint::from_degrees(*draft.lat_deg, *draft.lon_deg).value();
  for (const auto& parameter : parameters_of(spec.kind))
    spec.params.emplace_back(parameter.name, *(draft.given.*parameter.member));
  if (spec.kind == "tiled") spec.params.emplace_back("dynamic", draft.given.dynamic.value_or(false) ? 1.0 : 0.0);
  spec.gaussians = draft.given.list;
  return spec;
}

}  // namespace glidehelm::config
