#include "config/yaml_reader/fields.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/utc.hpp"
#include "tests/support/config.hpp"

using namespace glidehelm;
using namespace glidehelm::config;
using test::lines_of;
using Lines = std::vector<std::string>;

namespace {

enum class Colour { red, green };

struct Inner {
  std::string label;
  int count{1};
};

struct Thing {
  MetresPerSecond speed{0.3};
  Radians angle{degrees(26)};
  Seconds wait{900};
  std::optional<Metres> cell;
  std::optional<Radians> turn;
  std::optional<double> lat, lon;
  std::uint64_t seed{1};
  std::optional<int> halves;
  bool loud{};
  std::string name, note;
  std::vector<std::string> files;
  Colour colour{Colour::red};
  std::optional<Instant> at;
  Inner inner;
  std::vector<Inner> inners;
};

Fields<Thing> thing_fields() {
  Fields<Inner> inner;
  inner.text({"label", "a label", true}, &Inner::label).whole({"count", "how many"}, &Inner::count, from_to(0, 9));
  Fields<Thing> place;
  place.latitude({"lat_deg", "latitude", false, "none"}, &Thing::lat)
      .longitude({"lon_deg", "longitude", false, "none"}, &Thing::lon);
  Range speed = from_to(0, 2);
  speed.low_open = true;
  Fields<Thing> f;
  f.number({"speed_m_per_s", "speed"}, &Thing::speed, 1, speed);
  f.number({"angle_deg", "angle"}, &Thing::angle, kPi / 180, from_to(5, 60));
  f.number({"wait_min", "wait"}, &Thing::wait, 60, from_to(0, 60));
  f.maybe_number({"cell_km", "cell"}, &Thing::cell, 1000, from_to(0, 10), "auto");
  f.maybe_number({"turn_deg", "turn", false, "learned"}, &Thing::turn, kPi / 180, from_to(-180, 180));
  f.section({"place", "a place"}, place);
  f.whole({"seed", "seed"}, &Thing::seed, from_to(0, 9007199254740992.0));
  f.maybe_whole({"halves", "halves", false, "none"}, &Thing::halves, from_to(1, 10));
  f.flag({"loud", "loud"}, &Thing::loud);
  f.text({"name", "name", false, "none"}, &Thing::name, kName);
  f.text({"note", "note", false, "none"}, &Thing::note);
  f.texts({"files", "files"}, &Thing::files, 0);
  f.word({"colour", "colour"}, &Thing::colour,
         std::vector<std::pair<std::string, Colour>>{{"red", Colour::red}, {"green", Colour::green}}, {"blue"});
  f.time({"at", "a time", false, "now"}, &Thing::at);
  f.part({"inner", "inner"}, &Thing::inner, inner);
  f.list({"inners", "inners", false, "none"}, &Thing::inners, inner, 1);
  return f;
}

struct Result {
  Thing thing;
  Lines errors;
  std::string effective;
};

Result read(const std::string& yaml) {
  auto document = read_yaml(yaml, "t.yaml");
  Reading reading{"t.yaml"};
  for (auto& error : document.errors) reading.problems.add(std::move(error));
  Result result;
  const At root{document.root, nullptr, "", reading};
  if (document.readable && expect_map(root)) thing_fields().read(root, result.thing);
  result.errors = lines_of(reading.problems.sorted());
  Effective effective{&reading};
  thing_fields().print(result.thing, "", effective);
  result.effective = effective.text();
  return result;
}

Lines errors(const std::string& yaml) { return read(yaml).errors; }

}  // namespace

TEST_CASE("one declaration reads every kind of key into its unit") {
  const auto r = read(
      "speed_m_per_s: 0.25\nangle_deg: 30\nwait_min: 10\ncell_km: 2.5\nturn_deg: -90\nplace: {lat_deg: -29.5, lon_deg: "
      "359}\n"
      "seed: 9007199254740992\nhalves: 6\nloud: true\nname: a_b-1\nnote: 'yes'\nfiles: [a.nc, \"7\"]\ncolour: "
      "green\nat: 2026-11-25T10:20:30Z\n"
      "inner: {label: x}\ninners: [{label: u, count: 2}, {label: z}]\n");
  CHECK(r.errors.empty());
  CHECK(r.thing.speed == MetresPerSecond{0.25});
  CHECK(r.thing.angle == degrees(30));
  CHECK(r.thing.wait == Seconds{600});
  CHECK(r.thing.cell == Metres{2500});
  CHECK(r.thing.turn->si() == Approx(-kPi / 2));
  CHECK(r.thing.lat == -29.5);
  CHECK(r.thing.lon == 359.0);
  CHECK(r.thing.seed == 9007199254740992ULL);
  CHECK(r.thing.halves == 6);
  CHECK(r.thing.loud);
  CHECK(r.thing.name == "a_b-1");
  CHECK(r.thing.note == "yes");
  CHECK(r.thing.files == std::vector<std::string>{"a.nc", "7"});
  CHECK(r.thing.colour == Colour::green);
  CHECK(r.thing.at == utc_from_text("2026-11-25T10:20:30Z"));
  CHECK(r.thing.inner.label == "x");
  REQUIRE(r.thing.inners.size() == 2);
  CHECK(r.thing.inners[0].count == 2);
  CHECK(r.thing.inners[1].label == "z");
}

