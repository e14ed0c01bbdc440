# cmake -DPROGRAM=verify -DLIST=FILE -P list_cases.cmake: asks the program for its fast cases and
# writes a file for ctest in which each is a test of its own name.
execute_process(COMMAND "${PROGRAM}" --list OUTPUT_VARIABLE cases RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "${PROGRAM} --list failed: ${failed}")
endif()
string(REGEX MATCHALL "[^\n]+" cases "${cases}")
set(text "")
foreach(case IN LISTS cases)
    string(APPEND text
        "add_test([[verification.${case}]] [[${PROGRAM}]] --only [[${case}]])\n"
        "set_tests_properties([[verification.${case}]] PROPERTIES TIMEOUT 600)\n")
endforeach()
file(WRITE "${LIST}" "${text}")
