#include "config/daemon.hpp"

#include <catch2/catch.hpp>

#include "tests/support/config.hpp"

using namespace glidehelm;
using namespace glidehelm::config;
using Lines = std::vector<std::string>;

namespace {

const std::string kHead = "schema: glidehelm/daemon/v1\n";
const std::string kGlider = "{name: sim01, line: {listen: \"127.0.0.1:6500\"}, to_glider: /g/sim01/to-glider}";

Lines daemon_errors(const std::string& yaml) {
  return test::errors_of(read_daemon_file(kHead + yaml, "/etc/glidehelm/d.yaml"));
}
DaemonFile read_daemon(const std::string& yaml) {
  const auto file = read_daemon_file(kHead + yaml, "/etc/glidehelm/d.yaml");
  if (!file)
    for (const auto& error : file.error()) UNSCOPED_INFO(error.message());
  REQUIRE(file);
  return *file;
}
/// Errors of a file whose only glider, in line 2, has this line.
Lines line_errors(const std::string& line) {
  return daemon_errors("gliders: [{name: a, to_glider: /g/a, line: " + line + "}]\n");
}

}  // namespace

TEST_CASE("the smallest daemon file has one glider and defaults for the rest") {
  const auto file = read_daemon("gliders:\n  - " + kGlider + "\n");
  DaemonConfig wanted;
  wanted.missions = {"/etc/glidehelm/missions.d/*.yaml"};
  wanted.gliders = {GliderEntry{"sim01", Listen{Endpoint{"127.0.0.1", 6500}, {}}, "/g/sim01/to-glider", {}, false}};
  CHECK(file.config == wanted);
  CHECK_FALSE(file.config.simulated_clock);
  CHECK(file.config.state_dir == "/var/lib/glidehelm");
  CHECK(file.config.control_socket == "/run/glidehelm/control.sock");
  CHECK(file.glider_places == std::vector<Place>{{3, 12}});
}

TEST_CASE("every key of the daemon file reaches its place") {
  const auto config = read_daemon(
                          "clock: {simulated: run/clock.sock}\nstate_dir: state/\ncontrol_socket: "
                          "/tmp/c.sock\nmissions: [a.yaml, /b/*.yaml]\n"
                          "coast: c.coast\nlog: {level: warn}\n"
                          "gliders:\n"
                          "  - {name: sea1, line: {listen: \"[::]:6501\", allow: [192.0.2.0/24, \"2001:db8::/32\"]}, "
                          "to_glider: /g/sea1/, clock_skew_ok: true}\n"
                          "  - {name: sea2, line: {connect: bridge.example.org:4001}, to_glider: g/sea2}\n")
                          .config;
  CHECK(config.simulated_clock == "/etc/glidehelm/run/clock.sock");
  CHECK(config.state_dir == "/etc/glidehelm/state");
  CHECK(config.control_socket == "/tmp/c.sock");
  CHECK(config.missions == std::vector<std::string>{"/etc/glidehelm/a.yaml", "/b/*.yaml"});
  CHECK(config.coast == "/etc/glidehelm/c.coast");
  CHECK(config.log_level == LogLevel::warn);
  REQUIRE(config.gliders.size() == 2);
  const auto& listen = std::get<Listen>(config.gliders[0].line);
  CHECK(listen.at == Endpoint{"::", 6501});
  CHECK(listen.lets_in("192.0.2.9"));
  CHECK(listen.lets_in("2001:db8::9"));
  CHECK_FALSE(listen.lets_in("127.0.0.1"));
  CHECK_FALSE(listen.lets_in("no address"));
  CHECK(config.gliders[0].to_glider == "/g/sea1");
  CHECK(config.gliders[0].clock_skew_ok);
  CHECK(std::get<Connect>(config.gliders[1].line).to == Endpoint{"bridge.example.org", 4001});
  CHECK(config.gliders[1].to_glider == "/etc/glidehelm/g/sea2");
}

TEST_CASE("without allow only this machine is let in") {
  const auto config = read_daemon("gliders: [" + kGlider + "]\n").config;
  const auto& listen = std::get<Listen>(config.gliders[0].line);
  CHECK(listen.lets_in("127.0.0.1"));
  CHECK(listen.lets_in("::1"));
  CHECK_FALSE(listen.lets_in("192.0.2.1"));
}

