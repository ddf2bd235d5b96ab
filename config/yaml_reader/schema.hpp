#pragma once

#include <string>

#include "config/yaml_reader/fields.hpp"

namespace glidehelm::config {

/// The declaration as a JSON Schema (draft 2020-12), for editors that check while one types. It holds every key, type,
/// range and word; what concerns two keys at once is checked by `glidehelm check` only.
std::string json_schema(const Shape& root, const std::string& id, const std::string& title);

/// The declaration as a Markdown table: key, meaning, unit, what is allowed, default.
std::string key_table(const Shape& root);

}  // namespace glidehelm::config
