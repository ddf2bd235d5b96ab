#include "daemon/line.hpp"

#include <algorithm>

namespace glidehelm::daemon {

namespace {
constexpr Seconds kFirstBackOff{1};
constexpr Seconds kLongestBackOff{300};

/// "192.0.2.7" of "192.0.2.7:53124", "::1" of "[::1]:53124".
std::string_view host_of(std::string_view peer) {
  auto host = peer.substr(0, peer.rfind(':'));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  return host;
}
}  // namespace

Line::Line(world::World world, config::Line line, Handlers handlers)
    : world_{world}, line_{std::move(line)}, handlers_{std::move(handlers)}, alive_{std::make_shared<bool>(true)} {}

Line::~Line() {
  *alive_ = false;
  world_.clock.cancel(redial_);
  if (stream_) stream_->close();
}

Expected<Done, world::NetError> Line::start() {
  if (const auto* listen = std::get_if<config::Listen>(&line_)) {
    auto listener = world_.net.listen_tcp(listen->at.host, listen->at.port,
                                          [this, alive = alive_](std::shared_ptr<world::Stream> stream) {
                                            if (*alive) take(std::move(stream));
                                          });
    if (!listener) return unexpected(listener.error());
    listener_ = std::move(listener).value();
  } else {
    dial();
  }
  return Done{};
}

void Line::take(std::shared_ptr<world::Stream> stream) {
  if (const auto* listen = std::get_if<config::Listen>(&line_);
      listen != nullptr && !listen->lets_in(host_of(stream->peer()))) {
    handlers_.trouble("connection from " + stream->peer() + " is not in `allow`: closed");
    stream->close();
    return;
  }
  const bool replaced = stream_ != nullptr;
  if (replaced) {
    stream_->close();
    handlers_.closed(connection_, "replaced by a newer connection");
  }
  stream_ = std::move(stream);
  back_off_ = kFirstBackOff;
  last_trouble_.clear();
  const auto connection = ++connection_;
  handlers_.opened(connection, stream_->peer(), replaced);
  stream_->start({[this, connection, alive = alive_](std::string_view bytes) {
                    if (*alive && connection == connection_) handlers_.bytes(connection, bytes);
                  },
                  [this, connection, alive = alive_](std::string_view reason) {
                    if (*alive) lost(connection, reason);
                  }});
}

void Line::lost(std::uint64_t connection, std::string_view reason) {
  if (connection != connection_ || !stream_) return;
  stream_.reset();
  handlers_.closed(connection, reason);
  if (std::holds_alternative<config::Connect>(line_)) dial_later();
}

void Line::drop(std::string_view reason) {
  if (!stream_) return;
  stream_->close();
  lost(connection_, reason);
}

void Line::dial() {
  const auto& connect = std::get<config::Connect>(line_);
  world_.net.connect_tcp(connect.to.host, connect.to.port,
                         [this, alive = alive_](Expected<std::shared_ptr<world::Stream>, world::NetError> stream) {
                           if (!*alive) return;
                           if (stream) {
                             take(std::move(stream).value());
                             return;
                           }
                           if (stream.error().message() != last_trouble_) handlers_.trouble(stream.error().message());
                           last_trouble_ = stream.error().message();
                           dial_later();
                         });
}

void Line::dial_later() {
  const double jitter = 0.8 + 0.4 * (static_cast<double>(world_.rng.next() >> 11) * 0x1p-53);
  const auto wait = std::chrono::duration_cast<Tick::duration>(back_off_ * jitter);
  back_off_ = std::min(2 * back_off_, kLongestBackOff);
  redial_ = world_.clock.call_at(world_.clock.tick() + wait, [this, alive = alive_] {
    if (*alive) dial();
  });
}

}  // namespace glidehelm::daemon
