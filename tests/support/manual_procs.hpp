#pragma once

#include <deque>
#include <map>
#include <vector>

#include "daemon/world/net.hpp"
#include "daemon/world/procs.hpp"

namespace glidehelm::test {

/// Children that the test plays: a scripted result, a function in this process, or "not started".
class ManualProcs final : public world::Procs {
 public:
  using Program = std::function<world::ProcessResult(const world::ProcessRequest&)>;
  explicit ManualProcs(world::Net& net) : net_{net} {}

  /// Every run of `name` (the last component of its path) is answered by `program`.
  void play(const std::string& name, Program program) { programs_[name] = std::move(program); }
  /// The next run of `name` ends so; several wait in order, before `play`.
  void script(const std::string& name, world::ProcessResult result) { scripted_[name].push_back(std::move(result)); }
  /// Answers are kept until `answer` lets them go, one by one.
  void hold() { held_ = true; }
  bool answer() {
    if (waiting_.empty()) return false;
    auto then = std::move(waiting_.front());
    waiting_.pop_front();
    net_.post(std::move(then));
    return true;
  }

  void run(world::ProcessRequest request, std::function<void(world::ProcessResult)> then) override {
    auto ended = [result = run_and_wait(request), then = std::move(then)] { then(result); };
    if (held_)
      waiting_.emplace_back(std::move(ended));
    else
      net_.post(std::move(ended));
  }
  [[nodiscard]] world::ProcessResult run_and_wait(const world::ProcessRequest& request) override {
    requests.push_back(request);
    const auto name = request.program.substr(request.program.rfind('/') + 1);
    if (auto& results = scripted_[name]; !results.empty()) {
      auto result = std::move(results.front());
      results.pop_front();
      return result;
    }
    const auto program = programs_.find(name);
    return program == programs_.end() ? world::ProcessResult{{}, ENOENT, {}, {}} : program->second(request);
  }

  std::vector<world::ProcessRequest> requests;  ///< everything that was asked for, in order

 private:
  world::Net& net_;
  std::map<std::string, Program> programs_;
  std::map<std::string, std::deque<world::ProcessResult>> scripted_;
  std::deque<std::function<void()>> waiting_;
  bool held_{};
};

}  // namespace glidehelm::test
