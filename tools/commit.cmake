# Writes commit.h with the commit that is being built; only if it changed, so that nothing is
# compiled again for nothing. Called at every build with OUT and SOURCE_DIR.
execute_process(COMMAND git describe --always --dirty --exclude=* WORKING_DIRECTORY ${SOURCE_DIR}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define HUESTEP_COMMIT \"${commit}\"\n")
