#pragma once

#include <string_view>

namespace glidehelm::world {

/// Named steps at which a test may end the process as a crash would: with GLIDEHELM_FAILPOINT=STEP the process sends
/// itself SIGKILL when it comes to STEP, with STEP@N the N-th time. Without the variable a call costs one look at the
/// environment. Called from the loop's thread only.
/// Steps, in the order of a surfacing: first_byte, surfacing_recorded, planned, staged, verified, before_intent,
/// after_intent, before_rename, after_rename, after_folder_sync, before_committed, after_committed.
void failpoint(std::string_view step);

}  // namespace glidehelm::world
