#include "config/flight_model.hpp"

#include <limits>

namespace glidehelm::config {

namespace {

using vehicle::FlightModel;
using vehicle::Hull;
using vehicle::Trim;
using vehicle::WaterLayer;

constexpr double kLitre = 1e-3, kCubicCentimetre = 1e-6;

Fields<Trim> trim_fields() {
  Fields<Trim> f;
  f.number({"pitch_down_deg", "how far the nose points down in a dive"}, &Trim::pitch_down, kDegree, from_to(1, 89));
  f.number({"pitch_up_deg", "how far it points up in a climb"}, &Trim::pitch_up, kDegree, from_to(1, 89));
  f.number({"pumped_down_cm3", "volume of the pump in a dive, from its middle"}, &Trim::pumped_down_m3,
           kCubicCentimetre, from_to(-2000, 0));
  f.number({"pumped_up_cm3", "volume of the pump in a climb, from its middle"}, &Trim::pumped_up_m3, kCubicCentimetre,
           from_to(0, 2000));
  return f;
}

Fields<Hull> hull_fields() {
  Fields<Hull> f;
  f.number({"volume_l", "volume of the glider at the surface, pump in its middle"}, &Hull::volume_m3, kLitre,
           from_to(1, 1000));
  f.maybe_number({"mass_kg", "mass of the glider", false, "neutral at `neutral_at_m`"}, &Hull::mass_kg, 1,
                 from_to(1, 1000));
  f.number({"neutral_at_m", "depth at which it floats with the pump in its middle; not together with `mass_kg`"},
           &Hull::neutral_at, 1, from_to(0, 6000));
  f.number({"compressibility_per_gpa", "share of the volume lost for each GPa of pressure"},
           &Hull::compressibility_per_pa, 1e-9, from_to(0, 5));
  f.number({"expansion_per_c", "share of the volume won for each degree"}, &Hull::expansion_per_c, 1, from_to(0, 1e-3));
  f.number({"reference_c", "temperature at which the volume is given"}, &Hull::reference_c, 1, from_to(-5, 40));
  f.number({"area_m2", "area that the three coefficients are of"}, &Hull::area_m2, 1, from_to(0.001, 10));
  f.number({"drag", "coefficient of the parasite drag"}, &Hull::drag, 1, from_to(0.001, 2));
  f.number({"induced_drag_per_rad2", "coefficient of the induced drag"}, &Hull::induced_drag_per_rad2, 1,
           from_to(0, 100));
  f.number({"lift_per_rad", "lift slope of hull and wings"}, &Hull::lift_per_rad, 1, from_to(0.01, 100));
  return f;
}

Fields<WaterLayer> layer_fields() {
  Fields<WaterLayer> f;
  f.number({"depth_m", "depth", true}, &WaterLayer::depth, 1, from_to(0, 11'000));
  f.number({"temperature_c", "temperature in situ", true}, &WaterLayer::temperature_c, 1, from_to(-2, 40));
  f.number({"salinity", "practical salinity"}, &WaterLayer::salinity, 1, from_to(0, 42));
  return f;
}

constexpr const char* kNoWater =
    "that of the forecast, else a middle-latitude ocean: 16 °C at the surface, 4 °C in the deep, salinity 35";

void read_water(const At& at, FlightModel& model) {
  if (!expect_list(at, 1, std::numeric_limits<int>::max())) return;
  for (std::size_t i = 0; i < at.node.items.size(); ++i) {
    const auto layer_at = at.item(i);
    WaterLayer layer;
    if (expect_map(layer_at)) layer_fields().read(layer_at, layer);
    if (!model.water.empty() && layer.depth <= model.water.back().depth)
      layer_at.complain("a layer that is not deeper than the one before it", yaml_number(layer.depth.si()),
                        "depths that grow");
    model.water.push_back(layer);
  }
}

void print_water(const FlightModel& model, const std::string& path, Effective& out) {
  if (model.water.empty()) return out.leaf(path, "water", "", kNoWater);
  out.open("water");
  for (std::size_t i = 0; i < model.water.size(); ++i) {
    out.open_item();
    layer_fields().print(model.water[i], path + "[" + std::to_string(i) + "]", out);
    out.close();
  }
  out.close();
}

}  // namespace

const Fields<FlightModel>& flight_model_fields() {
  static const Fields<FlightModel> kFields = [] {
    Fields<FlightModel> f;
    f.include(&FlightModel::trim, trim_fields());
    f.include(&FlightModel::hull, hull_fields());
    Shape layers;
    layers.kind = Shape::Kind::list;
    layers.at_least = 1;
    layers.parts.push_back(layer_fields().shape());
    f.custom({"water", "temperature and salinity by depth, from the top; linear between", false, kNoWater}, layers, "",
             read_water, print_water);
    return f;
  }();
  return kFields;
}

void read_flight_model(const At& at, std::optional<FlightModel>& model) {
  if (!expect_map(at)) return;
  model.emplace();
  flight_model_fields().read(at, *model);
  if (model->hull.mass_kg && at.reading.places.count(at.path + ".neutral_at_m") > 0)
    at.reading.complain(at.path + ".neutral_at_m", "both neutral_at_m and mass_kg", {}, "one of the two");
}

void print_flight_model(const std::optional<FlightModel>& model, const std::string& path, Effective& out) {
  if (!model) return out.leaf(path, "force_balance", "", "none");
  out.open("force_balance");
  flight_model_fields().print(*model, path + ".force_balance", out);
  out.close();
}

}  // namespace glidehelm::config
