#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace glidehelm::daemon {

/// One thread that runs jobs in order. A job gets a flag that says whether its answer is still wanted; what it finds it
/// hands back through the loop (`Net::post`), never through shared state. Movable into a child one day: a job's input
/// and output are values.
class PlanningWorker {
 public:
  /// `expired` becomes true when the job was stopped.
  using Job = std::function<void(const std::atomic<bool>& expired)>;

  PlanningWorker();
  ~PlanningWorker();  ///< stops what runs, drops what waits, joins
  PlanningWorker(const PlanningWorker&) = delete;
  PlanningWorker& operator=(const PlanningWorker&) = delete;

  /// Returns the ticket with which the job can be stopped.
  std::uint64_t submit(Job job);
  /// The job's flag is raised when it runs, or it never starts when it waits.
  void stop(std::uint64_t ticket);

 private:
  struct Entry {
    std::uint64_t ticket{};
    Job job;
    std::shared_ptr<std::atomic<bool>> expired;
  };
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Entry> waiting_;
  std::shared_ptr<std::atomic<bool>> running_expired_;
  std::uint64_t running_{}, last_ticket_{};
  bool ends_{};
  std::thread thread_;
};

}  // namespace glidehelm::daemon
