#include <string>

#include "daemon/emitter.hpp"

// Compiled, never linked (tests/CMakeLists.txt): as it stands it must compile; with RAW_BYTES or MADE_BY_HAND it must not.

using namespace glidehelm;
using namespace glidehelm::daemon;

Emission emit_something(Emitter& emitter, const safety::Verdict& verdict, const EmissionOrder& order, Journal& journal,
                        const world::Clock& clock);
Emission emit_something(Emitter& emitter, const safety::Verdict& verdict, const EmissionOrder& order, Journal& journal,
                        const world::Clock& clock) {
#if defined(RAW_BYTES)
  return emitter.emit(std::string{"bytes"}, "staged", order, journal, clock);
#elif defined(MADE_BY_HAND)
  return emitter.emit(safety::VerifiedFile{"goto_l10.ma", "bytes", verdict}, "staged", order, journal, clock);
#else
  return emitter.emit(safety::accept("goto_l10.ma", "bytes", verdict).value(), "staged", order, journal, clock);
#endif
}
