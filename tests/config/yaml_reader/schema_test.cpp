#include "config/yaml_reader/schema.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm::config;

namespace {

struct Item {
  std::string name;
};
struct Sample {
  int slot{10};
  std::optional<glidehelm::Metres> radius;
  std::vector<Item> items;
};

Shape sample_shape() {
  Range range;
  range.low = 0;
  range.high = 99;
  Range open;
  open.low = 0;
  open.low_open = true;
  Fields<Item> item;
  item.text({"name", "who | what", true}, &Item::name, kName);
  Fields<Sample> f;
  f.constant({"schema", "what this file is", true}, "x/v1");
  f.whole({"slot", "NN of the file"}, &Sample::slot, range);
  f.maybe_number({"radius_m", "how near", false, ""}, &Sample::radius, 1, open, "auto");
  f.list({"items", "the items", false, "none"}, &Sample::items, item, 1);
  return f.shape();
}

}  // namespace

TEST_CASE("a declaration becomes a JSON Schema with every key, type, range and default") {
  CHECK(json_schema(sample_shape(), "x/v1", "Sample") == R"({
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "$id": "x/v1",
  "title": "Sample",
  "type": "object",
  "additionalProperties": false,
  "required": ["schema"],
  "properties": {
    "schema": {
      "description": "what this file is",
      "enum": ["x/v1"]
    },
    "slot": {
      "description": "NN of the file",
      "type": "integer",
      "minimum": 0,
      "maximum": 99,
      "default": 10
    },
    "radius_m": {
      "description": "how near",
      "anyOf": [{
        "enum": ["auto"]
      }, {
        "type": "number",
        "exclusiveMinimum": 0
      }],
      "default": "auto"
    },
    "items": {
      "description": "the items",
      "type": ["array", "null"],
      "minItems": 1,
      "items": {
        "type": "object",
        "additionalProperties": false,
        "required": ["name"],
        "properties": {
          "name": {
            "description": "who | what",
            "type": "string",
            "pattern": "^[a-z0-9][a-z0-9_-]{0,31}$"
          }
        }
      }
    }
  }
}
)");
}

TEST_CASE("a declaration becomes a table with a row for every key") {
  CHECK(key_table(sample_shape()) ==
        "| key | meaning | unit | allowed | default |\n"
        "|---|---|---|---|---|\n"
        "| `schema` | what this file is | – | `x/v1` | **required** |\n"
        "| `slot` | NN of the file | – | whole, 0 to 99 | `10` |\n"
        "| `radius_m` | how near | m | `auto`; or above 0 | `auto` |\n"
        "| `items` | the items | – | list of at least 1: maps with the keys below | none |\n"
        "| `items[].name` | who \\| what | – | 1 to 32 of a–z, 0–9, _ and -, the first a letter or digit | "
        "**required** |\n");
}
