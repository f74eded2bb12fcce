# Writes LIST, a file for ctest with one test a suite of PROGRAM, a program of GoogleTest. COSTS: a line `suite | seconds | reason` for each
# slow suite; ctest begins with the longest, so that no core waits at the end.
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS "${COSTS}" costs REGEX "^[^#].* \\| ")
set(tests "")
string(REGEX REPLACE "#[^\n]*" "" listed "${listed}")  # values of parameters
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^([A-Za-z0-9_/]+)\\. *$")  # indented: a case; else what the main function says
    continue()
  endif()
  set(suite "${CMAKE_MATCH_1}")
  string(APPEND tests "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n")
  foreach(cost IN LISTS costs)
    if(cost MATCHES "^([^ ]+) +\\| +([0-9]+) " AND CMAKE_MATCH_1 STREQUAL suite)
      string(APPEND tests "set_tests_properties([=[${suite}]=] PROPERTIES COST ${CMAKE_MATCH_2})\n")
    endif()
  endforeach()
endforeach()
if(tests STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} has no suite")
endif()
file(WRITE "${LIST}" "${tests}")
