# WebAssembly beside this machine's own programs: Debian's clang 19 with wasi-libc and libc++, no
# exceptions, no threads, and nothing that a module would have to import.
#
#   huestep_wasm_objects(OUT NAME [SIMD] SOURCES...)   object files of these sources, in variable OUT
#   huestep_wasm_module(FILE OBJECTS...)               links them; what is exported, sources say
#
# Each file is a command of the one build, so that its jobs, its warnings as errors, its dependencies
# and ccache are those of all files; the warnings and float flags are the folder's own.
find_program(HUESTEP_WASM_CXX clang++-19)
find_program(HUESTEP_WASM_LD wasm-ld-19)
find_path(HUESTEP_WASM_LIBC stdlib.h PATHS /usr/include/wasm32-wasi NO_DEFAULT_PATH)
find_path(HUESTEP_WASM_LIBCXX ranges PATHS /usr/include/wasm32-wasi/c++/v1 NO_DEFAULT_PATH)
find_file(HUESTEP_WASM_BUILTINS libclang_rt.builtins-wasm32.a NO_DEFAULT_PATH
          PATHS /usr/lib/llvm-19/lib/clang/19/lib/wasi)
set(wasm_missing "")
foreach(part CXX=clang-19 LD=lld-19 LIBC=wasi-libc LIBCXX=libc++-19-dev-wasm32
             BUILTINS=libclang-rt-19-dev-wasm32)
  string(REPLACE "=" ";" part ${part})
  list(GET part 0 name)
  list(GET part 1 package)
  if(NOT HUESTEP_WASM_${name})
    string(APPEND wasm_missing " ${package}")
  endif()
endforeach()
if(wasm_missing)
  message(FATAL_ERROR
    "The core is compiled for browsers too, for which Debian's${wasm_missing} must be there: "
    "scripts/install build brings what is missing. With -DHUESTEP_WASM=OFF that part is left out.")
endif()

# The header alone: what stands beside it is this machine's.
find_file(HUESTEP_XXHASH_HEADER xxhash.h REQUIRED)
set(wasm_own ${CMAKE_BINARY_DIR}/wasm)
configure_file(${HUESTEP_XXHASH_HEADER} ${wasm_own}/include/xxhash.h COPYONLY)

get_property(wasm_flags DIRECTORY PROPERTY COMPILE_OPTIONS)
list(FILTER wasm_flags EXCLUDE REGEX
     "^-fsanitize|^-fno-sanitize|^-fno-omit|^-Wno-restrict|^-Wno-stringop|^-Wno-array")
# A size is 32 bits there, and so is the difference of two pointers: a 32-bit unsigned number that
# moves a pointer is warned of, though no block of memory is so large.
set(HUESTEP_WASM_FLAGS
  --target=wasm32-wasi -std=c++20 -O3 ${wasm_flags} -Wno-sign-conversion
  -fno-exceptions -fno-rtti -fno-threadsafe-statics
  # Debian's clang would look in this machine's /usr/include as well.
  -nostdlibinc -isystem ${HUESTEP_WASM_LIBCXX} -isystem ${HUESTEP_WASM_LIBC}
  -isystem ${wasm_own}/include -I${CMAKE_SOURCE_DIR}
  -isystem ${CMAKE_BINARY_DIR}/generated)  # the schemas' text, whose hash is in the fingerprint

function(huestep_wasm_objects out name)
  cmake_parse_arguments(ARG "SIMD" "" "" ${ARGN})
  set(objects "")
  set(flags ${HUESTEP_WASM_FLAGS})
  if(ARG_SIMD)
    list(APPEND flags -msimd128)
  endif()
  foreach(source ${ARG_UNPARSED_ARGUMENTS})
    file(RELATIVE_PATH path ${CMAKE_SOURCE_DIR} ${source})
    set(object ${wasm_own}/${name}/${path}.o)
    cmake_path(GET object PARENT_PATH folder)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(
      OUTPUT ${object}
      COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${HUESTEP_WASM_CXX} ${flags}
              -MD -MT ${object} -MF ${object}.d -c ${source} -o ${object}
      DEPENDS ${source} DEPFILE ${object}.d
      COMMENT "Building WebAssembly object ${name}/${path}" VERBATIM)
    list(APPEND objects ${object})
  endforeach()
  set(${out} ${objects} PARENT_SCOPE)
endfunction()

# Memory grows as worlds do, to 1 GiB at most.
function(huestep_wasm_module file)
  add_custom_command(
    OUTPUT ${file}
    COMMAND ${HUESTEP_WASM_CXX} --target=wasm32-wasi -mexec-model=reactor
            ${ARGN} -o ${file} -Wl,--strip-all -Wl,--max-memory=1073741824 -Wl,-z,stack-size=1048576
    DEPENDS ${ARGN}
    COMMENT "Linking WebAssembly module ${file}" VERBATIM COMMAND_EXPAND_LISTS)
endfunction()
