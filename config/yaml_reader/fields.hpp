#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/yaml_reader/values.hpp"
#include "core/base/units.hpp"

/// Declarations of keys. A key is declared once, with its target in a struct, unit, range, meaning and default; the same
/// declaration reads it, finds misspelt keys, prints the value in force with its origin, and makes the JSON Schema and
/// the key table of docs/configuration.md.
namespace glidehelm::config {

struct KeySpec;

/// What may stand as a value: enough for a message, a JSON Schema and a table.
struct Shape {
  enum class Kind { number, whole, flag, text, word, time, list, map, any_of };
  Kind kind{Kind::text};
  Range range;                                               ///< number, whole
  std::vector<std::string> words;                            ///< word
  const Pattern* pattern{&kAnyText};                         ///< text
  std::vector<Shape> parts;                                  ///< list: the item; any_of: the alternatives
  std::vector<KeySpec> keys;                                 ///< map
  int at_least{}, at_most{std::numeric_limits<int>::max()};  ///< list
};

/// One key as people and schemas see it.
struct KeySpec {
  std::string key;
  std::string meaning;  ///< one sentence, without a full stop
  Shape shape;
  bool required{};
  std::string default_text;  ///< YAML of the default; empty: none
  std::string absent;        ///< what holds when the key is left out and has no default; such a key may be empty
};

/// The values in force, as YAML with the origin of each: text that reads back to the same values.
class Effective {
 public:
  explicit Effective(const Reading* reading) : reading_{reading} {}
  /// `absent` says what holds when `yaml` is empty.
  void leaf(const std::string& path, const std::string& key, const std::string& yaml, const std::string& absent = {});
  void open(const std::string& key);
  void open_item();
  void close() { --depth_; }
  /// True when the file sets the key of this path.
  [[nodiscard]] bool is_set(const std::string& path) const {
    return reading_ != nullptr && reading_->places.count(path) > 0;
  }
  [[nodiscard]] std::string text() const;

 private:
  struct Line {
    std::string text, origin;
  };
  std::string indent();
  const Reading* reading_;
  std::vector<Line> lines_;
  int depth_{};
  bool dash_{};
};

/// The keys of one map, bound to a struct behind a pointer. `Fields` is its typed face.
class Keys {
 public:
  using Read = std::function<void(const At&, void*)>;
  using Print = std::function<void(const void*, const std::string& path, Effective&)>;
  struct Entry {
    KeySpec spec;
    Read read;
    Print print;
  };
  void add(Entry entry) { entries_.push_back(std::move(entry)); }
  /// Reads a map into `target`: every key that is right is set, every other one reported.
  void read(const At& at, void* target) const;
  void print(const void* target, const std::string& path, Effective& out) const;
  [[nodiscard]] std::vector<KeySpec> specs() const;
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

/// Name, meaning and the rest of a declaration that is prose.
struct Key {
  std::string name;
  std::string meaning;
  bool required{};
  std::string absent{};  ///< see KeySpec
};

template <class Tag>
double in_unit(Quantity<Tag> value) {
  return value.si();
}
inline double in_unit(Seconds value) { return value.count(); }
inline double in_unit(double value) { return value; }
inline double in_unit(int value) { return value; }
inline double in_unit(std::uint64_t value) { return static_cast<double>(value); }

/// Typed declarations of the keys of a map that fills a T. `member` below is a pointer to a member of T or of a base.
/// Defaults are those of a T{}: they stand in the struct and nowhere else.
template <class T>
class Fields {
 public:
  /// A quantity, `unit` SI units to one of the key's.
  template <class Member>
  Fields& number(Key key, Member member, double unit, Range range) {
    return put(
        key, number_shape(range), key.required ? "" : yaml_number(in_unit(T{}.*member), unit),
        [member, unit, range](const At& at, T& target) {
          using V = std::decay_t<decltype(target.*member)>;
          if (const auto value = read_number(at, range)) target.*member = V{*value * unit};
        },
        [member, unit](const T& t) { return yaml_number(in_unit(t.*member), unit); });
  }

  /// An optional quantity: none when the key is left out or empty, or when it says `word` (if that is not empty).
  template <class Member>
  Fields& maybe_number(Key key, Member member, double unit, Range range, std::string word = {}) {
    Shape shape = number_shape(range);
    if (!word.empty()) shape = any_of({word_shape({word}), shape});
    return put(
        key, shape, word,
        [member, unit, range, word](const At& at, T& target) {
          using V = typename std::decay_t<decltype(target.*member)>::value_type;
          if (!word.empty() && at.node.is(Node::Kind::scalar) && !looks_like_number(at.node.text)) {
            if (read_word(at, {word, "a number"})) target.*member = std::nullopt;
          } else if (const auto value = read_number(at, range)) {
            target.*member = V{*value * unit};
          }
        },
        [member, unit, word](const T& t) { return t.*member ? yaml_number(in_unit(*(t.*member)), unit) : word; });
  }

