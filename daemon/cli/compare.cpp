#include "daemon/cli/compare.hpp"

#include <array>

#include "core/planning/registry.hpp"
#include "daemon/candidate.hpp"
#include "daemon/cli/compare_report.hpp"
#include "daemon/cli/new_file.hpp"
#include "daemon/cli/plan_case.hpp"

namespace glidehelm::cli {

namespace {

/// Something wrong with the words of the command; empty when all is well.
std::string misuse(const CompareOptions& options) {
  for (const auto& method : options.methods)
    if (!planning::planner_named(method)) {
      std::string known;
      for (const auto& name : planning::method_names()) known += (known.empty() ? "" : ", ") + name;
      return "--methods: " + method + " is unknown; available: " + known;
    }
  return "";
}

Compared ask(const std::string& method, const Case& c, const std::optional<Seconds>& budget, world::Clock& clock) {
  const std::array<ocean::Ocean, 1> members{c.ocean->forecast.ocean()};
  const auto begin = clock.tick();
  planning::Budget limits;
  limits.work = daemon::kStageWork;
  if (budget) limits.expired = [&clock, begin, budget] { return Seconds{clock.tick() - begin} >= *budget; };
  const auto plan = planning::planner_named(method)->plan(c.request.problem, members, c.chart->chart, limits, {});
  Compared answer{method, std::nullopt, "", Seconds{clock.tick() - begin}.count()};
  if (plan)
    answer.plan = *plan;
  else
    answer.problem = plan.error().message;
  return answer;
}

Comparison compare(const CompareOptions& options, const Case& c, world::World& world, std::ostream& err) {
  const auto& p = c.request.problem;
  const auto& goal = std::get<planning::PointGoal>(p.goal);
  Comparison all{c.mission.name, c.ocean->label(), p.start.fix, goal.at, goal.radius, p.start.fix_s, std::nullopt, {}};
  const auto methods = options.methods.empty() ? planning::method_names() : options.methods;
  double earliest = std::nan("");
  for (std::size_t i = 0; i < methods.size(); ++i) {
    err << c.mission.name << ": " << methods[i] << " (" << i + 1 << " of " << methods.size() << ")\n";
    all.answers.push_back(ask(methods[i], c, options.plan.budget, world.clock));
    const auto& plan = all.answers.back().plan;
    if (plan && plan->reaches_goal() && !(plan->arrival_s >= earliest)) earliest = plan->arrival_s;
  }
  if (!options.bound) return all;
  err << c.mission.name << ": lower bound\n";
  if (auto bound = daemon::certificate(c.request, *c.ocean, c.chart->chart, earliest, {})) all.bound = *bound;
  return all;
}

}  // namespace

int run_compare(const CompareOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (const auto wrong = misuse(options); !wrong.empty()) {
    err << "glidehelm compare: " << wrong << "\n";
    return 2;
  }
  if (!options.html.empty())
    if (const auto taken = why_not_new(options.html, world.files); !taken.empty()) {
      err << "glidehelm compare: --html: " << taken << "\n";
      return 2;
    }
  std::vector<Case> cases;
  for (const auto& mission : options.missions) {
    auto plan = options.plan;
    plan.mission = mission;
    plan.method.clear();
    auto c = prepare_case(plan, world, err);
    if (!c) {
      err << "glidehelm compare: " << c.error().message << "\n";
      return c.error().code;
    }
    cases.push_back(std::move(c).value());
  }
  std::vector<Comparison> comparisons;
  std::vector<const chart::Chart*> charts;
  for (const auto& c : cases) {
    comparisons.push_back(compare(options, c, world, err));
    charts.push_back(&c.chart->chart);
  }
  if (options.json)
    out << comparison_json(comparisons);
  else
    for (std::size_t i = 0; i < comparisons.size(); ++i) out << (i == 0 ? "" : "\n") << comparison_text(comparisons[i]);
  if (!options.html.empty())
    if (const auto problem = write_new_file(options.html, comparison_page(comparisons, charts), world.files);
        !problem.empty()) {
      err << "glidehelm compare: --html: " << problem << "\n";
      return 2;
    }
  for (const auto& c : comparisons) {
    bool reached = false;
    for (const auto& a : c.answers) reached = reached || (a.plan && a.plan->reaches_goal());
    if (!reached) return 1;
  }
  return 0;
}

}  // namespace glidehelm::cli
