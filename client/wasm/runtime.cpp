// The C library's last resorts without the files they write to: a module that imports nothing has
// no standard error. What they would say stays in the memory, and the instance stops.
#include <array>
#include <cstdlib>
#include <cstring>
#include <string>  // for the C++ library's own names

#include "client/wasm/exports.h"

namespace {

constinit std::array<char, 256> words{};

void append(const char* text) {
    const std::size_t at = std::strlen(words.data());
    std::strncpy(words.data() + at, text, words.size() - 1 - at);
}

void appendNumber(int number) {
    std::array<char, 12> digits{};
    char* first = digits.data() + digits.size() - 1;
    do {
        *--first = static_cast<char>('0' + number % 10);
        number /= 10;
    } while (number != 0);
    append(first);
}

}  // namespace

/// Of a failed assert; as the C library declares it.
extern "C" void __assert_fail(const char* expression, const char* file, int line, const char*) {
    append(file);
    append(":");
    appendNumber(line);
    append(": ");
    append(expression);
    __builtin_trap();
}

extern "C" void abort() {
    if (words[0] == '\0') append("the program gave up: most likely the memory is used up");
    __builtin_trap();
}

/// Of the C++ library's run time, likewise.
extern "C" __attribute__((noreturn)) void abort_message(const char* format, ...) {
    append(format);
    __builtin_trap();
}

/// Of a failed check of the C++ library; as it declares it.
_LIBCPP_BEGIN_NAMESPACE_STD
void __libcpp_verbose_abort(const char* format, ...) {
    append(format);
    __builtin_trap();
}
_LIBCPP_END_NAMESPACE_STD

namespace huestep::wasm {

/// Why the instance stopped, ended by a zero byte; empty if it has not.
HUESTEP_EXPORT(lastWords)()->const char* {
    return words.data();
}

}  // namespace huestep::wasm