  template <class Member>
  Fields& latitude(Key key, Member member) {
    return coordinate(key, member, 90, read_latitude);
  }
  template <class Member>
  Fields& longitude(Key key, Member member) {
    return coordinate(key, member, 360, read_longitude);
  }

  template <class Member>
  Fields& whole(Key key, Member member, Range range) {
    return put(
        key, whole_shape(range), key.required ? "" : yaml_number(in_unit(T{}.*member)),
        [member, range](const At& at, T& target) {
          using V = std::decay_t<decltype(target.*member)>;
          if (const auto value = read_whole(at, range)) target.*member = static_cast<V>(*value);
        },
        [member](const T& t) { return yaml_number(in_unit(t.*member)); });
  }

  template <class Member>
  Fields& maybe_whole(Key key, Member member, Range range) {
    return put(
        key, whole_shape(range), "",
        [member, range](const At& at, T& target) {
          using V = typename std::decay_t<decltype(target.*member)>::value_type;
          if (const auto value = read_whole(at, range)) target.*member = static_cast<V>(*value);
        },
        [member](const T& t) { return t.*member ? yaml_number(in_unit(*(t.*member))) : std::string{}; });
  }

  template <class Member>
  Fields& flag(Key key, Member member) {
    Shape shape;
    shape.kind = Shape::Kind::flag;
    return put(
        key, shape, T{}.*member ? "true" : "false",
        [member](const At& at, T& target) {
          if (const auto value = read_flag(at)) target.*member = *value;
        },
        [member](const T& t) { return std::string{t.*member ? "true" : "false"}; });
  }

  /// A text; empty in the struct means that the key is left out.
  template <class Member>
  Fields& text(Key key, Member member, const Pattern& pattern = kAnyText) {
    Shape shape;
    shape.pattern = &pattern;
    const std::string standard = T{}.*member;
    return put(
        key, shape, standard.empty() ? "" : yaml_text(standard),
        [member, &pattern](const At& at, T& target) {
          if (auto value = read_text(at, pattern)) target.*member = std::move(*value);
        },
        [member](const T& t) { return (t.*member).empty() ? std::string{} : yaml_text(t.*member); });
  }

  template <class Member>
  Fields& texts(Key key, Member member, int at_least) {
    Shape shape;
    shape.kind = Shape::Kind::list;
    shape.at_least = at_least;
    shape.parts.push_back(Shape{});
    return put(
        key, shape, key.required || at_least > 0 ? "" : "[]",
        [member, at_least](const At& at, T& target) {
          if (!expect_list(at, at_least, std::numeric_limits<int>::max())) return;
          (target.*member).clear();
          for (std::size_t i = 0; i < at.node.items.size(); ++i)
            if (auto value = read_text(at.item(i), kAnyText)) (target.*member).push_back(std::move(*value));
        },
        [member, at_least](const T& t) {
          return (t.*member).empty() && at_least > 0 ? std::string{} : yaml_list(t.*member);
        });
  }

  /// One of several words, each with the value that it stands for.
  template <class Member, class V>
  Fields& word(Key key, Member member, std::vector<std::pair<std::string, V>> table,
               std::vector<std::string> later = {}) {
    std::vector<std::string> words;
    for (const auto& row : table) words.push_back(row.first);
    const auto print = [member, table](const T& t) {
      for (const auto& row : table)
        if (t.*member == row.second) return row.first;
      return std::string{};
    };
    return put(
        key, word_shape(words), key.required ? "" : print(T{}),
        [member, table, words, later](const At& at, T& target) {
          if (const auto i = read_word(at, words, later)) target.*member = table[*i].second;
        },
        print);
  }

  /// A key that says only what the file is: `schema: glidehelm/mission/v1`.
  Fields& constant(Key key, const std::string& value) {
    return put(
        key, word_shape({value}), "", [value](const At& at, T&) { (void)read_word(at, {value}); },
        [value](const T&) { return value; });
  }

  template <class Member>
  Fields& time(Key key, Member member) {
    Shape shape;
    shape.kind = Shape::Kind::time;
    return put(
        key, shape, "",
        [member](const At& at, T& target) {
          if (const auto value = read_time(at)) target.*member = *value;
        },
        [member](const T& t) { return t.*member ? yaml_time(*(t.*member)) : std::string{}; });
  }

  /// A map whose keys fill the same struct.
  Fields& section(const Key& key, const Fields<T>& inner) {
    return nest<T>(
        key, inner, [](const T& t) { return &t; }, [](T& t) { return &t; });
  }

  /// A map that fills a member.
  template <class U, class Owner>
  Fields& part(const Key& key, U Owner::*member, const Fields<U>& inner) {
    return nest<U>(
        key, inner, [member](const T& t) { return &(t.*member); }, [member](T& t) { return &(t.*member); });
  }

