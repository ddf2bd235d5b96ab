#pragma once

#include <map>
#include <memory>

#include "daemon/world/procs.hpp"
#include "daemon/world/real_loop.hpp"

namespace glidehelm::world {

/// Children of this machine: vfork and exec with closed descriptors, an environment of PATH, TMPDIR and LC_ALL=C,
/// PR_SET_PDEATHSIG, limits and a deadline. Each running child is served by a thread of its own that only moves bytes and
/// posts the result into the loop.
class RealProcs final : public Procs {
 public:
  explicit RealProcs(RealLoop& loop);
  ~RealProcs() override;  ///< kills what still runs and waits for it
  void run(ProcessRequest request, std::function<void(ProcessResult)> then) override;
  [[nodiscard]] ProcessResult run_and_wait(const ProcessRequest& request) override;

 private:
  struct Child;
  void forget_finished();
  RealLoop& loop_;
  std::vector<std::shared_ptr<Child>> children_;
};

}  // namespace glidehelm::world
