#include "daemon/log.hpp"

#include <spdlog/sinks/ostream_sink.h>

#include <catch2/catch.hpp>
#include <sstream>

#include "core/base/utc.hpp"
#include "tests/support/manual_clock.hpp"

using namespace glidehelm;
using mission::Level;

namespace {

struct Paper {
  test::ManualClock clock{*utc_from_text("2026-11-25T03:12:07Z")};
  std::ostringstream text;
  std::shared_ptr<spdlog::logger> sink{
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text))};
  daemon::Log log{sink, clock};
  Paper() { sink->set_pattern("%v"); }
  std::string take() {
    sink->flush();
    auto written = text.str();
    text.str("");
    return written;
  }
};

}  // namespace

TEST_CASE("a line of the log has time, level, glider and fact, in columns") {
  Paper paper;
  struct Row {
    Level level;
    const char* line;
  };
  const auto row =
      GENERATE(values<Row>({{Level::info, "2026-11-25T03:12:07Z info  sim01     the glider goes under\n"},
                            {Level::note, "2026-11-25T03:12:07Z note  sim01     the glider goes under\n"},
                            {Level::alert, "2026-11-25T03:12:07Z ALERT sim01     the glider goes under\n"},
                            {Level::page, "2026-11-25T03:12:07Z PAGE  sim01     the glider goes under\n"},
                            {Level::clear, "2026-11-25T03:12:07Z clear sim01     the glider goes under\n"}}));
  paper.log.fact(row.level, "sim01", "the glider goes under");
  CHECK(paper.take() == row.line);
}

TEST_CASE("a fact of the daemon itself stands behind a dash, and a long name moves its fact") {
  Paper paper;
  paper.log.info("", "ready");
  CHECK(paper.take() == "2026-11-25T03:12:07Z info  -         ready\n");
  paper.log.info("a-very-long-glider", "ready");
  CHECK(paper.take() == "2026-11-25T03:12:07Z info  a-very-long-glider ready\n");
}

TEST_CASE("on a simulated clock every line says SIMULATED, in simulated time") {
  Paper paper;
  paper.clock.be_simulated();
  paper.clock.advance(Seconds{60});
  paper.log.warn("sim01", "late");
  CHECK(paper.take() == "2026-11-25T03:13:07Z SIMULATED note  sim01     late\n");
}

TEST_CASE("no byte of a dialog breaks a line of the log or steers a terminal") {
  Paper paper;
  paper.log.alert("sim01", std::string{"a\nb\r\t\x1b[2J\x7f\0\xc3\xa4 z", 15});
  CHECK(paper.take() == "2026-11-25T03:12:07Z ALERT sim01     a\\x0ab\\x0d\\x09\\x1b[2J\\x7f\\x00\\xc3\\xa4 z\n");
}

TEST_CASE("the level of the sink counts: notes are warnings, alerts and pages errors, the rest information") {
  Paper paper;
  paper.sink->set_level(spdlog::level::warn);
  paper.log.info("sim01", "x");
  paper.log.fact(Level::clear, "sim01", "x");
  CHECK(paper.take().empty());
  paper.log.warn("sim01", "x");
  CHECK_FALSE(paper.take().empty());
  paper.sink->set_level(spdlog::level::err);
  paper.log.warn("sim01", "x");
  CHECK(paper.take().empty());
  paper.log.fact(Level::page, "sim01", "x");
  paper.log.alert("sim01", "x");
  CHECK_FALSE(paper.take().empty());
}
