#include "daemon/verify/judge_request.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/chart/bathymetry.hpp"
#include "core/chart/coast.hpp"
#include "core/ocean/analytic.hpp"
#include "core/ocean/composite.hpp"
#include "core/ocean/freshness.hpp"
#include "core/ocean/grid_format.hpp"
#include "core/ocean/gridded.hpp"

namespace glidehelm::verify {

namespace {

Unexpected<InputProblem> problem(std::string path, std::string what) {
  return unexpected(InputProblem{std::move(path), std::move(what)});
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The fields of a request, and what keeps their numbers alive.
struct Waters {
  std::vector<std::shared_ptr<const world::Mapping>> bytes;
  std::vector<ocean::GriddedField> grids;
  std::optional<ocean::CompositeField> composite;
  std::vector<ocean::AnalyticField> formulas;
  std::vector<ocean::FieldRef> parts;
  std::optional<double> issued_s;  ///< by the grids' own words, of the oldest
};

Expected<ocean::GriddedField, InputProblem> open_grid(const InputFile& input, ocean::GriddedOptions options,
                                                      bool has_coast, world::Files& files, Waters& waters) {
  auto mapping = files.map(input.path);
  if (!mapping) return problem(input.path, mapping.error().message());
  waters.bytes.push_back(*std::move(mapping));
  const auto bytes = waters.bytes.back()->bytes();
  if (grid_identity(as_text(bytes)) != input.hash) return problem(input.path, "is not the grid that was planned on");
  const auto view = ocean::open_grid(bytes);
  if (!view) return problem(input.path, view.error().message());
  if (!has_coast) options.mask_is_land = true;
  if (const auto issued = ocean::issued_s(view->axes, view->facts, options.outside_time))
    waters.issued_s = std::min(*issued, waters.issued_s.value_or(*issued));
  return ocean::GriddedField{*view, options};
}

Expected<Done, InputProblem> open_sources(const VerifyRequest& request, world::Files& files, Waters& waters) {
  if (!(request.seams.blend.si() > 0 && request.seams.join.count() > 0))
    return problem("request", "the seams between its sources have no width");
  std::vector<ocean::CompositeSource> sources;
  for (const auto& source : request.sources) {
    if (!source.region.empty() && source.region.size() < 3)
      return problem("source '" + source.name + "'", "has a region of fewer than three corners");
    if (!(source.from_s <= source.to_s)) return problem("source '" + source.name + "'", "ends before it begins");
    auto field = open_grid(source.grid, source.options, request.coast.has_value(), files, waters);
    if (!field) return unexpected(field.error());
    sources.push_back(
        {source.name, std::move(field).value(), ocean::SourceRegion{source.region}, source.from_s, source.to_s});
  }
  waters.composite.emplace(std::move(sources), request.seams);
  return Done{};
}

Expected<Done, InputProblem> open_waters(const VerifyRequest& request, world::Files& files, Waters& waters) {
  if (request.grid) {
    auto field = open_grid(*request.grid, request.grid_options, request.coast.has_value(), files, waters);
    if (!field) return unexpected(field.error());
    waters.grids.push_back(std::move(field).value());
  }
  if (!request.sources.empty()) {
    auto opened = open_sources(request, files, waters);
    if (!opened) return opened;
  }
  for (const auto& spec : request.analytic) {
    const auto field = ocean::AnalyticField::make(spec, request.analytic_start, request.analytic_box);
    if (!field) return problem("analytic currents", field.error().message());
    waters.formulas.push_back(*field);
  }
  // Views only now: the vectors above no longer grow.
  for (const auto& grid : waters.grids) waters.parts.emplace_back(grid);
  if (waters.composite) waters.parts.emplace_back(*waters.composite);
  for (const auto& formula : waters.formulas) waters.parts.emplace_back(formula);
  if (waters.parts.empty()) return problem("request", "names neither a grid nor analytic currents");
  return Done{};
}

Expected<chart::ChartSources, InputProblem> open_chart(const VerifyRequest& request, world::Files& files) {
  chart::ChartSources sources;
  sources.keep_in = request.keep_in;
  sources.keep_out = request.keep_out;
  for (const auto* areas : {&sources.keep_in, &sources.keep_out})
    for (const auto& area : *areas)
      if (area.vertices.size() < 3) return problem("area '" + area.name + "'", "has fewer than three corners");
  if (request.bathymetry) {
    const auto mapping = files.map(request.bathymetry->path);
    if (!mapping) return problem(request.bathymetry->path, mapping.error().message());
    const auto bytes = (*mapping)->bytes();
    if (Sha256::of(bytes) != request.bathymetry->hash)
      return problem(request.bathymetry->path, "is not the bathymetry that was planned on");
    auto bottom = chart::Bathymetry::parse(as_text(bytes));
    if (!bottom) return problem(request.bathymetry->path, bottom.error());
    sources.bathymetry = std::move(bottom).value();
    sources.least_depth = request.least_depth;
  }
  if (!request.coast) return sources;
  const auto mapping = files.map(request.coast->path);
  if (!mapping) return problem(request.coast->path, mapping.error().message());
  const auto bytes = (*mapping)->bytes();
  if (Sha256::of(bytes) != request.coast->hash)
    return problem(request.coast->path, "is not the coast file that was planned on");
  const auto coast = chart::Coast::parse(as_text(bytes));
  if (!coast) return problem(request.coast->path, coast.error().message());
  sources.coast = *coast;
  return sources;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

Expected<safety::Verdict, InputProblem> judge_request(const VerifyRequest& request, world::Files& files) {
  Waters waters;
  const auto opened = open_waters(request, files, waters);
  if (!opened) return unexpected(opened.error());
  const auto sources = open_chart(request, files);
  if (!sources) return unexpected(sources.error());
  const chart::Chart chart{*sources};
  if (waters.parts.size() == 1) return safety::judge(request.dossier, waters.parts.front(), chart, waters.issued_s);
  const ocean::FieldSum sum{waters.parts};
  return safety::judge(request.dossier, sum, chart, waters.issued_s);
}

std::string explain(const safety::Verdict& verdict) {
  std::string text =
      (verdict.accepted ? "accepted: " : "REFUSED: ") + verdict.file_name + ", sha256 " + verdict.of.hex() + "\n";
  for (const bool holding : {false, true})
    for (const auto& m : verdict.margins) {
      if (m.holds != holding) continue;
      text += (holding ? "  holds   " : "  BROKEN  ") + m.rule + ": " + m.message;
      if (!std::isnan(m.found))
        text += " [found " + number(m.found) + (std::isnan(m.limit) ? "" : ", limit " + number(m.limit)) + " " +
                m.unit + "]";
      text += "\n";
    }
  return text;
}

}  // namespace glidehelm::verify