  /// The keys of a member, in the same map: for a map that fills several structs.
  template <class U, class Owner>
  Fields& include(U Owner::*member, const Fields<U>& inner) {
    for (const auto& entry : inner.keys_->entries())
      keys_->add(
          {entry.spec,
           [read = entry.read, member](const At& at, void* target) { read(at, &(static_cast<T*>(target)->*member)); },
           [print = entry.print, member](const void* t, const std::string& path, Effective& out) {
             print(&(static_cast<const T*>(t)->*member), path, out);
           }});
    return *this;
  }

  /// A list of maps.
  template <class U, class Owner>
  Fields& list(const Key& key, std::vector<U> Owner::*member, const Fields<U>& inner, int at_least) {
    Shape shape;
    shape.kind = Shape::Kind::list;
    shape.at_least = at_least;
    shape.parts.push_back(inner.shape());
    return custom(
        key, shape, "",
        [member, inner, at_least](const At& at, T& target) {
          if (!expect_list(at, at_least, std::numeric_limits<int>::max())) return;
          (target.*member).clear();
          for (std::size_t i = 0; i < at.node.items.size(); ++i) {
            const auto item = at.item(i);
            U value;
            if (expect_map(item)) inner.read(item, value);
            (target.*member).push_back(std::move(value));
          }
        },
        [member, inner, name = key.name](const T& t, const std::string& path, Effective& out) {
          out.open(name);
          for (std::size_t i = 0; i < (t.*member).size(); ++i) {
            out.open_item();
            inner.print((t.*member)[i], path + "[" + std::to_string(i) + "]", out);
            out.close();
          }
          out.close();
        });
  }

  /// Anything else: the reader and the printer are given.
  Fields& custom(const Key& key, Shape shape, std::string default_text, std::function<void(const At&, T&)> read,
                 std::function<void(const T&, const std::string& path, Effective&)> print) {
    KeySpec spec;
    spec.key = key.name;
    spec.meaning = key.meaning;
    spec.shape = std::move(shape);
    spec.required = key.required;
    spec.default_text = std::move(default_text);
    spec.absent = key.absent;
    keys_->add({std::move(spec), [read](const At& at, void* target) { read(at, *static_cast<T*>(target)); },
                [print](const void* t, const std::string& path, Effective& out) {
                  print(*static_cast<const T*>(t), path, out);
                }});
    return *this;
  }

  void read(const At& at, T& target) const { keys_->read(at, &target); }
  void print(const T& t, const std::string& path, Effective& out) const { keys_->print(&t, path, out); }
  [[nodiscard]] Shape shape() const {
    Shape result;
    result.kind = Shape::Kind::map;
    result.keys = keys_->specs();
    return result;
  }

  static Shape number_shape(Range range) {
    Shape shape;
    shape.kind = Shape::Kind::number;
    shape.range = range;
    return shape;
  }
  static Shape whole_shape(Range range) {
    Shape shape;
    shape.kind = Shape::Kind::whole;
    shape.range = range;
    return shape;
  }
  static Shape word_shape(std::vector<std::string> words) {
    Shape shape;
    shape.kind = Shape::Kind::word;
    shape.words = std::move(words);
    return shape;
  }
  static Shape any_of(std::vector<Shape> parts) {
    Shape shape;
    shape.kind = Shape::Kind::any_of;
    shape.parts = std::move(parts);
    return shape;
  }

 private:
  template <class U>
  friend class Fields;

  template <class Member>
  Fields& coordinate(const Key& key, Member member, double limit, std::optional<double> (*reader)(const At&)) {
    Range range;
    range.low = -limit;
    range.high = limit;
    return put(
        key, number_shape(range), "",
        [member, reader](const At& at, T& target) {
          if (const auto value = reader(at)) target.*member = *value;
        },
        [member](const T& t) { return t.*member ? yaml_number(*(t.*member)) : std::string{}; });
  }

  Fields& put(const Key& key, Shape shape, std::string default_text, std::function<void(const At&, T&)> read,
              std::function<std::string(const T&)> print) {
    return custom(key, std::move(shape), std::move(default_text), std::move(read),
                  [print, name = key.name, absent = key.absent](const T& t, const std::string& path, Effective& out) {
                    out.leaf(path, name, print(t), absent);
                  });
  }

  template <class U>
  Fields& nest(const Key& key, const Fields<U>& inner, std::function<const U*(const T&)> get,
               std::function<U*(T&)> change) {
    return custom(
        key, inner.shape(), "",
        [inner, change](const At& at, T& target) {
          if (expect_map(at)) inner.read(at, *change(target));
        },
        [inner, get, name = key.name](const T& t, const std::string& path, Effective& out) {
          out.open(name);
          inner.print(*get(t), path, out);
          out.close();
        });
  }

  std::shared_ptr<Keys> keys_ = std::make_shared<Keys>();
};

}  // namespace glidehelm::config
