#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <vector>

#include "daemon/world/net.hpp"

namespace glidehelm::test {

/// Streams in memory and a loop that the test turns. Nothing is delivered inside a call: everything goes through the
/// loop's queue, in order, as on the real one. Single-threaded but for `post`.
class ManualNet final : public world::Net {
  /// One end of a connection; the other end keeps it alive while bytes are on their way.
  class End final : public world::Stream, public std::enable_shared_from_this<End> {
   public:
    End(ManualNet& net, std::string peer, std::uint32_t uid) : net_{net}, peer_{std::move(peer)}, uid_{uid} {}

    void start(Handlers handlers) override {
      handlers_ = std::move(handlers);
      started_ = true;
      if (!closed_) self_ = shared_from_this();  // a started stream lives until it ends, held or not
      for (auto& arrived : std::exchange(early_, {})) arrived();
    }
    void write(std::string bytes) override {
      if (closed_ || bytes.empty()) return;
      const auto other = other_.lock();
      if (!other) return;
      if ((unread_ += bytes.size()) > kMostUnread) {
        end("the peer does not read: more than 1 MiB is waiting for it");
        return;
      }
      const auto size = bytes.size();
      net_.post([self = shared_from_this(), other, bytes = std::move(bytes), size] {
        other->arrive([self, other, bytes, size] {
          self->unread_ -= size;
          other->hear(bytes);
        });
      });
    }
    void close() override {
      if (closed_) return;
      const auto alive = shared_from_this();
      closed_ = true;
      handlers_ = {};
      tell_other("the peer closed the connection");
      self_.reset();
    }
    [[nodiscard]] std::string peer() const override { return peer_; }
    [[nodiscard]] std::uint32_t peer_uid() const override { return uid_; }

    static void join(const std::shared_ptr<End>& a, const std::shared_ptr<End>& b) {
      a->other_ = b;
      b->other_ = a;
    }
    void end(const std::string& reason) {
      if (closed_) return;
      const auto alive = shared_from_this();
      closed_ = true;
      const auto ended = std::move(handlers_.ended);
      handlers_ = {};
      tell_other("the peer closed the connection");
      if (ended) ended(reason);
      self_.reset();
    }
    void forget() {
      closed_ = true;
      handlers_ = {};
      early_.clear();
      self_.reset();
    }

   private:
    static constexpr std::size_t kMostUnread = 1U << 20;
    void tell_other(const std::string& reason) {
      if (const auto other = other_.lock())
        net_.post([other, reason] { other->arrive([other, reason] { other->end(reason); }); });
    }
    void arrive(std::function<void()> what) {
      if (started_)
        what();
      else
        early_.push_back(std::move(what));
    }
    void hear(std::string_view bytes) {
      const std::size_t piece = net_.chunk == 0 ? bytes.size() : net_.chunk;
      while (!bytes.empty() && !closed_) {
        const auto handler = handlers_.bytes;
        if (handler) handler(bytes.substr(0, piece));
        bytes.remove_prefix(std::min(piece, bytes.size()));
      }
    }

    ManualNet& net_;
    std::string peer_;
    std::uint32_t uid_;
    std::weak_ptr<End> other_;
    std::shared_ptr<End> self_;
    Handlers handlers_;
    std::vector<std::function<void()>> early_;
    std::size_t unread_{};
    bool started_{}, closed_{};
  };

  struct Ear {
    std::string where;
    Accepted accepted;
  };
  class Heard final : public world::Listener {
   public:
    Heard(ManualNet& net, std::string where, std::uint16_t port) : net_{net}, where_{std::move(where)}, port_{port} {}
    ~Heard() override { net_.ears_.erase(where_); }
    [[nodiscard]] std::uint16_t port() const override { return port_; }

   private:
    ManualNet& net_;
    std::string where_;
    std::uint16_t port_;
  };

 public:
  ManualNet() = default;
  ~ManualNet() override {
    for (const auto& connection : connections_)
      if (const auto end = connection.lock()) end->forget();
  }
  ManualNet(const ManualNet&) = delete;
  ManualNet& operator=(const ManualNet&) = delete;

  /// Largest piece in which bytes are delivered; 0: as they were written.
  std::size_t chunk{};
  /// Who a Unix socket says is at the other end.
  std::uint32_t uid{1000};

