# Warnings are errors, in one place. Determinism: no contraction, no fast-math, no -march=native.
function(glidehelm_flags target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror
    -ffp-contract=off -fno-fast-math)
endfunction()
