#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "core/planning/lower_bound.hpp"
#include "core/planning/registry.hpp"
#include "daemon/world/workers.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

/// All digits: two numbers have the same text only when they have the same bytes.
std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, " %a", value);
  return text;
}
std::string exact(GeoPoint p) { return exact(p.lat.radians()) + exact(p.lon.radians()); }
std::string exact(const planning::Statistics& s) {
  return " " + std::to_string(s.expansions) + " " + std::to_string(s.cost_evaluations) + " " +
         std::to_string(s.current_evaluations);
}

std::string exact(const planning::Plan& plan) {
  std::string text = plan.method + exact(plan.arrival_s) + exact(plan.remaining.si()) + exact(plan.statistics);
  for (const auto& s : plan.stints)
    text += "\n" + exact(s.dive) + exact(s.dive_s) + exact(s.surface) + exact(s.surface_s) +
            exact(s.heading.from_north().si()) + exact(s.dac.east.si()) + exact(s.dac.north.si());
  return text + "\n" + plan.reason;
}

/// A question: a method, or the lower bound, in one sea.
struct Question {
  const test::Sea* sea;
  std::string method;  ///< empty: the lower bound
};

std::string answer(const Question& q) {
  const ocean::Ocean ocean{q.sea->field, q.sea->field};
  const chart::Chart open;
  if (q.method.empty()) {
    const auto bound = planning::lower_bound(q.sea->problem, ocean, open, {}, {.spacing = Metres{900}});
    return bound ? exact(bound->travel_s) + exact(bound->error_s) + exact(bound->statistics) + bound->reason
                 : bound.error().message;
  }
  const std::array<ocean::Ocean, 1> members{ocean};
  const auto plan = planning::planner_named(q.method)->plan(q.sea->problem, members, open, {}, {});
  return plan ? exact(*plan) : plan.error().message;
}

std::vector<std::string> answers(const std::vector<Question>& questions, unsigned threads) {
  std::vector<std::string> all(questions.size());
  world::for_each_index(questions.size(), threads, [&](std::size_t k) { all[k] = answer(questions[k]); });
  return all;
}

}  // namespace

TEST_CASE("every method and the lower bound say the same bytes on one thread and on two and on three") {
  auto seas = test::analytic_seas();
  std::vector<Question> questions;
  // A steady current, an eddy and a field that changes with time; neighbours in the list differ in sea and share the method.
  for (const auto& method : planning::method_names())
    for (const std::size_t sea : {0U, 5U, 8U}) {
      seas.at(sea).problem.headings = 9;
      questions.push_back({&seas.at(sea), method});
    }
  for (const std::size_t sea : {0U, 5U, 8U}) questions.push_back({&seas.at(sea), ""});
  const auto alone = answers(questions, 1);
  for (const unsigned threads : {2U, 3U}) {
    const auto together = answers(questions, threads);
    for (std::size_t k = 0; k < questions.size(); ++k) {
      INFO(threads << " threads, " << questions[k].method << " in " << questions[k].sea->name);
      CHECK(together[k] == alone[k]);
    }
  }
}
