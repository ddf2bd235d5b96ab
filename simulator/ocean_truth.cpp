#include "simulator/ocean_truth.hpp"

#include <optional>
#include <vector>

#include "core/ocean/gridded.hpp"

namespace glidehelm::simulator {

struct OceanTruth::Parts {
  std::optional<ocean::GriddedField> grid, grid_surface;
  std::vector<ocean::AnalyticField> analytic;
  std::optional<ocean::FieldSum> sum;
  std::optional<CoastalField> coastal, coastal_model;
  std::optional<PerturbedField> dive, surface;
};

OceanTruth::OceanTruth(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}
OceanTruth::~OceanTruth() = default;
OceanTruth::OceanTruth(OceanTruth&&) noexcept = default;
OceanTruth& OceanTruth::operator=(OceanTruth&&) noexcept = default;

Expected<OceanTruth, TruthError> OceanTruth::make(const TruthPlan& plan, Instant start, bool with_coast,
                                                  world::Files& files) {
  auto parts = std::make_unique<Parts>();
  if (!plan.grid.empty()) {
    auto mapping = files.map(plan.grid);
    if (!mapping) return unexpected(TruthError{"truth.grid: " + mapping.error().message()});
    std::shared_ptr<world::Mapping> bytes = std::move(*mapping);
    const auto view = ocean::open_grid(bytes->bytes());
    if (!view) return unexpected(TruthError{"truth.grid: " + plan.grid + ": " + view.error().message()});
    ocean::GriddedOptions options;
    options.outside_time = ocean::OutsideTime::forbid;
    options.mask_is_land = !with_coast;
    parts->grid.emplace(*view, options, bytes);
    parts->grid_surface.emplace(parts->grid->shallowest());
  } else if (plan.coastal) {
    parts->coastal.emplace(plan.coastal->spec, plan.coastal->variant);
    parts->coastal_model.emplace(plan.coastal->spec, Variant::forecast);
  } else {
    auto specs = plan.analytic;
    if (plan.still) specs = {ocean::AnalyticSpec{"constant", {}, Metres{1}, MetresPerSecond{1}, {}, {}, false, {}, {}}};
    for (const auto& spec : specs) {
      auto field = ocean::AnalyticField::make(spec, start);
      if (!field) return unexpected(TruthError{"truth.analytic: " + field.error().message()});
      parts->analytic.push_back(std::move(*field));
    }
    std::vector<ocean::FieldRef> refs;
    for (const auto& field : parts->analytic) refs.emplace_back(field);
    parts->sum.emplace(std::move(refs));
  }
  OceanTruth truth{std::move(parts)};
  if (plan.error) {
    const auto exact = truth.exact();
    truth.parts_->dive.emplace(exact.dive, *plan.error, epoch_seconds(start));
    truth.parts_->surface.emplace(exact.surface, *plan.error, epoch_seconds(start));
  }
  return truth;
}

ocean::Ocean OceanTruth::ocean() const {
  if (parts_->dive) return {*parts_->dive, *parts_->surface};
  return exact();
}

ocean::FieldRef OceanTruth::model() const {
  if (parts_->coastal_model) return *parts_->coastal_model;
  return exact().dive;
}

ocean::Ocean OceanTruth::exact() const {
  if (parts_->grid) return {*parts_->grid, *parts_->grid_surface};
  if (parts_->coastal) return {*parts_->coastal, *parts_->coastal};
  return {*parts_->sum, *parts_->sum};
}

}  // namespace glidehelm::simulator
