#pragma once

namespace glidehelm::world {

/// The version of this build, as CMake's project() says it.
const char* program_version();

}  // namespace glidehelm::world
