#include "daemon/ingest/model_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/ingest/axis_values.hpp"
#include "daemon/ingest/recognise.hpp"

namespace glidehelm::ingest {

namespace {

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

bool terrain_name(const std::string& name) {
  for (const char* known : {"s_rho", "s_w", "sc_r", "sigma", "siglay", "siglev"})
    if (lower(name) == known) return true;
  return false;
}

/// The role of a one-dimensional variable as the axis of levels or times; s-levels often say `positive` as well.
Role axis_role(const Variable& variable) { return terrain_name(variable.name) ? Role::terrain : role_of(variable); }

/// The one-dimensional coordinate over a dimension, that of its own name first.
const Variable* coordinate_over(const NetcdfFile& file, std::size_t dimension) {
  const std::string& name = file.dimensions()[dimension].name;
  const Variable* other = nullptr;
  for (const auto& variable : file.variables()) {
    if (variable.dimensions != std::vector<std::size_t>{dimension} || !is_number(variable.type)) continue;
    const Role role = axis_role(variable);
    if (role != Role::time && role != Role::depth && role != Role::terrain) continue;
    if (variable.name == name) return &variable;
    if (other == nullptr) other = &variable;
  }
  return other;
}

/// "s: s_rho C: Cs_r eta: zeta" as term → variable.
std::map<std::string, std::string> terms_of(const std::string& formula) {
  std::map<std::string, std::string> terms;
  std::istringstream words{formula};
  for (std::string term, variable; words >> term >> variable;)
    if (term.size() > 1 && term.back() == ':') terms[term.substr(0, term.size() - 1)] = variable;
  return terms;
}

std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

/// What the files say about terrain-following levels.
struct Description {
  const ModelFiles& files;
  const Variable* coordinate{};
  std::map<std::string, std::string> terms;

