#include "daemon/planning_worker.hpp"

#include <algorithm>

namespace glidehelm::daemon {

PlanningWorker::PlanningWorker() : thread_{[this] { run(); }} {}

PlanningWorker::~PlanningWorker() {
  {
    const std::lock_guard lock{mutex_};
    ends_ = true;
    waiting_.clear();
    if (running_expired_) *running_expired_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

std::uint64_t PlanningWorker::submit(Job job) {
  const std::lock_guard lock{mutex_};
  waiting_.push_back({++last_ticket_, std::move(job), std::make_shared<std::atomic<bool>>(false)});
  changed_.notify_one();
  return last_ticket_;
}

void PlanningWorker::stop(std::uint64_t ticket) {
  const std::lock_guard lock{mutex_};
  if (running_ == ticket && running_expired_) {
    *running_expired_ = true;
    return;
  }
  const auto entry = std::find_if(waiting_.begin(), waiting_.end(), [&](const Entry& e) { return e.ticket == ticket; });
  if (entry != waiting_.end()) waiting_.erase(entry);
}

void PlanningWorker::run() {
  std::unique_lock lock{mutex_};
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    Entry entry = std::move(waiting_.front());
    waiting_.pop_front();
    running_ = entry.ticket;
    running_expired_ = entry.expired;
    lock.unlock();
    entry.job(*entry.expired);
    entry.job = nullptr;  // what the job holds is released outside the lock
    lock.lock();
    running_ = 0;
    running_expired_.reset();
  }
}

}  // namespace glidehelm::daemon
