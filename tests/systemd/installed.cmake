# Installs a build into a folder of its own, as systemd/README.md tells, and holds what is there against systemd/installed.txt.
#   cmake -D BUILD=build/dev -D SOURCE=. -D PREFIX=FOLDER -P installed.cmake
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND ${CMAKE_COMMAND} --install "${BUILD}" --prefix "${PREFIX}" OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE found RELATIVE "${PREFIX}" "${PREFIX}/*")
file(STRINGS "${SOURCE}/systemd/installed.txt" expected)
file(READ "${PREFIX}/lib/systemd/system/glidehelmd.service" unit)
file(REMOVE_RECURSE "${PREFIX}")

set(missing ${expected})
list(REMOVE_ITEM missing ${found})
set(unexpected ${found})
list(REMOVE_ITEM unexpected ${expected})
if(missing OR unexpected)
  message(FATAL_ERROR "not as in systemd/installed.txt: missing: ${missing}; not expected: ${unexpected}")
endif()
# The unit starts the program that was installed with it.
foreach(key ExecStart ExecStartPre)
  string(FIND "${unit}" "\n${key}=${PREFIX}/bin/glidehelmd --config " at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${key} of the unit does not start ${PREFIX}/bin/glidehelmd")
  endif()
endforeach()
