#include "daemon/ingest/sandbox.hpp"

#include "daemon/world/confine.hpp"

namespace glidehelm::ingest {

Expected<Done, std::string> enter_sandbox(const std::string& output_folder, bool network) {
  world::Confinement order;
  order.read_below = {"/usr", "/lib", "/lib64", "/etc", "/dev/urandom"};
  if (network) order.read_below.emplace_back("/run/systemd/resolve");
  order.write_below = {output_folder};
  order.network = network;
  const auto confined = world::confine(order);
  if (!confined) return unexpected("the sandbox cannot be entered: " + confined.error());
  return Done{};
}

}  // namespace glidehelm::ingest
