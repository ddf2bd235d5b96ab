#pragma once

#include <catch2/catch.hpp>
#include <functional>

#include "daemon/world/net.hpp"

namespace glidehelm::test {

/// What every Net must do. `until` turns the loop until the condition holds, or fails.
class NetContract {
 public:
  using Until = std::function<void(const std::function<bool()>&)>;
  /// `path` is for a Unix socket.
  NetContract(world::Net& with, Until turn, std::string socket)
      : net{with}, until{std::move(turn)}, path{std::move(socket)} {}

  struct Ear {
    std::shared_ptr<world::Stream> stream;
    std::string heard, ended;
    bool started{};
    void start(std::shared_ptr<world::Stream> with) {
      stream = std::move(with);
      started = true;
      stream->start({[this](std::string_view bytes) { heard += bytes; },
                     [this](std::string_view reason) { ended = std::string{reason}; }});
    }
  };

  void check() {
    const auto listener =
        net.listen_tcp("127.0.0.1", 0, [&](std::shared_ptr<world::Stream> s) { far.start(s); }).value();
    const auto port = listener->port();
    REQUIRE(port != 0);
    const auto second = net.listen_tcp("127.0.0.1", port, [](std::shared_ptr<world::Stream>) {});
    REQUIRE_FALSE(second);
    CHECK(second.error().message() == "listen 127.0.0.1:" + std::to_string(port) + ": Address already in use");

    net.connect_tcp("127.0.0.1", port, [&](auto stream) { near.start(std::move(stream).value()); });
    until([&] { return near.started && far.started; });
    CHECK(near.stream->peer() == "127.0.0.1:" + std::to_string(port));
    CHECK(far.stream->peer().rfind("127.0.0.1:", 0) == 0);
    CHECK(far.stream->peer_uid() == 0xffffffffU);
    talk();
    refuse();
    local();
    loop();
  }

 private:
  void talk() {
    near.stream->write("hello ");
    near.stream->write("there");
    far.stream->write(std::string(100'000, 'x'));
    until([&] { return far.heard.size() == 11 && near.heard.size() == 100'000; });
    CHECK(far.heard == "hello there");
    // What was written before close still arrives, then the end; the closer hears nothing more.
    near.stream->write("bye");
    near.stream->close();
    near.stream->close();
    near.stream->write("never");
    until([&] { return !far.ended.empty(); });
    CHECK(far.heard == "hello therebye");
    CHECK(far.ended == "the peer closed the connection");
    CHECK(near.ended.empty());
    far.stream->write("nobody");
  }
  void refuse() {
    std::string problem;
    std::uint16_t dead = 0;
    dead = net.listen_tcp("127.0.0.1", 0, [](auto) {}).value()->port();  // closed at once
    net.connect_tcp("127.0.0.1", dead, [&](auto stream) { problem = stream ? "connected" : stream.error().message(); });
    until([&] { return !problem.empty(); });
    CHECK(problem == "connect 127.0.0.1:" + std::to_string(dead) + ": Connection refused");
    problem.clear();
    net.connect_unix(path, [&](auto stream) { problem = stream ? "connected" : stream.error().message(); });
    until([&] { return !problem.empty(); });
    CHECK(problem == "connect " + path + ": No such file or directory");
  }
  void local() {
    Ear caller, called;
    auto listener = net.listen_unix(path, 0660, [&](std::shared_ptr<world::Stream> s) { called.start(s); }).value();
    CHECK_FALSE(net.listen_unix(path, 0660, [](auto) {}));
    net.connect_unix(path, [&](auto stream) { caller.start(std::move(stream).value()); });
    until([&] { return caller.started && called.started; });
    CHECK(called.stream->peer_uid() != 0xffffffffU);
    CHECK(called.stream->peer().rfind("uid " + std::to_string(called.stream->peer_uid()) + " pid ", 0) == 0);
    // A handler may close its own stream.
    called.stream->close();
    until([&] { return !caller.ended.empty(); });
    // A peer that does not read cannot make us keep more than 1 MiB for it.
    Ear deaf;
    std::shared_ptr<world::Stream> silent;
    called = {};
    listener.reset();
    listener = net.listen_unix(path, 0660, [&](std::shared_ptr<world::Stream> s) { silent = std::move(s); }).value();
    net.connect_unix(path, [&](auto stream) { deaf.start(std::move(stream).value()); });
    until([&] { return deaf.started && silent; });
    for (int i = 0; i < 100 && deaf.ended.empty(); ++i) deaf.stream->write(std::string(64U << 10, 'y'));
    until([&] { return !deaf.ended.empty(); });
    CHECK(deaf.ended.find("1 MiB") != std::string::npos);
    silent->close();
  }
  void loop() {
    std::string order;
    net.post([&] {
      order += "a";
      net.post([&] { order += "c"; });
    });
    net.post([&] { order += "b"; });
    until([&] { return order.size() == 3; });
    CHECK(order == "abc");
  }
  world::Net& net;
  Until until;
  std::string path;
  Ear near, far;
};

}  // namespace glidehelm::test