  [[nodiscard]] Found term(const char* name, std::initializer_list<std::string_view> others) const {
    const auto at = terms.find(name);
    if (at != terms.end())
      if (const auto found = files.find(at->second)) return found;
    return files.first_of(others);
  }
};

Result<std::optional<LevelLaw>> law_of(const Description& d) {
  std::optional<LevelLaw> named;
  const std::string standard = d.coordinate == nullptr ? "" : lower(d.coordinate->text("standard_name"));
  if (standard == "ocean_sigma_coordinate") named = LevelLaw::sigma;
  if (standard == "ocean_s_coordinate") named = LevelLaw::s_coordinate;
  if (standard == "ocean_s_coordinate_g1") named = LevelLaw::transform_1;
  if (standard == "ocean_s_coordinate_g2") named = LevelLaw::transform_2;
  if (!named && standard.rfind("ocean_", 0) == 0)
    return fault("levels of the kind " + standard + " are not read; allowed are depths, ocean_sigma_coordinate, " +
                 "ocean_s_coordinate, ocean_s_coordinate_g1 and ocean_s_coordinate_g2");
  if (!named && d.coordinate != nullptr && (lower(d.coordinate->name) == "sigma" || d.terms.count("sigma") != 0))
    named = LevelLaw::sigma;
  const auto transform = scalar_of(d.files.find("Vtransform"));
  if (!transform) return named;
  if (*transform != 1 && *transform != 2) return fault("Vtransform = " + number(*transform) + ", allowed is 1 or 2");
  const LevelLaw law = *transform == 1 ? LevelLaw::transform_1 : LevelLaw::transform_2;
  // Older ROMS files say ocean_s_coordinate whatever their transform is.
  if (named && *named != LevelLaw::s_coordinate && *named != law)
    return fault("Vtransform = " + number(*transform) + " contradicts the standard_name " + standard);
  return std::optional{law};
}

/// C(s) of the files: as numbers, or by Vstretching and its parameters; empty when they do not say.
Result<std::vector<double>> curve_of(const Description& d, const std::vector<double>& s) {
  if (const auto found = d.term("C", {"Cs_r"})) {
    auto values = plain_numbers(found);
    if (!values) return values;
    if (values->size() == s.size()) return values;
  }
  StretchingChoice choice;
  const auto a = scalar_of(d.term("a", {"theta_s"})), b = scalar_of(d.term("b", {"theta_b"}));
  const auto stretching = scalar_of(d.files.find("Vstretching"));
  const bool classic = d.terms.count("a") != 0 && d.terms.count("b") != 0;  // CF's own formula is stretching 1
  if (!a || !b || (!stretching && !classic)) return std::vector<double>{};
  choice.vstretching = stretching ? static_cast<int>(*stretching) : 1;
  choice.theta_s = *a;
  choice.theta_b = *b;
  if (choice.vstretching < 1 || choice.vstretching > 5)
    return fault("Vstretching = " + number(*stretching) + ", allowed is 1 to 5");
  std::vector<double> c;
  for (const double value : s) c.push_back(stretching_curve(choice, value));
  return c;
}

std::vector<double> curve_by(const StretchingChoice& choice, const std::vector<double>& s) {
  std::vector<double> c;
  for (const double value : s) c.push_back(stretching_curve(choice, value));
  return c;
}

std::string law_words(LevelLaw law) {
  switch (law) {
    case LevelLaw::sigma:
      return "sigma";
    case LevelLaw::s_coordinate:
      return "ocean_s_coordinate";
    case LevelLaw::transform_1:
      return "Vtransform 1";
    case LevelLaw::transform_2:
      return "Vtransform 2";
  }
  return {};
}

Unexpected<Fault> unknown_levels(const Levels& levels, const std::string& missing, const ModelVelocity& velocity,
                                 const ModelFiles& files) {
  const bool means = velocity.u.variable->name != "ubar" && files.find("ubar") && files.find("vbar");
  return fault_alone(std::to_string(levels.count) +
                     " terrain-following levels whose depths are not known: the files have no " + missing +
                     "; say --s-levels vtransform=…,vstretching=…,theta_s=…,theta_b=…,hc=…" +
                     (means ? ", or read the depth mean with --variables ubar,vbar" : ""));
}

/// Law, s, C and hc: from the files, else as given.
Result<TerrainLevels> terrain_of(const Description& d, const Levels& levels, const ModelVelocity& velocity,
                                 const std::optional<StretchingChoice>& given, std::vector<std::string>& warnings,
                                 std::string& words) {
  TerrainLevels terrain;
  const auto law = law_of(d);
  if (!law) return unexpected(law.error());
  std::string missing;
  const auto lacks = [&](const char* what) { missing += (missing.empty() ? "" : ", no ") + std::string{what}; };
  if (*law)
    terrain.law = **law;
  else if (!given)
    lacks("Vtransform");
  else
    terrain.law = given->vtransform == 1 ? LevelLaw::transform_1 : LevelLaw::transform_2;
  const bool sigma = *law && terrain.law == LevelLaw::sigma;

  const Found own = d.coordinate != nullptr ? Found{velocity.u.file, d.coordinate} : Found{};
  Found s = d.term(sigma ? "sigma" : "s", {"s_rho", "sc_r"});
  if (!s || s.variable->dimensions.size() != 1) s = own;
  if (s && s.variable->dimensions.size() == 1) {
    auto values = plain_numbers(s);
    if (!values) return unexpected(values.error());
    if (values->size() == levels.count) terrain.s = std::move(*values);
  }
  const auto stretching = scalar_of(d.files.find("Vstretching"));
  const bool by_given = given && (!*law || !stretching);
  if (terrain.s.empty() && sigma) lacks("sigma");
  if (terrain.s.empty() && !sigma)
    terrain.s = s_of_layers(levels.count, by_given     ? given->vstretching
                                          : stretching ? static_cast<int>(*stretching)
                                                       : 1);

  bool used = !*law && given;
  std::string c_words;
  if (!sigma) {
    auto c = curve_of(d, terrain.s);
    if (!c) return unexpected(c.error());
    terrain.c = std::move(*c);
    c_words = d.term("C", {"Cs_r"}) ? ", Cs_r of the file" : ", stretching computed";
    if (terrain.c.empty() && given) {
      terrain.c = curve_by(*given, terrain.s);
      used = true;
      c_words = ", Vstretching " + std::to_string(given->vstretching) + ", theta_s " + number(given->theta_s) +
                ", theta_b " + number(given->theta_b) + " as given";
    } else if (terrain.c.empty()) {
      lacks("Cs_r");
    }
    if (const auto hc = scalar_of(d.term("depth_c", {"hc"}))) {
      terrain.hc_m = *hc;
    } else if (given) {
      terrain.hc_m = given->hc_m;
      used = true;
    } else {
      lacks("hc");
    }
  }
  if (!missing.empty()) return unknown_levels(levels, missing, velocity, d.files);
  if (given && !used)
    warnings.emplace_back("the files describe their levels themselves; the s-levels given are not used");
  if (auto sound = check_levels(terrain); !sound) return unexpected(sound.error());
  words = std::to_string(levels.count) + " terrain-following levels (" + law_words(terrain.law) + c_words +
          (sigma ? "" : ", hc " + number(terrain.hc_m) + " m");
  return terrain;
}

/// Depth of the water at the centres.
Result<std::vector<double>> water_depth(const Description& d, const Shape& centres, std::string& words) {
  const Found found = d.term("depth", {"h", "bathymetry", "Bathymetry", "hbatt", "bathy"});
  if (!found)
    return fault_alone(
        "terrain-following levels need the depth of the water (h); name the model's grid file among the files or "
        "with --grid-file");
  if (shape_of(found) != centres)
    return fault("the depth of the water " + found.file->shape_of(*found.variable) +
                 " does not have the shape of the grid's points, " + text(centres));
  auto h = plain_numbers(found);
  if (!h) return h;
  if (h->size() != centres.rows * centres.columns)
    return fault("the depth of the water " + found.file->shape_of(*found.variable) + " is no single plane");
  const double middle = median([&] {
    std::vector<double> known;
    for (const double value : *h)
      if (!std::isnan(value) && value != 0) known.push_back(value);
    return known;
  }());
  if (!(middle > 0 && middle < 12000))
    return fault("the depth of the water " + found.variable->name + " has the median " + number(middle) +
                 " m, allowed is positive down, up to 12000 m");
  words += ", " + found.variable->name + ")";
  return h;
}

/// The surface, if the files have it at the times of the velocity.
Found surface_of(const Description& d, const ModelVelocity& velocity, const Splitting& u, const Shape& centres,
                 std::string& words) {
  const Found zeta = d.term("eta", {"zeta", "ssh"});
  words += ", below zeta = 0";
  if (!zeta || shape_of(zeta) != centres) return {};
  const auto parts = split(zeta);
  if (!parts || parts->level) return {};
  const std::size_t times = parts->time ? length_of(zeta, *parts->time) : 1;
  if (times > 1 || (parts->time && u.time)) {
    if (!u.time || times != length_of(velocity.u, *u.time)) return {};
    if (parts->time_coordinate != nullptr && u.time_coordinate != nullptr) {
      const auto a = plain_numbers({zeta.file, parts->time_coordinate}),
                 b = plain_numbers({velocity.u.file, u.time_coordinate});
      if (!a || !b || *a != *b || parts->time_coordinate->unit() != u.time_coordinate->unit()) return {};
    }
  }
  words.resize(words.rfind(", below"));
  words += ", below the moving surface " + zeta.variable->name;
  return zeta;
}

Result<Levels> z_levels(Levels levels, const ModelVelocity& velocity, const Splitting& u, const Splitting& v,
                        const Units& units, std::vector<std::string>& warnings) {
  auto axis = depths(*velocity.u.file, *u.level_coordinate, units, warnings);
  if (!axis) return unexpected(axis.error());
  if (v.level_coordinate != nullptr &&
      (v.level_coordinate != u.level_coordinate || velocity.u.file != velocity.v.file)) {
    std::vector<std::string> said;
    const auto other = depths(*velocity.v.file, *v.level_coordinate, units, said);
    if (!other) return unexpected(other.error());
    if (other->values != axis->values) return fault("the two components have different depths");
  }
  levels.has_depth = true;
  levels.depths = std::move(axis->values);
  levels.order = std::move(axis->source);
  levels.words = std::to_string(levels.count) + " depths of the file";
  return levels;
}

}  // namespace

std::size_t length_of(const Found& found, std::size_t position) {
  return found.file->length_of(found.variable->dimensions[position]);
}

Result<Splitting> split(const Found& velocity) {
  Splitting split;
  const auto& dimensions = velocity.variable->dimensions;
  if (dimensions.size() < 2) return fault(velocity.file->shape_of(*velocity.variable) + " has no rows and columns");
  for (std::size_t d = 0; d + 2 < dimensions.size(); ++d) {
    const auto& dimension = velocity.file->dimensions()[dimensions[d]];
    const auto* coordinate = coordinate_over(*velocity.file, dimensions[d]);
    const Role role = coordinate == nullptr ? Role::none : axis_role(*coordinate);
    const bool terrain = role == Role::terrain || (role == Role::none && terrain_name(dimension.name));
    if (role == Role::time && !split.time) {
      split.time = d;
      split.time_coordinate = coordinate;
    } else if ((role == Role::depth || terrain) && !split.level) {
      split.level = d;
      split.level_coordinate = coordinate;
      split.terrain = terrain;
    } else if (role == Role::none && contains(lower(dimension.name), "time") && !split.time) {
      split.time = d;
    } else if (dimension.length != 1) {
      return fault("dimension " + dimension.name + " of " + velocity.file->shape_of(*velocity.variable) +
                   " is neither time nor depth");
    }
  }
  return split;
}

Result<Levels> levels_of(const ModelFiles& files, const ModelVelocity& velocity, const Splitting& u, const Splitting& v,
                         const Shape& centres, const Units& units, const std::optional<StretchingChoice>& given,
                         std::vector<std::string>& warnings) {
  Levels levels;
  levels.depths = {0.0};
  if (u.level.has_value() != v.level.has_value()) return fault("only one of the two components has levels");
  if (!u.level) return levels;
  levels.count = length_of(velocity.u, *u.level);
  if (length_of(velocity.v, *v.level) != levels.count) return fault("the two components have different levels");
  if (!u.terrain) return z_levels(std::move(levels), velocity, u, v, units, warnings);

  Description d{files, u.level_coordinate, {}};
  if (d.coordinate != nullptr) d.terms = terms_of(d.coordinate->text("formula_terms"));
  auto terrain = terrain_of(d, levels, velocity, given, warnings, levels.words);
  if (!terrain) return unexpected(terrain.error());
  levels.terrain = std::move(*terrain);
  auto h = water_depth(d, centres, levels.words);
  if (!h) return unexpected(h.error());
  levels.h = std::move(*h);
  levels.has_depth = true;
  levels.zeta = surface_of(d, velocity, u, centres, levels.words);
  return levels;
}

Result<std::vector<double>> surface_at(const Levels& levels, std::size_t time) {
  if (!levels.zeta) return std::vector<double>{};
  const auto& variable = *levels.zeta.variable;
  const auto parts = split(levels.zeta);
  if (!parts) return unexpected(parts.error());
  const std::size_t rank = variable.dimensions.size();
  std::vector<std::size_t> start(rank, 0), count(rank, 1);
  for (const std::size_t d : {rank - 2, rank - 1}) count[d] = length_of(levels.zeta, d);
  if (parts->time && length_of(levels.zeta, *parts->time) > 1) start[*parts->time] = time;
  return plain_numbers(levels.zeta, start, count);
}

}  // namespace glidehelm::ingest