TEST_CASE("numbers are JSON numbers and nothing else") {
  struct Row {
    const char* value;
    const char* error;
  };
  const auto row = GENERATE(values<Row>({
      {"010",
       "1:16 speed_m_per_s: a number with a leading zero, which YAML may read as octal; found 010; allowed: above 0, "
       "up to 2 m/s, without the zero"},
      {"-01.5",
       "1:16 speed_m_per_s: a number with a leading zero, which YAML may read as octal; found -01.5; allowed: above 0, "
       "up to 2 m/s, without the zero"},
      {".nan", "1:16 speed_m_per_s: not a finite number; found .nan; allowed: above 0, up to 2 m/s"},
      {"-.inf", "1:16 speed_m_per_s: not a finite number; found -.inf; allowed: above 0, up to 2 m/s"},
      {".Inf", "1:16 speed_m_per_s: not a finite number; found .Inf; allowed: above 0, up to 2 m/s"},
      {"1e999", "1:16 speed_m_per_s: not a finite number; found 1e999; allowed: above 0, up to 2 m/s"},
      {"0x1", "1:16 speed_m_per_s: not a number; found 0x1; allowed: above 0, up to 2 m/s"},
      {"1_0", "1:16 speed_m_per_s: not a number; found 1_0; allowed: above 0, up to 2 m/s"},
      {"12:30", "1:16 speed_m_per_s: not a number; found 12:30; allowed: above 0, up to 2 m/s"},
      {".5", "1:16 speed_m_per_s: not a number; found .5; allowed: above 0, up to 2 m/s"},
      {"0,5", "1:16 speed_m_per_s: not a number; found 0,5; allowed: above 0, up to 2 m/s"},
      {"yes", "1:16 speed_m_per_s: not a number; found yes; allowed: above 0, up to 2 m/s"},
      {"0.3 m/s", "1:16 speed_m_per_s: not a number; found 0.3 m/s; allowed: above 0, up to 2 m/s"},
      {"\"0.3\"",
       "1:16 speed_m_per_s: a text, not a number; found \"0.3\"; allowed: above 0, up to 2 m/s, without quotes"},
      {"[0.3]", "1:16 speed_m_per_s: not a number; found a list; allowed: above 0, up to 2 m/s"},
      {"{a: 1}", "1:16 speed_m_per_s: not a number; found a map of keys; allowed: above 0, up to 2 m/s"},
      {"0", "1:16 speed_m_per_s: out of range; found 0; allowed: above 0, up to 2 m/s"},
      {"2.0001", "1:16 speed_m_per_s: out of range; found 2.0001; allowed: above 0, up to 2 m/s"},
      {"", "1:1 speed_m_per_s: no value; allowed: a value, or leave the key out"},
  }));
  CAPTURE(row.value);
  CHECK(errors(std::string{"speed_m_per_s: "} + row.value + "\n") == Lines{row.error});
}

TEST_CASE("numbers of every JSON form are taken") {
  for (const char* value : {"2", "0.3", "3e-1", "0.03E+1", "1.25e0"}) {
    CAPTURE(value);
    CHECK(errors(std::string{"speed_m_per_s: "} + value) == Lines{});
  }
}

