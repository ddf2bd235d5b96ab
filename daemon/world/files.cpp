#include "daemon/world/files.hpp"

#include <cstring>
#include <system_error>

namespace glidehelm::world {

std::string FileError::message() const { return operation + " " + path + ": " + std::generic_category().message(code); }

}  // namespace glidehelm::world
