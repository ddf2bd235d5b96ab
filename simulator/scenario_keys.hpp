#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/yaml_reader/fields.hpp"

/// What the declarations of a scenario's keys have in common: ranges, units, and maps that stand in several places.
namespace glidehelm::simulator::keys {

using config::At;
using config::Effective;
using config::Fields;
using config::Range;
using config::Shape;

inline Range between(double low, double high) { return {low, high, false}; }
inline Range above_zero(double high) { return {0, high, true}; }

inline constexpr double kPerMinute = 60, kPerHour = 3600, kPercent = 0.01, kCubicCentimetre = 1e-6;

/// Keys that are on or off, by a word for each.
inline std::vector<std::pair<std::string, bool>> no_or_yes(std::string no, std::string yes) {
  return {{std::move(no), false}, {std::move(yes), true}};
}

/// A position, for any draft with the two coordinates.
template <class T>
Fields<T> place_fields() {
  Fields<T> f;
  f.latitude({"lat_deg", "latitude, north positive", true}, &T::lat_deg);
  f.longitude({"lon_deg", "longitude, east positive", true}, &T::lon_deg);
  return f;
}

/// A box of degrees, for any draft with the four edges.
template <class T>
Fields<T> area_fields() {
  Fields<T> f;
  f.maybe_number({"west_deg", "western edge", true}, &T::west_deg, 1, between(-180, 360));
  f.maybe_number({"east_deg", "eastern edge, greater than the western", true}, &T::east_deg, 1, between(-180, 540));
  f.maybe_number({"south_deg", "southern edge", true}, &T::south_deg, 1, between(-85, 85));
  f.maybe_number({"north_deg", "northern edge", true}, &T::north_deg, 1, between(-85, 85));
  return f;
}

/// A list of up to `most` items of one kind: `item` is the shape of one, `read` makes one, `text` prints it.
template <class T, class V, class Owner, class ReadItem, class TextOf>
void list_of(Fields<T>& f, const config::Key& key, std::vector<V> Owner::*member, int most, Shape item, ReadItem read,
             TextOf text) {
  Shape list;
  list.kind = Shape::Kind::list;
  list.parts.push_back(std::move(item));
  f.custom(
      key, list, "[]",
      [member, most, read](const At& at, T& target) {
        if (!config::expect_list(at, 0, most)) return;
        for (std::size_t i = 0; i < at.node.items.size(); ++i)
          if (auto value = read(at.item(i))) (target.*member).push_back(static_cast<V>(std::move(*value)));
      },
      [member, text, name = key.name](const T& t, const std::string& path, Effective& out) {
        std::vector<std::string> texts;
        for (const auto& value : t.*member) texts.push_back(text(value));
        out.leaf(path, name, config::yaml_list(texts));
      });
}

template <class T, class Owner>
void numbers(Fields<T>& f, const config::Key& key, std::vector<double> Owner::*member, int most, Range range) {
  list_of(
      f, key, member, most, Fields<T>::number_shape(range),
      [range](const At& at) { return config::read_number(at, range); },
      [](double value) { return config::yaml_number(value); });
}

template <class T, class Owner>
void wholes(Fields<T>& f, const config::Key& key, std::vector<int> Owner::*member, int most, Range range) {
  list_of(
      f, key, member, most, Fields<T>::whole_shape(range),
      [range](const At& at) { return config::read_whole(at, range); }, [](int value) { return std::to_string(value); });
}

}  // namespace glidehelm::simulator::keys
