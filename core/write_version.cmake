# Writes the source with version and commit; run at every build, the file changes only with them.
# -DSOURCE_DIR=..., -DVERSION=..., -DINPUT=..., -DOUTPUT=...
set(COMMIT "unknown")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE hash RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(COMMIT ${hash})
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} diff --quiet HEAD RESULT_VARIABLE changed
      OUTPUT_QUIET ERROR_QUIET)
    if(changed)
      string(APPEND COMMIT "+changes")
    endif()
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
