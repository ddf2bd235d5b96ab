#include "core/ocean/field.hpp"

namespace glidehelm::ocean {

std::string_view word(NoCurrent reason) {
  switch (reason) {
    case NoCurrent::land:
      return "land";
    case NoCurrent::no_data:
      return "no_data";
    case NoCurrent::below_bottom:
      return "below_bottom";
    case NoCurrent::outside_area:
      return "outside_area";
    case NoCurrent::outside_time:
      return "outside_time";
  }
  return "no_data";
}

}  // namespace glidehelm::ocean
