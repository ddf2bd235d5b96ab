#pragma once

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

namespace glidehelm::test {

/// The part of JSON Schema (draft 2020-12) that our schemas use, written from the specification and apart from our
/// reader. A keyword that it does not know is an error too, so that no schema passes unread.
class JsonSchemaCheck {
 public:
  using Json = nlohmann::json;
  std::vector<std::string> errors;

  void check(const Json& schema, const Json& value, const std::string& where = "$") {
    for (const auto& [keyword, rule] : schema.items()) {
      if (keyword == "$schema" || keyword == "$id" || keyword == "title" || keyword == "description" ||
          keyword == "default")
        continue;
      if (!holds(keyword, rule, schema, value, where)) errors.push_back(where + ": " + keyword + " " + rule.dump());
    }
  }

 private:
  static bool is_type(const std::string& type, const Json& value) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "integer")
      return value.is_number_integer() ||
             (value.is_number() && value.get<double>() == static_cast<double>(value.get<long long>()));
    return type == "number" && value.is_number();
  }

  bool holds(const std::string& keyword, const Json& rule, const Json& schema, const Json& value,
             const std::string& where) {
    if (keyword == "type") {
      if (rule.is_string()) return is_type(rule, value);
      for (const auto& type : rule)
        if (is_type(type, value)) return true;
      return false;
    }
    if (keyword == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (keyword == "anyOf") {
      for (const auto& part : rule) {
        JsonSchemaCheck alternative;
        alternative.check(part, value, where);
        if (alternative.errors.empty()) return true;
      }
      return false;
    }
    if (keyword == "minimum") return !value.is_number() || value.get<double>() >= rule.get<double>();
    if (keyword == "exclusiveMinimum") return !value.is_number() || value.get<double>() > rule.get<double>();
    if (keyword == "maximum") return !value.is_number() || value.get<double>() <= rule.get<double>();
    if (keyword == "minLength")
      return !value.is_string() || value.get_ref<const std::string&>().size() >= rule.get<std::size_t>();
    if (keyword == "maxLength")
      return !value.is_string() || value.get_ref<const std::string&>().size() <= rule.get<std::size_t>();
    if (keyword == "pattern")
      return !value.is_string() || std::regex_search(value.get<std::string>(), std::regex{rule.get<std::string>()});
    if (keyword == "minItems") return !value.is_array() || value.size() >= rule.get<std::size_t>();
    if (keyword == "maxItems") return !value.is_array() || value.size() <= rule.get<std::size_t>();
    if (keyword == "items") {
      if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) check(rule, value[i], where + "[" + std::to_string(i) + "]");
      return true;
    }
    if (keyword == "required") {
      for (const auto& key : rule)
        if (value.is_object() && !value.contains(key.get<std::string>())) return false;
      return true;
    }
    if (keyword == "properties") {
      for (const auto& [key, inner] : rule.items())
        if (value.is_object() && value.contains(key)) check(inner, value[key], where + "." + key);
      return true;
    }
    if (keyword == "additionalProperties") {
      if (rule != false || !value.is_object()) return rule == false;
      for (const auto& [key, inner] : value.items())
        if (!schema.at("properties").contains(key)) return false;
      return true;
    }
    return false;
  }
};

}  // namespace glidehelm::test
