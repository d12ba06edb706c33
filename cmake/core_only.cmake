# What the core and its tests take from outside, for any processor: xxHash is all in its header, and
# GoogleTest is compiled from where Debian puts its source. No library of this machine is linked.

# The header alone: beside it stand those of this machine's own libraries.
find_file(HUESTEP_XXHASH_HEADER xxhash.h REQUIRED NO_CMAKE_FIND_ROOT_PATH)
configure_file(${HUESTEP_XXHASH_HEADER} ${CMAKE_BINARY_DIR}/xxhash/xxhash.h COPYONLY)
add_library(huestep_xxhash INTERFACE)
target_include_directories(huestep_xxhash SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/xxhash)
add_library(PkgConfig::XXHASH ALIAS huestep_xxhash)

if(HUESTEP_TESTS)
  find_path(HUESTEP_GTEST_SOURCE src/gtest-all.cc REQUIRED NO_CMAKE_FIND_ROOT_PATH
            PATHS /usr/src/googletest/googletest)
  add_library(huestep_gtest STATIC ${HUESTEP_GTEST_SOURCE}/src/gtest-all.cc
                                   ${HUESTEP_GTEST_SOURCE}/src/gtest_main.cc)
  target_include_directories(huestep_gtest SYSTEM PUBLIC ${HUESTEP_GTEST_SOURCE}/include
                                                  PRIVATE ${HUESTEP_GTEST_SOURCE})
  target_compile_options(huestep_gtest PRIVATE -w)
  target_link_libraries(huestep_gtest PUBLIC Threads::Threads)
  add_library(GTest::gtest_main ALIAS huestep_gtest)
endif()
