#include "daemon/ingest/sandbox.hpp"

#include "daemon/world/confine.hpp"

namespace glidehelm::ingest {

Expected<Done, std::string> enter_sandbox(const std::string& output_folder, bool network) {
  world::Confinement order;
  order.read_below = {"/usr", "/lib", "/lib64", "/etc"};
#if defined(GLIDEHELM_SANITIZED_ADDRESS)
  order.read_below.emplace_back("/proc");  // where the search for leaks at the end looks for threads
#endif
  order.write_below = {output_folder};
  if (network) {
    order.read_below.emplace_back("/run/systemd/resolve");
    // libnetcdf's DAP client keeps cookies and answers there, and takes no other folder.
    order.read_below.emplace_back("/tmp");
    order.write_below.emplace_back("/tmp");
  }
  order.network = network;
  const auto confined = world::confine(order);
  if (!confined) return unexpected("the sandbox cannot be entered: " + confined.error());
  return Done{};
}

}  // namespace glidehelm::ingest