TEST_CASE("a line that cannot be right is named with its place") {
  struct Row {
    const char* line;
    Lines errors;
  };
  const auto row = GENERATE(values<Row>({
      {"{listen: \"0.0.0.0:6500\"}",
       {"2:53 gliders[0].line.listen: listens beyond this machine without saying to whom; found 0.0.0.0; allowed: "
        "127.0.0.1, or an allow: list of networks beside it"}},
      {"{listen: \"192.0.2.1:6500\", allow: []}",
       {"2:78 gliders[0].line.allow: no network, but listen is open beyond this machine; allowed: networks such as "
        "192.0.2.0/24"}},
      {"{listen: \"example.org:6500\"}",
       {"2:53 gliders[0].line.listen: not an address of this machine; found example.org; allowed: an IP address or "
        "localhost"}},
      {"{listen: \"127.0.0.1:0\"}",
       {"2:53 gliders[0].line.listen: not of the form that is needed; found \"127.0.0.1:0\"; allowed: HOST:PORT or "
        "[IPV6]:PORT, ports 1 to 65535"}},
      {"{listen: \"127.0.0.1:65536\"}",
       {"2:53 gliders[0].line.listen: not of the form that is needed; found \"127.0.0.1:65536\"; allowed: HOST:PORT or "
        "[IPV6]:PORT, ports 1 to 65535"}},
      {"{listen: 6500}",
       {"2:53 gliders[0].line.listen: YAML reads this as a number; found 6500; allowed: a text: put it in quotes"}},
      {"{listen: \"127.0.0.1:1\", connect: \"a:1\"}",
       {"2:44 gliders[0].line: both listen and connect; allowed: one of the two"}},
      {"{}",
       {"2:44 gliders[0].line: neither listen nor connect; allowed: {listen: ADDRESS:PORT} or {connect: HOST:PORT}"}},
      {"{connect: \"a:1\", allow: [192.0.2.0/24]}", {"2:68 gliders[0].line.allow: goes with listen only"}},
      {"{listen: \"0.0.0.0:1\", allow: [192.0.2.7/24]}",
       {"2:74 gliders[0].line.allow[0]: not of the form that is needed; found 192.0.2.7/24; allowed: networks such as "
        "192.0.2.0/24, host bits 0"}},
      {"{lisen: \"127.0.0.1:1\"}",
       {"2:44 gliders[0].line: neither listen nor connect; allowed: {listen: ADDRESS:PORT} or {connect: HOST:PORT}",
        "2:45 gliders[0].line.lisen: unknown key; did you mean listen?"}},
      {"tcp", {"2:44 gliders[0].line: not a map of keys; found tcp; allowed: KEY: VALUE lines, or {KEY: VALUE, …}"}},
  }));
  CAPTURE(row.line);
  CHECK(line_errors(row.line) == row.errors);
}

TEST_CASE("two gliders with one name, one port or one folder are a mistake at the second") {
  CHECK(
      daemon_errors("gliders:\n"
                    "  - {name: a, line: {listen: \"127.0.0.1:6500\"}, to_glider: /g/a}\n"
                    "  - {name: a, line: {listen: \"127.0.0.2:6500\"}, to_glider: /g//./a/}\n"
                    "  - {name: c, line: {connect: \"h:1\"}, to_glider: /g/c}\n"
                    "  - {name: d, line: {connect: \"h:1\"}, to_glider: /g/d}\n") ==
      Lines{"4:12 gliders[1].name: two gliders with one name; the first stands in line 3; found a",
            "4:30 gliders[1].line.listen: two gliders with one port; the first stands in line 3; found 127.0.0.2:6500",
            "4:60 gliders[1].to_glider: two gliders with one to_glider folder; the first stands in line 3; found "
            "/g//./a/",
            "6:31 gliders[3].line.connect: two gliders with one host and port; the first stands in line 5; found h:1"});
}

