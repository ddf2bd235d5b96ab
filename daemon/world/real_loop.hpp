#pragma once

#include <utility>  // Boost 1.74's coroutine headers need it before them

#include <boost/asio/io_context.hpp>

namespace glidehelm::world {

/// The one event loop that the real clock, net and procs share. Single-threaded: only `post` crosses threads.
struct RealLoop {
  boost::asio::io_context context{1};
};

}  // namespace glidehelm::world
