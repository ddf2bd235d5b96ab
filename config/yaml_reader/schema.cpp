#include "config/yaml_reader/schema.hpp"

#include <cmath>

namespace glidehelm::config {

namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

/// Lines of a JSON object, members in the order they are added.
class Object {
 public:
  explicit Object(int depth) : depth_{depth} {}
  void add(std::string_view key, const std::string& json) {
    text_ += (text_.empty() ? "" : ",") + ("\n" + std::string(static_cast<std::size_t>(depth_ + 1) * 2, ' ')) +
             quoted(key) + ": " + json;
  }
  [[nodiscard]] std::string text() const {
    return text_.empty() ? "{}" : "{" + text_ + "\n" + std::string(static_cast<std::size_t>(depth_) * 2, ' ') + "}";
  }

 private:
  int depth_;
  std::string text_;
};

std::string strings(const std::vector<std::string>& words) {
  std::string result = "[";
  for (const auto& word : words) result += (result.size() == 1 ? "" : ", ") + quoted(word);
  return result + "]";
}

std::string json_of_default(const std::string& yaml) {
  const bool literal =
      yaml == "true" || yaml == "false" || yaml == "[]" || yaml.front() == '"' || looks_like_number(yaml);
  return literal ? yaml : quoted(yaml);
}

void describe(const Shape& shape, bool may_be_empty, int depth, Object& out);

std::string object_of(const Shape& shape, int depth) {
  Object out{depth};
  describe(shape, false, depth, out);
  return out.text();
}

void describe_keys(const Shape& shape, int depth, Object& out) {
  out.add("additionalProperties", "false");
  std::vector<std::string> required;
  Object properties{depth + 1};
  for (const auto& spec : shape.keys) {
    if (spec.required) required.push_back(spec.key);
    Object property{depth + 2};
    property.add("description", quoted(spec.meaning));
    describe(spec.shape, !spec.absent.empty(), depth + 2, property);
    if (!spec.default_text.empty()) property.add("default", json_of_default(spec.default_text));
    properties.add(spec.key, property.text());
  }
  if (!required.empty()) out.add("required", strings(required));
  out.add("properties", properties.text());
}

void describe_range(const Range& range, Object& out) {
  if (std::isfinite(range.low)) out.add(range.low_open ? "exclusiveMinimum" : "minimum", yaml_number(range.low));
  if (std::isfinite(range.high)) out.add("maximum", yaml_number(range.high));
}

void describe(const Shape& shape, bool may_be_empty, int depth, Object& out) {
  const auto type = [&](const char* name) {
    out.add("type", may_be_empty ? "[" + quoted(name) + ", \"null\"]" : quoted(name));
  };
  switch (shape.kind) {
    case Shape::Kind::number:
      type("number");
      describe_range(shape.range, out);
      break;
    case Shape::Kind::whole:
      type("integer");
      describe_range(shape.range, out);
      break;
    case Shape::Kind::flag:
      type("boolean");
      break;
    case Shape::Kind::text:
      type("string");
      if (shape.pattern == &kAnyText) {
        out.add("minLength", "1");
        out.add("maxLength", "4096");
      } else {
        out.add("pattern", quoted(shape.pattern->regex));
      }
      break;
    case Shape::Kind::word:
      out.add("enum", strings(shape.words));
      break;
    case Shape::Kind::time:
      type("string");
      out.add("pattern", quoted("^[0-9]{4}-[0-9]{2}-[0-9]{2}([T ][0-9]{2}:[0-9]{2}(:[0-9]{2}(\\.[0-9]+)?)?Z?)?$"));
      break;
    case Shape::Kind::list:
      type("array");
      if (shape.at_least > 0) out.add("minItems", std::to_string(shape.at_least));
      if (shape.at_most < std::numeric_limits<int>::max()) out.add("maxItems", std::to_string(shape.at_most));
      out.add("items", object_of(shape.parts.front(), depth + 1));
      break;
    case Shape::Kind::map:
      type("object");
      describe_keys(shape, depth, out);
      break;
    case Shape::Kind::any_of: {
      std::string alternatives;
      for (const auto& part : shape.parts)
        alternatives += (alternatives.empty() ? "" : ", ") + object_of(part, depth + 1);
      if (may_be_empty) alternatives += ", {\"type\": \"null\"}";
      out.add("anyOf", "[" + alternatives + "]");
      break;
    }
  }
}

std::string allowed_words(const Shape& shape, const std::string& key) {
  switch (shape.kind) {
    case Shape::Kind::number:
      return shape.range.text().empty() ? "a number" : shape.range.text();
    case Shape::Kind::whole:
      return "whole, " + shape.range.text();
    case Shape::Kind::flag:
      return "`true`, `false`";
    case Shape::Kind::text:
      return shape.pattern->words;
    case Shape::Kind::time:
      return "UTC, as `2026-11-25T10:20:30Z`";
    case Shape::Kind::map:
      return "keys below";
    case Shape::Kind::list: {
      const auto item = shape.parts.front().kind == Shape::Kind::map ? std::string{"maps with the keys below"}
                                                                     : allowed_words(shape.parts.front(), key);
      const bool fixed = shape.at_least > 0 && shape.at_least == shape.at_most;
      return std::string{"list of "} +
             (fixed                ? std::to_string(shape.at_least) + ": "
              : shape.at_least > 0 ? "at least " + std::to_string(shape.at_least) + ": "
                                   : "") +
             item;
    }
    case Shape::Kind::word:
    case Shape::Kind::any_of:
      break;
  }
  std::string result;
  for (const auto& word : shape.words) result += (result.empty() ? "`" : ", `") + word + "`";
  for (const auto& part : shape.parts) result += (result.empty() ? "" : "; or ") + allowed_words(part, key);
  return result;
}

/// The map whose keys are listed below a row, if the shape has one.
const Shape* map_within(const Shape& shape) {
  if (shape.kind == Shape::Kind::map) return &shape;
  for (const auto& part : shape.parts)
    if (const auto* found = map_within(part)) return found;
  return nullptr;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string{"\\|"} : std::string{c};
  return result;
}

void add_rows(const Shape& map, const std::string& prefix, std::string& out) {
  for (const auto& spec : map.keys) {
    const auto path = prefix + spec.key;
    std::string standard = spec.required               ? "**required**"
                           : spec.default_text.empty() ? spec.absent
                                                       : "`" + spec.default_text + "`";
    if (standard.empty()) standard = "–";
    const auto unit = unit_of(spec.key);
    out += "| `" + path + "` | " + escaped(spec.meaning) + " | " + (unit.empty() ? "–" : unit) + " | " +
           allowed_words(spec.shape, spec.key) + " | " + standard + " |\n";
    if (const auto* inner = map_within(spec.shape))
      add_rows(*inner, path + (spec.shape.kind == Shape::Kind::list ? "[]." : "."), out);
  }
}

}  // namespace

std::string json_schema(const Shape& root, const std::string& id, const std::string& title) {
  Object out{0};
  out.add("$schema", quoted("https://json-schema.org/draft/2020-12/schema"));
  out.add("$id", quoted(id));
  out.add("title", quoted(title));
  describe(root, false, 0, out);
  return out.text() + "\n";
}

std::string key_table(const Shape& root) {
  std::string out = "| key | meaning | unit | allowed | default |\n|---|---|---|---|---|\n";
  add_rows(root, "", out);
  return out;
}

}  // namespace glidehelm::config
