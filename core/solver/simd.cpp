#include "core/solver/simd.h"

#include <array>

namespace huestep {

namespace {

struct Named {
    Simd simd;
    std::string_view name;
};
constexpr std::array<Named, 7> names{{{Simd::Auto, "auto"},
                                      {Simd::Scalar, "scalar"},
                                      {Simd::Sse2, "sse2"},
                                      {Simd::Avx2, "avx2"},
                                      {Simd::Avx512, "avx512"},
                                      {Simd::Neon, "neon"},
                                      {Simd::Simd128, "simd128"}}};

}  // namespace

std::vector<Simd> availableSimd() {
    std::vector<Simd> found{Simd::Scalar};
#if defined(__x86_64__)
    found.push_back(Simd::Sse2);
    if (__builtin_cpu_supports("avx2")) found.push_back(Simd::Avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
        found.push_back(Simd::Avx512);
    }
#elif defined(__aarch64__)       // the NEON of 32-bit processors has no denormals
    found.push_back(Simd::Neon);
#elif defined(__wasm_simd128__)  // a module either has it or cannot be loaded
    found.push_back(Simd::Simd128);
#endif
    return found;
}

std::size_t widthIndex(Simd simd) {
    switch (simd) {
        case Simd::Auto:
            return widthIndex(availableSimd().back());
        case Simd::Scalar:
            return 0;
        case Simd::Sse2:
        case Simd::Neon:
        case Simd::Simd128:
            return 1;
        case Simd::Avx2:
            return 2;
        case Simd::Avx512:
            return 3;
    }
    return 0;
}

std::string_view nameOf(Simd simd) {
    for (const Named& n : names) {
        if (n.simd == simd) return n.name;
    }
    return "unknown";
}

std::optional<Simd> simdFromName(std::string_view name) {
    for (const Named& n : names) {
        if (n.name == name) return n.simd;
    }
    return std::nullopt;
}

}  // namespace huestep
