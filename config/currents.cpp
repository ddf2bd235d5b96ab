#include "config/currents.hpp"

#include <algorithm>
#include <limits>

#include "config/areas.hpp"
#include "config/paths.hpp"
#include "core/chart/areas.hpp"

namespace glidehelm::config {

namespace {

using mission::Interpolation;
using mission::OutsideTime;

constexpr int kMostFields = 16;

/// `files` and how they are read, for whatever holds them.
template <class T>
void add_files(Fields<T>& f, bool required) {
  f.texts({"files",
           "forecast files (NetCDF); shell patterns, or http:// and https:// addresses of OPeNDAP servers; several "
           "become one field, the newest cycle wins where they overlap",
           required, required ? "" : "none"},
          &T::files, 1);
}

template <class T>
void add_reading(Fields<T>& f) {
  Fields<T> variables;
  variables.text({"east", "variable of the eastward velocity", false, "recognised"}, &T::east);
  variables.text({"north", "variable of the northward velocity", false, "recognised"}, &T::north);
  f.word({"outside_time",
          "what holds before the first and after the last time of the files: the nearest time, the last 24.84 h "
          "again and again, or nothing"},
         &T::outside_time,
         std::vector<std::pair<std::string, OutsideTime>>{
             {"hold", OutsideTime::hold}, {"cycle", OutsideTime::cycle}, {"forbid", OutsideTime::forbid}});
  f.word({"interpolation",
          "between the nodes of the files, in space, depth and time; `cubic` and `akima` are smooth in depth and time "
          "and linear in space"},
         &T::interpolation,
         std::vector<std::pair<std::string, Interpolation>>{{"nearest", Interpolation::nearest},
                                                            {"linear", Interpolation::linear},
                                                            {"cubic", Interpolation::cubic},
                                                            {"akima", Interpolation::akima}});
  f.section({"variables", "names of the velocity variables, where they are not recognised"}, variables);
  f.time({"time_epoch", "time 0 of files whose time axis says none", false, "as the files say"}, &T::time_epoch);
  using Heights = mission::CurrentFiles::Heights;
  f.word({"heights",
          "currents from the slope of the sea surface (adt, zos, ssh, sla with mdt): where a file has no velocity, "
          "always, or never"},
         &T::heights,
         std::vector<std::pair<std::string, Heights>>{
             {"auto", Heights::when_needed}, {"always", Heights::always}, {"never", Heights::never}});
  f.number({"equator_band_deg", "latitude below which the slope of the sea surface says nothing of the current"},
           &T::equator_band, kPi / 180, from_to(0, 90));
  f.maybe_number({"fill_gaps_km",
                  "gaps of surface currents up to this distance are filled from both sides and count as extrapolated",
                  false, "two cells in files of HF radar, none in others"},
                 &T::fill_gaps, 1000, from_to(0, 500));
  f.text(
      {"grid_file",
       "the grid of a model that is not in its forecasts: positions, masks, angle, depth (found among the files too)",
       false, "none"},
      &T::grid_file);
  using Rotation = mission::CurrentFiles::Rotation;
  f.word({"rotation",
          "what a model's velocities on a turned grid are, where its files leave it open: along the grid's axes, "
          "turned by the file's angle or by the directions of the axes, or east and north already"},
         &T::rotation,
         std::vector<std::pair<std::string, Rotation>>{{"recognised", Rotation::recognised},
                                                       {"angle", Rotation::angle},
                                                       {"grid", Rotation::grid},
                                                       {"none", Rotation::none}});
  Fields<T> levels;
  levels.maybe_whole({"vtransform", "Vtransform of ROMS", false, "as the files say"}, &T::vtransform, from_to(1, 2));
  levels.maybe_whole({"vstretching", "Vstretching of ROMS", false, "as the files say"}, &T::vstretching, from_to(1, 5));
  levels.maybe_number({"theta_s", "stretching at the surface", false, "as the files say"}, &T::theta_s, 1,
                      from_to(0, 20));
  levels.maybe_number({"theta_b", "stretching at the sea floor", false, "as the files say"}, &T::theta_b, 1,
                      from_to(0, 4));
  levels.maybe_number(
      {"hc_m", "critical depth hc (with Vtransform 1 the lesser of Tcline and the least depth of the grid)", false,
       "as the files say"},
      &T::critical_depth, 1, from_to(0, 10000));
  f.section({"s_levels", "the stretching of ROMS levels that the files do not describe; all five keys"}, levels);
}

const Fields<SourceDraft>& source_fields() {
  using S = SourceDraft;
  static const Fields<S> kFields = [] {
    Fields<S> f;
    f.text({"name", "how log and status call the source; each another", true}, &S::name);
    add_files(f, true);
    f.custom(
        {"region", "where the source is used: a polygon whose edges run straight in latitude and longitude", false,
         "everywhere"},
        polygon_shape(), "",
        [](const At& at, S& source) {
          chart::Area area;
          read_polygon(at, area);
          if (area.vertices.size() < 3) return;
          auto checked = chart::checked_area("region", area.vertices);
          if (!checked) return at.complain(checked.error().message());
          source.region = std::move(checked->vertices);
        },
        [](const S& source, const std::string& path, Effective& out) {
          out.leaf(path, "region", source.region.empty() ? "" : polygon_text(source.region), "everywhere");
        });
    f.maybe_number({"from_h", "used from so many hours after the reference time (the first time where none is named)",
                    false, "its begin"},
                   &S::from, 3600, from_to(-2400, 2400));
    f.maybe_number({"to_h", "used up to so many hours after the reference time", false, "its end"}, &S::to, 3600,
                   from_to(-2400, 2400));
    add_reading(f);
    return f;
  }();
  return kFields;
}

void check_files(const At& at, FilesDraft& draft) {
  for (auto& file : draft.files) file = path_beside(at.reading.problems.file(), file);
  draft.grid_file = path_beside(at.reading.problems.file(), draft.grid_file);
  const int levels = (draft.vtransform ? 1 : 0) + (draft.vstretching ? 1 : 0) + (draft.theta_s ? 1 : 0) +
                     (draft.theta_b ? 1 : 0) + (draft.critical_depth ? 1 : 0);
  if (levels != 0 && levels != 5)
    at.reading.complain(at.path + ".s_levels",
                        "incomplete; allowed is vtransform, vstretching, theta_s, theta_b and hc_m together");
}

void read_sources(const At& at, CurrentsItem& item) {
  if (!expect_list(at, 1, kMostFields)) return;
  for (std::size_t i = 0; i < at.node.items.size(); ++i) {
    const auto source_at = at.item(i);
    at.reading.places[source_at.path] = source_at.node.place;
    SourceDraft source;
    if (expect_map(source_at)) source_fields().read(source_at, source);
    check_files(source_at, source);
    if (std::any_of(source.files.begin(), source.files.end(), mission::names_member))
      at.reading.complain(source_at.path + ".files", "{member} in a source: an ensemble is not one of several sources");
    if (source.from && source.to && *source.from >= *source.to)
      at.reading.complain(source_at.path + ".to_h", "not after from_h");
    for (const auto& other : item.sources)
      if (!source.name.empty() && other.name == source.name)
        at.reading.complain(source_at.path + ".name", "a second source of this name");
    item.sources.push_back(std::move(source));
  }
}

void print_sources(const CurrentsItem& item, const std::string& path, Effective& out) {
  if (item.sources.empty()) {
    out.leaf(path, "sources", "", "none");
    return;
  }
  out.open("sources");
  for (std::size_t i = 0; i < item.sources.size(); ++i) {
    out.open_item();
    source_fields().print(item.sources[i], path + "[" + std::to_string(i) + "]", out);
    out.close();
  }
  out.close();
}

const Fields<CurrentsItem>& item_fields() {
  using C = CurrentsItem;
  static const Fields<C> kFields = [] {
    Shape sources;
    sources.kind = Shape::Kind::list;
    sources.at_least = 1;
    sources.at_most = kMostFields;
    sources.parts.push_back(source_fields().shape());
    Fields<C> f;
    add_files(f, false);
    Fields<EnsembleDraft> ensemble;
    ensemble.maybe_whole({"members", "how many, the control included", false, "no ensemble"}, &EnsembleDraft::members,
                         from_to(1, 1000));
    ensemble.whole({"first",
                    "number of the control where names of files hold the member's: `{member}` in `files`, `{member:3}` "
                    "for three digits"},
                   &EnsembleDraft::first, from_to(0, 100000));
    f.part({"ensemble",
            "the files are an ensemble, a file or a dimension of each file to a member; plans are made in the control, "
            "the "
            "first member"},
           &C::ensemble, ensemble);
    f.custom({"sources",
              "instead of `files`: several sources, the most trusted first; each gives way smoothly to the next where "
              "it ends",
              false, "none"},
             sources, "", read_sources, print_sources);
    f.number({"blend_km", "a source fades out over this distance before it ends"}, &C::blend, 1000, from_to(1, 500));
    f.number({"join_h", "a source fades out over this time before it ends, where another one ends later"}, &C::join,
             3600, from_to(0.5, 72));
    f.custom(
        {"analytic", "a field by formula, for tests and demonstrations", false, "none"}, analytic_shape(), "",
        [](const At& at, C& c) {
          if (!expect_map(at)) return;
          c.analytic.emplace();
          read_analytic(at, *c.analytic);
        },
        [](const C& c, const std::string& path, Effective& out) {
          if (!c.analytic) {
            out.leaf(path, "analytic", "");
            return;
          }
          out.open("analytic");
          print_analytic(*c.analytic, path, out);
          out.close();
        });
    add_reading(f);
    f.flag({"local_correction", "what the glider measured less what the forecast said is added to it near the glider"},
           &C::local_correction);
    f.number({"correction_length_km", "L: the correction falls with the distance d as exp(−d²/2L²)"},
             &C::correction_length, 1000, from_to(1, 1000));
    f.number({"correction_time_h", "T: the correction falls with the time t as exp(−t/T)"}, &C::correction_time, 3600,
             from_to(0.5, 1000));
    return f;
  }();
  return kFields;
}

/// The fields of a list share one way of reading files: an option that an item sets holds for all of them.
template <class Member>
void share(std::vector<CurrentsItem>& items, Member member, const std::string& key, const At& at) {
  const std::size_t none = items.size();
  std::size_t setter = none;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto path = at.path + "[" + std::to_string(i) + "]." + key;
    if (at.reading.places.count(path) == 0) continue;
    if (setter == none)
      setter = i;
    else if (items[i].*member != items[setter].*member)
      at.reading.complain(path, "the fields of a list share one " + key + "; " + at.path + "[" +
                                    std::to_string(setter) + "] says otherwise");
  }
  if (setter == none) return;
  const auto value = items[setter].*member;
  for (auto& item : items) item.*member = value;
}

/// Ways of reading that stand beside `sources`, which have their own.
void check_beside_sources(const At& at, const FilesDraft& found) {
  const FilesDraft none;
  const auto check = [&](const char* key, bool set) {
    if (set)
      at.reading.complain(at.path + "." + key,
                          "stands beside sources; allowed is " + std::string{key} + " in each source");
  };
  check("outside_time", found.outside_time != none.outside_time);
  check("interpolation", found.interpolation != none.interpolation);
  check("variables", found.east != none.east || found.north != none.north);
  check("time_epoch", found.time_epoch.has_value());
  check("heights", found.heights != none.heights);
  check("equator_band_deg", found.equator_band != none.equator_band);
  check("fill_gaps_km", found.fill_gaps.has_value());
  check("grid_file", !found.grid_file.empty());
  check("rotation", found.rotation != none.rotation);
  check("s_levels", found.vtransform || found.vstretching || found.theta_s || found.theta_b || found.critical_depth);
}

/// Files that name their member want an ensemble, and an ensemble wants files, of which all name their member or none.
void check_ensemble(const At& at, const CurrentsItem& item) {
  const auto trouble = [&](const std::string& key, const std::string& problem, const std::string& allowed) {
    at.reading.complain(at.path + "." + key, problem, {}, allowed);
  };
  const auto& files = item.files;
  const auto named = static_cast<std::size_t>(std::count_if(files.begin(), files.end(), mission::names_member));
  const auto& [members, first] = item.ensemble;
  if (!members) {
    if (first != EnsembleDraft{}.first) trouble("ensemble.first", "there is no ensemble", "members beside it");
    if (named > 0) trouble("files", "{member} without an ensemble", "ensemble: {members: N}");
    return;
  }
  if (files.empty()) return trouble("ensemble", "there are no files that it could be in", "beside files");
  if (named == 0) {
    if (first != EnsembleDraft{}.first)
      trouble("ensemble.first", "no {member} in files: nothing has that number", "{member} in files");
    return;
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    const std::string key = "files[" + std::to_string(k) + "]";
    at.reading.places[at.path + "." + key] = at.node.find("files")->items[k].place;
    if (!mission::names_member(files[k]))
      trouble(key, "no {member} in '" + files[k] + "', others have one", "{member} in each, or in none");
    else if (const auto wrong = mission::trouble_of_pattern(files[k], first, first + *members - 1); !wrong.empty())
      trouble(key, wrong, "like ocean_{member}.nc or {member:2}/*.nc");
  }
}

CurrentsItem read_item(const At& at) {
  CurrentsItem item;
  if (!expect_map(at)) return item;
  item_fields().read(at, item);
  const auto has = [&](const char* key) {
    const auto* node = at.node.find(key);
    return node != nullptr && !node->is(Node::Kind::empty);
  };
  if (has("files") && has("analytic"))
    at.complain("both files and analytic", {}, "a list of maps, one field each, to add fields");
  if (has("sources") && (has("files") || has("analytic")))
    at.complain(std::string{"both sources and "} + (has("files") ? "files" : "analytic"), {},
                "files in each source; a list of maps, one field each, to add fields");
  if (!has("files") && !has("analytic") && !has("sources"))
    at.complain("no field", {}, "files: [PATTERN, …], sources: [{…}, …] or analytic: {…}");
  if (has("sources")) check_beside_sources(at, item);
  check_ensemble(at, item);
  check_files(at, item);
  return item;
}

/// How files are read, as the mission has it.
void resolve_files(const FilesDraft& draft, mission::CurrentFiles& files) {
  files.files.insert(files.files.end(), draft.files.begin(), draft.files.end());
  files.outside_time = draft.outside_time;
  files.interpolation = draft.interpolation;
  files.east_variable = draft.east;
  files.north_variable = draft.north;
  files.time_epoch = draft.time_epoch;
  files.heights = draft.heights;
  files.equator_band = draft.equator_band;
  files.fill_gaps = draft.fill_gaps;
  files.grid_file = draft.grid_file;
  files.rotation = draft.rotation;
  if (draft.vtransform && draft.vstretching && draft.theta_s && draft.theta_b && draft.critical_depth)
    files.s_levels = {*draft.vtransform, *draft.vstretching, *draft.theta_s, *draft.theta_b, *draft.critical_depth};
}

}  // namespace

