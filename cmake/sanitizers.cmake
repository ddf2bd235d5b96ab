# -DGLIDEHELM_SANITIZE=address,undefined (or thread) instruments everything that the project builds.
if(GLIDEHELM_SANITIZE)
  add_compile_options(-fsanitize=${GLIDEHELM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${GLIDEHELM_SANITIZE})
  # g++ and clang say each in its own way that they sanitize; the few places that have to know read this.
  add_compile_definitions(GLIDEHELM_SANITIZED)
  if(GLIDEHELM_SANITIZE MATCHES "address")
    add_compile_definitions(GLIDEHELM_SANITIZED_ADDRESS)
  endif()
  if(GLIDEHELM_SANITIZE MATCHES "thread")
    # ThreadSanitizer does not know Asio's bare fences; the queue's mutex orders what they order.
    add_compile_definitions(BOOST_ASIO_DISABLE_FENCED_BLOCK)
  endif()
  if(GLIDEHELM_SANITIZE MATCHES "undefined")
    add_compile_options(-fsanitize=float-divide-by-zero,float-cast-overflow)
  endif()
endif()
# The rooms carry libFuzzer's coverage counters, so that it learns from the code under test; only targets link its main.
if(GLIDEHELM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
# Under a sanitizer only what computes for long is optimized (docs/decisions/033): clang takes 20 times as long over config's tables with -O1.
macro(glidehelm_optimize_sanitized)
  if(GLIDEHELM_SANITIZE)
    add_compile_options(-O1)
  endif()
endmacro()