TEST_CASE("mistakes outside the gliders are named too") {
  CHECK(daemon_errors("clock: sistem\nmissons: []\ngliders: []\n") ==
        Lines{"2:8 clock: not one of the words; found sistem; allowed: system; did you mean system?",
              "3:1 missons: unknown key; did you mean missions?",
              "4:10 gliders: a list of another length; found 0; allowed: a list of at least 1"});
  CHECK(daemon_errors("clock: {simulatd: a}\nlog: {level: loud}\nstate_dir:\n") ==
        Lines{"1:1 gliders: missing; the key is required", "2:8 clock.simulated: missing; the key is required",
              "2:9 clock.simulatd: unknown key; did you mean simulated?",
              "3:14 log.level: not one of the words; found loud; allowed: debug, info, warn, error",
              "4:1 state_dir: no value; allowed: a value, or leave the key out"});
  CHECK(daemon_errors("gliders: [{name: ../x, line: {connect: \"a:1\"}, to_glider: /g, clock_skew_ok: yes}]\n") ==
        Lines{"2:18 gliders[0].name: not of the form that is needed; found ../x; allowed: 1 to 32 of a–z, 0–9, _ and "
              "-, the first a letter or digit",
              "2:78 gliders[0].clock_skew_ok: neither true nor false; found yes; allowed: true, false"});
}

TEST_CASE("the daemon's values in force read back to the same") {
  const auto file =
      read_daemon("clock: {simulated: run/clock.sock}\ngliders:\n  - " + kGlider +
                  "\n  - {name: b, line: {listen: \"0.0.0.0:1\", allow: [192.0.2.0/24]}, to_glider: /g/b}\n" +
                  "  - {name: c, line: {connect: \"h:1\"}, to_glider: /g/c}\n");
  CAPTURE(file.effective);
  const auto again = read_daemon_file(file.effective, "/etc/glidehelm/d.yaml");
  REQUIRE(again);
  CHECK(again->config == file.config);
  CHECK(file.effective.find("control_socket: /run/glidehelm/control.sock") != std::string::npos);
}

TEST_CASE("texts of a dialog replace the usual ones key by key") {
  const auto file = read_daemon(
      "gliders: [{name: a, to_glider: /g/a, line: {listen: \"127.0.0.1:1\"}, dialog: {reread: [\"Mafiles: again\", "
      "Re-read], "
      "transfer_failed: [\"! ERROR sending\"]}}]\n");
  const protocol::DialogWords usual;
  const auto& words = file.config.gliders.at(0).dialog;
  CHECK(words.reread == std::vector<std::string>{"Mafiles: again", "Re-read"});
  CHECK(words.transfer_failed == std::vector<std::string>{"! ERROR sending"});
  CHECK(words.transfer_starts == usual.transfer_starts);
  CHECK(words.transfer_done == usual.transfer_done);
  CHECK(words.command_succeeded == usual.command_succeeded);
  CHECK(words.command_failed == usual.command_failed);
  CHECK(words.nothing_to_send == usual.nothing_to_send);
  const auto again = read_daemon_file(file.effective, "/etc/glidehelm/d.yaml");
  REQUIRE(again);
  CHECK(again->config == file.config);
}

TEST_CASE("a text of a dialog that could not be heard is named with its place") {
  struct Row {
    const char* dialog;
    Lines errors;
  };
  const auto row = GENERATE(values<Row>({
      {"{reread: []}",
       {"2:86 gliders[0].dialog.reread: a list of another length; found 0; allowed: a list of 1 to 16"}},
      {"{reread: [x]}",
       {"2:87 gliders[0].dialog.reread[0]: not of the form that is needed; found x; allowed: 2 to 120 printable ASCII "
        "characters, no blank at either end"}},
      {"{reread: [\"MAFILES \"]}",
       {"2:87 gliders[0].dialog.reread[0]: not of the form that is needed; found \"MAFILES \"; allowed: 2 to 120 "
        "printable "
        "ASCII characters, no blank at either end"}},
      {"{reread: [again, again]}", {"2:94 gliders[0].dialog.reread[1]: stands twice; found again"}},
      {"{transfer_done: [ended], transfer_failed: [ended]}",
       {"2:120 gliders[0].dialog.transfer_failed[0]: is also a text of transfer_done; found ended"}},
      {"{transfer_failed: [zModem transfer DONE for file]}",
       {"2:96 gliders[0].dialog.transfer_failed[0]: is also a text of transfer_done; found zModem transfer DONE for "
        "file"}},
      {"{rereads: [again]}", {"2:78 gliders[0].dialog.rereads: unknown key; did you mean reread?"}},
  }));
  CAPTURE(row.dialog);
  CHECK(daemon_errors("gliders: [{name: a, to_glider: /g/a, line: {listen: \"127.0.0.1:1\"}, dialog: " +
                      std::string{row.dialog} + "}]\n") == row.errors);
}
