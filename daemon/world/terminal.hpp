#pragma once

namespace glidehelm::world {

/// Whether a person looks at what is written to this descriptor (1 stdout, 2 stderr): a bar may then be drawn over itself.
bool is_terminal(int descriptor);

}  // namespace glidehelm::world