TEST_CASE("whole numbers, flags, words, times and texts are strict") {
  struct Row {
    const char* yaml;
    const char* error;
  };
  const auto row = GENERATE(values<Row>({
      {"seed: 1.0", "1:7 seed: not a whole number; found 1.0; allowed: 0 to 9007199254740992"},
      {"seed: 1e3", "1:7 seed: not a whole number; found 1e3; allowed: 0 to 9007199254740992"},
      {"seed: -1", "1:7 seed: out of range; found -1; allowed: 0 to 9007199254740992"},
      {"seed: 9007199254740994", "1:7 seed: out of range; found 9007199254740994; allowed: 0 to 9007199254740992"},
      {"loud: yes", "1:7 loud: neither true nor false; found yes; allowed: true, false"},
      {"loud: True", "1:7 loud: neither true nor false; found True; allowed: true, false"},
      {"loud: 'true'", "1:7 loud: neither true nor false; found \"true\"; allowed: true, false"},
      {"note: no", "1:7 note: YAML reads this word as true or false; found no; allowed: a text: put it in quotes"},
      {"note: On", "1:7 note: YAML reads this word as true or false; found On; allowed: a text: put it in quotes"},
      {"name: 007", "1:7 name: YAML reads this as a number; found 007; allowed: a text: put it in quotes"},
      {"name: 1e5", "1:7 name: YAML reads this as a number; found 1e5; allowed: a text: put it in quotes"},
      {"name: 12:30", "1:7 name: YAML reads this as a number; found 12:30; allowed: a text: put it in quotes"},
      {"name: ../x",
       "1:7 name: not of the form that is needed; found ../x; allowed: 1 to 32 of a–z, 0–9, _ and -, the first a "
       "letter or digit"},
      {"name: Sim",
       "1:7 name: not of the form that is needed; found Sim; allowed: 1 to 32 of a–z, 0–9, _ and -, the first a letter "
       "or digit"},
      {"name: 'siм'",
       "1:7 name: not of the form that is needed; found \"siм\"; allowed: 1 to 32 of a–z, 0–9, _ and -, the first a "
       "letter or digit"},
      {"name: ''",
       "1:7 name: not of the form that is needed; found \"\"; allowed: 1 to 32 of a–z, 0–9, _ and -, the first a "
       "letter or digit"},
      {"name: abcdefghijklmnopqrstuvwxyz0123456",
       "1:7 name: not of the form that is needed; found abcdefghijklmnopqrstuvwxyz0123456; allowed: 1 to 32 of a–z, "
       "0–9, _ and -, the first a letter or digit"},
      {"name: [a]",
       "1:7 name: not a text; found a list; allowed: 1 to 32 of a–z, 0–9, _ and -, the first a letter or digit"},
      {"colour: gren", "1:9 colour: not one of the words; found gren; allowed: red, green; did you mean green?"},
      {"colour: blue", "1:9 colour: not available in this version; available: red, green; found blue"},
      {"colour: 7", "1:9 colour: not one of the words; found 7; allowed: red, green"},
      {"cell_km: aut", "1:10 cell_km: not one of the words; found aut; allowed: auto, a number; did you mean auto?"},
      {"cell_km: .nan", "1:10 cell_km: not a finite number; found .nan; allowed: 0 to 10 km"},
      {"cell_km: '3'", "1:10 cell_km: a text, not a number; found \"3\"; allowed: 0 to 10 km, without quotes"},
      {"at: yesterday", "1:5 at: not a time; found yesterday; allowed: UTC as 2026-11-25T10:20:30Z"},
      {"at: 2026-02-30T00:00Z", "1:5 at: not a time; found 2026-02-30T00:00Z; allowed: UTC as 2026-11-25T10:20:30Z"},
      {"at: 2026-11-25T10:20:30+01:00",
       "1:5 at: not a time; found 2026-11-25T10:20:30+01:00; allowed: UTC as 2026-11-25T10:20:30Z"},
      {"files: a.nc", "1:8 files: not a list; found a.nc; allowed: a list"},
      {"files: [a.nc, 3]", "1:15 files[1]: YAML reads this as a number; found 3; allowed: a text: put it in quotes"},
      {"inners: []", "1:9 inners: a list of another length; found 0; allowed: a list of at least 1"},
      {"inners: [{label: a}, {count: 1}]", "1:22 inners[1].label: missing; the key is required"},
      {"inners: [{label: a}, b]",
       "1:22 inners[1]: not a map of keys; found b; allowed: KEY: VALUE lines, or {KEY: VALUE, …}"},
      {"inner: 4", "1:8 inner: not a map of keys; found 4; allowed: KEY: VALUE lines, or {KEY: VALUE, …}"},
      {"inner:", "1:1 inner: no value; allowed: a value, or leave the key out"},
      {"place: {lat_deg: 91}", "1:18 place.lat_deg: out of range; found 91; allowed: -90 to 90 °"},
      {"place: {lat_deg: 115.5, lon_deg: 29.1}",
       "1:18 place.lat_deg: latitude out of range; latitude and longitude swapped?; found 115.5; allowed: -90 to 90 °"},
      {"place: {lat_deg: 115.5, lon_deg: 129.1}",
       "1:18 place.lat_deg: out of range; found 115.5; allowed: -90 to 90 °"},
      {"place: {lon_deg: 361}", "1:18 place.lon_deg: out of range; found 361; allowed: -360 to 360 °"},
      {"sped_m_per_s: 1", "1:1 sped_m_per_s: unknown key; did you mean speed_m_per_s?"},
      {"inner: {label: a, cuont: 1}", "1:19 inner.cuont: unknown key; did you mean count?"},
      {"inner: {label: a, zzz: 1}", "1:19 inner.zzz: unknown key; allowed: label, count"},
  }));
  CAPTURE(row.yaml);
  CHECK(errors(std::string{row.yaml} + "\n") == Lines{row.error});
}

