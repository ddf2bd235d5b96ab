# Warnings are errors, in one place. Determinism: no contraction, no fast-math, no -march=native.
function(glidehelm_flags target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror
    -ffp-contract=off -fno-fast-math)
  # g++ 12 takes appending one std::string to another for overlapping copies at -O3 (GCC bug 105329).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  # Sanitizers keep g++ from seeing that std::variant and std::regex set what they read: this warning is then noise.
  if(GLIDEHELM_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
  endif()
endfunction()
