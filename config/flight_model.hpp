#pragma once

#include <optional>
#include <string>

#include "config/yaml_reader/fields.hpp"
#include "core/vehicle/force_balance.hpp"

namespace glidehelm::config {

/// The keys of `vehicle.force_balance` (core/vehicle/force_balance.hpp).
const Fields<vehicle::FlightModel>& flight_model_fields();

/// Reads the section; what is wrong in it, alone or together, is complained about.
void read_flight_model(const At& at, std::optional<vehicle::FlightModel>& model);
void print_flight_model(const std::optional<vehicle::FlightModel>& model, const std::string& path, Effective& out);

}  // namespace glidehelm::config