Shape currents_shape() {
  Shape list;
  list.kind = Shape::Kind::list;
  list.at_least = 1;
  list.at_most = kMostFields;
  list.parts.push_back(item_fields().shape());
  return Fields<CurrentsItem>::any_of({item_fields().shape(), list});
}

void read_currents(const At& at, std::vector<CurrentsItem>& items) {
  items.clear();
  if (!at.node.is(Node::Kind::list)) {
    items.push_back(read_item(at));
    return;
  }
  if (!expect_list(at, 1, kMostFields)) return;
  bool files_before = false;
  for (std::size_t i = 0; i < at.node.items.size(); ++i) {
    const auto item_at = at.item(i);
    at.reading.places[item_at.path] = item_at.node.place;
    items.push_back(read_item(item_at));
    const bool files_here = !items.back().files.empty() || !items.back().sources.empty();
    if (files_before && files_here)
      item_at.complain("a second set of files", {},
                       "all files in one list, the newest cycle wins where they overlap; or sources: [{…}, …]");
    files_before = files_before || files_here;
  }
  share(items, &CurrentsItem::outside_time, "outside_time", at);
  share(items, &CurrentsItem::interpolation, "interpolation", at);
  share(items, &CurrentsItem::east, "variables.east", at);
  share(items, &CurrentsItem::north, "variables.north", at);
  share(items, &CurrentsItem::time_epoch, "time_epoch", at);
  share(items, &CurrentsItem::heights, "heights", at);
  share(items, &CurrentsItem::equator_band, "equator_band_deg", at);
  share(items, &CurrentsItem::fill_gaps, "fill_gaps_km", at);
  share(items, &CurrentsItem::grid_file, "grid_file", at);
  share(items, &CurrentsItem::rotation, "rotation", at);
  share(items, &CurrentsItem::vtransform, "s_levels.vtransform", at);
  share(items, &CurrentsItem::vstretching, "s_levels.vstretching", at);
  share(items, &CurrentsItem::theta_s, "s_levels.theta_s", at);
  share(items, &CurrentsItem::theta_b, "s_levels.theta_b", at);
  share(items, &CurrentsItem::critical_depth, "s_levels.hc_m", at);
  share(items, &CurrentsItem::blend, "blend_km", at);
  share(items, &CurrentsItem::join, "join_h", at);
  share(items, &CurrentsItem::local_correction, "local_correction", at);
  share(items, &CurrentsItem::correction_length, "correction_length_km", at);
  share(items, &CurrentsItem::correction_time, "correction_time_h", at);
}

