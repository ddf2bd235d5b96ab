#pragma once

#include <string>
#include <string_view>

namespace glidehelm {

/// A stranger's text as one line that a log can take: control characters (line ends, escapes, NUL, DEL) become '?'. What
/// stands in a file's attributes cannot make lines of its own.
std::string one_line(std::string_view text);

}  // namespace glidehelm