  [[nodiscard]] Expected<std::unique_ptr<world::Listener>, world::NetError> listen_tcp(const std::string& address,
                                                                                       std::uint16_t port,
                                                                                       Accepted accepted) override {
    if (port == 0) port = ++last_port_;
    return listen(std::to_string(port), address + ":" + std::to_string(port), port, std::move(accepted));
  }
  [[nodiscard]] Expected<std::unique_ptr<world::Listener>, world::NetError> listen_unix(const std::string& path,
                                                                                        unsigned,
                                                                                        Accepted accepted) override {
    return listen(path, path, 0, std::move(accepted));
  }
  void connect_tcp(const std::string& host, std::uint16_t port, Connected connected) override {
    connect(std::to_string(port), host + ":" + std::to_string(port), false, std::move(connected));
  }
  void connect_unix(const std::string& path, Connected connected) override {
    connect(path, path, true, std::move(connected));
  }
  void on_signal(int number, std::function<void()> then) override { signals_.emplace(number, std::move(then)); }
  void post(std::function<void()> work) override {
    {
      const std::lock_guard hold{mutex_};
      queue_.push_back(std::move(work));
    }
    posted_.notify_one();
  }
  void run() override {
    stopped_ = false;
    while (!stopped_) {
      std::function<void()> work;
      {
        std::unique_lock hold{mutex_};
        posted_.wait(hold, [&] { return !queue_.empty(); });
        work = take();
      }
      work();
    }
  }
  void stop() override {
    stopped_ = true;
    post([] {});
  }

  // ---- what the test does

  /// Runs everything that is queued and what that queues; returns how many things ran.
  std::size_t settle() {
    std::size_t count = 0;
    while (turn(std::chrono::milliseconds{0})) ++count;
    return count;
  }
  /// Runs one thing, waiting for another thread to post it; false when none came in time.
  bool turn(std::chrono::milliseconds patience) {
    std::function<void()> work;
    {
      std::unique_lock hold{mutex_};
      if (!posted_.wait_for(hold, patience, [&] { return !queue_.empty(); })) return false;
      work = take();
    }
    work();
    return true;
  }
  void raise(int number) {
    const auto [begin, end] = signals_.equal_range(number);
    for (auto signal = begin; signal != end; ++signal) post(signal->second);
  }
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  Expected<std::unique_ptr<world::Listener>, world::NetError> listen(const std::string& key, const std::string& address,
                                                                     std::uint16_t port, Accepted accepted) {
    if (ears_.count(key) != 0) return unexpected(world::NetError{"listen", address, "Address already in use"});
    ears_[key] = {address, std::move(accepted)};
    return std::unique_ptr<world::Listener>{std::make_unique<Heard>(*this, key, port)};
  }
  void connect(const std::string& key, const std::string& address, bool local, Connected connected) {
    post([this, key, address, local, connected = std::move(connected)] {
      const auto ear = ears_.find(key);
      if (ear == ears_.end()) {
        connected(unexpected(
            world::NetError{"connect", address, local ? "No such file or directory" : "Connection refused"}));
        return;
      }
      const auto caller_uid = local ? uid : 0xffffffffU;
      const std::string who =
          local ? "uid " + std::to_string(uid) + " pid 77" : "127.0.0.1:" + std::to_string(++last_caller_);
      const auto near = std::make_shared<End>(*this, local ? who : address, caller_uid);
      const auto far = std::make_shared<End>(*this, who, caller_uid);
      End::join(near, far);
      connections_.push_back(near);
      connections_.push_back(far);
      const auto accepted = ear->second.accepted;
      connected(std::shared_ptr<world::Stream>{near});
      accepted(far);
    });
  }
  std::function<void()> take() {
    auto work = std::move(queue_.front());
    queue_.pop_front();
    return work;
  }

  std::mutex mutex_;
  std::condition_variable posted_;
  std::deque<std::function<void()>> queue_;
  std::map<std::string, Ear> ears_;
  std::multimap<int, std::function<void()>> signals_;
  std::vector<std::weak_ptr<End>> connections_;
  std::uint16_t last_port_{20000}, last_caller_{40000};
  bool stopped_{};
};

}  // namespace glidehelm::test