TEST_CASE("every error is told at once, by line") {
  CHECK(errors("colour: pink\nloud: yes\nspeed_m_per_s: 3\nseed: 1\nseed: 2\nzz: 1\n") ==
        Lines{"1:9 colour: not one of the words; found pink; allowed: red, green",
              "2:7 loud: neither true nor false; found yes; allowed: true, false",
              "3:16 speed_m_per_s: out of range; found 3; allowed: above 0, up to 2 m/s",
              "5:1 seed: duplicate key; it stands first in line 4",
              "6:1 zz: unknown key; allowed: speed_m_per_s, angle_deg, wait_min, cell_km, turn_deg, place, seed, "
              "halves, loud, name, note, "
              "files, colour, at, inner, inners"});
}

TEST_CASE("a value that was reported as an alias is not reported a second time") {
  CHECK(errors("speed_m_per_s: &s 0.3\nwait_min: *s\ncolour: *s\nloud: *s\nname: *s\nfiles: *s\ninner: *s\nat: *s\n")
            .size() == 8);
}

TEST_CASE("an empty value means the default where there is none, and is an error elsewhere") {
  CHECK(errors("turn_deg:\nat: ~\nname:\n") == Lines{});
  CHECK(errors("wait_min:\n") == Lines{"1:1 wait_min: no value; allowed: a value, or leave the key out"});
}

TEST_CASE("effective values carry their origin and read back to the same") {
  const auto r = read(
      "angle_deg: 31.7\nplace: {lat_deg: 0.1}\ninner:\n  label: 'on'\ninners:\n  - {label: a}\n  - label: b\n    "
      "count: 3\n");
  REQUIRE(r.errors.empty());
  CHECK(r.effective ==
        "speed_m_per_s: 0.3  # default\n"
        "angle_deg: 31.7     # t.yaml:1\n"
        "wait_min: 15        # default\n"
        "cell_km: auto       # default\n"
        "turn_deg:           # default: learned\n"
        "place:\n"
        "  lat_deg: 0.1      # t.yaml:2\n"
        "  lon_deg:          # default: none\n"
        "seed: 1             # default\n"
        "halves:             # default: none\n"
        "loud: false         # default\n"
        "name:               # default: none\n"
        "note:               # default: none\n"
        "files: []           # default\n"
        "colour: red         # default\n"
        "at:                 # default: now\n"
        "inner:\n"
        "  label: \"on\"       # t.yaml:4\n"
        "  count: 1          # default\n"
        "inners:\n"
        "  - label: a        # t.yaml:6\n"
        "    count: 1        # default\n"
        "  - label: b        # t.yaml:7\n"
        "    count: 3        # t.yaml:8\n");
  const auto again = read(r.effective);
  CHECK(again.errors == Lines{});
  CHECK(again.thing.angle == r.thing.angle);
  CHECK(again.thing.inner.label == "on");
}

TEST_CASE("keys of one map may fill several structs") {
  struct Outer {
    Thing thing;
    int own{4};
  };
  Fields<Thing> names;
  names.text({"name", "a name", true}, &Thing::name);
  Fields<Outer> f;
  f.include(&Outer::thing, names).whole({"own", "its own"}, &Outer::own, from_to(0, 9));
  const auto document = read_yaml("name: x\nown: 7\n", "t.yaml");
  Reading reading{"t.yaml"};
  Outer outer;
  f.read(At{document.root, nullptr, "", reading}, outer);
  CHECK(reading.problems.empty());
  CHECK(outer.thing.name == "x");
  CHECK(outer.own == 7);
  Effective effective{&reading};
  f.print(outer, "", effective);
  CHECK(effective.text().find("name: x") == 0);
  const auto keys = f.shape().keys;
  REQUIRE(keys.size() == 2);
  CHECK(keys[0].required);
  const auto wrong = read_yaml("nam: x\n", "t.yaml");
  Reading again{"t.yaml"};
  f.read(At{wrong.root, nullptr, "", again}, outer);
  CHECK(again.problems.sorted().size() == 2);  // the key unknown, with its nearest, and the required one missing
}
