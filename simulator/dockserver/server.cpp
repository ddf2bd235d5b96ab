#include "simulator/dockserver/server.hpp"

#include <chrono>

namespace glidehelm::simulator {
namespace {

constexpr std::chrono::milliseconds kRedialAfter{200};

}  // namespace

DialogLine::DialogLine(world::Net& net, world::Clock& wall, LineAddress address, Told told)
    : net_{net}, wall_{wall}, address_{std::move(address)}, told_{std::move(told)} {}

DialogLine::~DialogLine() { close(); }

Expected<Done, world::NetError> DialogLine::start() {
  if (address_.connect) {
    dial();
    return Done{};
  }
  std::weak_ptr<int> alive = alive_;
  auto listener = net_.listen_tcp(address_.host, address_.port, [this, alive](std::shared_ptr<world::Stream> stream) {
    if (!alive.expired()) adopt(std::move(stream));
  });
  if (!listener) return unexpected(listener.error());
  listener_ = std::move(*listener);
  return Done{};
}

void DialogLine::dial() {
  std::weak_ptr<int> alive = alive_;
  net_.connect_tcp(address_.host, address_.port,
                   [this, alive](Expected<std::shared_ptr<world::Stream>, world::NetError> answer) {
                     if (alive.expired() || closed_ || stream_) return;
                     if (answer) {
                       complained_ = false;
                       return adopt(*answer);
                     }
                     if (!complained_ && told_.said) told_.said(answer.error().message() + "; trying again");
                     complained_ = true;
                     wall_.call_at(wall_.tick() + kRedialAfter, [this, alive] {
                       if (!alive.expired() && !closed_ && !stream_) dial();
                     });
                   });
}

void DialogLine::adopt(std::shared_ptr<world::Stream> stream) {
  if (stream_) stream_->close();  // the newest connection is the glider's line
  stream_ = std::move(stream);
  on_stream_ = 0;
  std::weak_ptr<int> alive = alive_;
  // Nothing is expected from the daemon: it never writes into a dialog. A stream that is not the current one any more
  // has nothing to say.
  const auto* mine = stream_.get();
  stream_->start({[](std::string_view) {},
                  [this, alive, mine](std::string_view reason) {
                    if (!alive.expired() && stream_.get() == mine) lost(reason);
                  }});
  if (told_.changed) told_.changed();
}

void DialogLine::lost(std::string_view reason) {
  stream_.reset();
  if (closed_) return;
  if (told_.said) told_.said("the line to the daemon ended: " + std::string{reason});
  if (told_.changed) told_.changed();
  if (address_.connect) dial();
}

void DialogLine::write(std::string bytes) {
  total_ += bytes.size();
  if (!stream_) return;
  on_stream_ += bytes.size();
  stream_->write(std::move(bytes));
}

void DialogLine::drop() {
  if (!stream_) return;
  stream_->close();
  stream_.reset();
  if (told_.changed) told_.changed();
  if (address_.connect) dial();
}

void DialogLine::abandon() {
  if (!address_.connect) return drop();
  if (!stream_) return;
  if (abandoned_) abandoned_->close();
  abandoned_ = std::move(stream_);
  stream_.reset();
  if (told_.changed) told_.changed();
  dial();
}

void DialogLine::close() {
  closed_ = true;
  listener_.reset();
  if (abandoned_) abandoned_->close();
  abandoned_.reset();
  if (stream_) stream_->close();
  stream_.reset();
}

}  // namespace glidehelm::simulator