void print_currents(const std::vector<CurrentsItem>& items, const std::string& path, Effective& out) {
  out.open("currents");
  if (items.size() == 1 && !out.is_set(path + "[0]")) {
    item_fields().print(items.front(), path, out);
  } else {
    for (std::size_t i = 0; i < items.size(); ++i) {
      out.open_item();
      item_fields().print(items[i], path + "[" + std::to_string(i) + "]", out);
      out.close();
    }
  }
  out.close();
}

mission::Currents resolve_currents(const std::vector<CurrentsItem>& items) {
  mission::Currents currents;
  for (const auto& item : items) {
    resolve_files(item, currents);
    if (item.ensemble.members) {
      mission::Ensemble ensemble{*item.ensemble.members, item.ensemble.first, {}};
      if (mission::names_member(item.files.front())) {
        ensemble.files = item.files;
        currents.files = ensemble.files_of(0);
      }
      currents.ensemble = std::move(ensemble);
    }
    for (const auto& draft : item.sources) {
      mission::CurrentSource source;
      resolve_files(draft, source);
      source.name = draft.name;
      source.region = draft.region;
      source.from = draft.from;
      source.to = draft.to;
      currents.sources.push_back(std::move(source));
    }
    currents.blend = item.blend;
    currents.join = item.join;
    currents.local_correction = item.local_correction;
    currents.correction_length = item.correction_length;
    currents.correction_time = item.correction_time;
    if (item.analytic) currents.analytic.push_back(resolve_analytic(*item.analytic));
  }
  return currents;
}

}  // namespace glidehelm::config
