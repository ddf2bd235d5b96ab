#include <utility>

#include "core/safety/judge.hpp"

// Compiled, never linked (tests/CMakeLists.txt): with UNPROVEN it must not compile, without it must.

using namespace glidehelm::safety;

VerifiedFile file_to_emit(const Verdict& verdict);
VerifiedFile file_to_emit(const Verdict& verdict) {
#ifdef UNPROVEN
  return VerifiedFile{"goto_l10.ma", "bytes", verdict};
#else
  return accept("goto_l10.ma", "bytes", verdict).value();
#endif
}
