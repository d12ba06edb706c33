# Installs what package-lock.json says into TO, unless it is there already.
file(MAKE_DIRECTORY ${TO})
file(SHA256 ${FROM}/package-lock.json wanted)
set(installed "")
if(EXISTS ${TO}/installed)
  file(READ ${TO}/installed installed)
endif()
if(installed STREQUAL wanted)
  message("packages: all there")
  return()
endif()
file(COPY ${FROM}/package.json ${FROM}/package-lock.json DESTINATION ${TO})
execute_process(
  COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund
  WORKING_DIRECTORY ${TO}
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "npm could not install the packages of tests/browser/package-lock.json")
endif()
file(WRITE ${TO}/installed ${wanted})
