# Writes OUT, a C++ source with texts as raw string literals, declared in tools/chart/assets.h.
# TEXTS: a list of name=file.
file(WRITE ${OUT}.new "// Made by tools/chart/embed.cmake.\n#include \"tools/chart/assets.h\"\n\n"
  "// Compilers need not take texts of this length; those that build this do.\n"
  "#pragma GCC diagnostic ignored \"-Woverlength-strings\"\n\n"
  "namespace huestep::tools::chart::assets {\n\nusing namespace std::string_view_literals;\n")
foreach(each ${TEXTS})
  string(REGEX MATCH "^([^=]+)=(.*)$" parts ${each})
  set(name ${CMAKE_MATCH_1})
  file(READ ${CMAKE_MATCH_2} text)
  file(APPEND ${OUT}.new "\nconst std::string_view ${name} = R\"huestepasset(")
  file(APPEND ${OUT}.new "${text}")
  file(APPEND ${OUT}.new ")huestepasset\"sv;\n")
endforeach()
file(APPEND ${OUT}.new "\n}  // namespace huestep::tools::chart::assets\n")
file(COPY_FILE ${OUT}.new ${OUT} ONLY_IF_DIFFERENT)
file(REMOVE ${OUT}.new)
