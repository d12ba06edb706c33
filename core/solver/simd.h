/// SIMD widths: what a machine has, and kernels compiled once for each.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace huestep {

/// Which instructions the solver uses. Results are the same for all.
enum class Simd : std::uint8_t { Auto, Scalar, Sse2, Avx2, Avx512, Neon, Simd128 };

/// The widths this machine can run, narrowest first; `Auto` is not among them.
std::vector<Simd> availableSimd();
std::string_view nameOf(Simd simd);
/// Nothing for a name that is none of `nameOf`.
std::optional<Simd> simdFromName(std::string_view name);

/// Place of a width's kernels in a list that HUESTEP_EACH_WIDTH made; `Auto` is the widest there
/// is. Requires a width of `availableSimd()`, or `Auto`.
std::size_t widthIndex(Simd simd);

}  // namespace huestep

// HUESTEP_EACH_WIDTH(F) says F(W, attributes) for each number of lanes W that the processor family
// may have. `flatten` and `target` make always-inlined lane code wide in its entry function.
#if defined(__x86_64__)
#define HUESTEP_AVX2 __attribute__((target("avx2"), flatten, noinline))
#define HUESTEP_AVX512 \
    __attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"), flatten, noinline))
#define HUESTEP_EACH_WIDTH(F) F(1, ) F(4, ) F(8, HUESTEP_AVX2) F(16, HUESTEP_AVX512)
#elif defined(__wasm__) && !defined(__wasm_simd128__)
#define HUESTEP_EACH_WIDTH(F) F(1, )
#else
#define HUESTEP_EACH_WIDTH(F) F(1, ) F(4, )
#endif

// A pass over blocks of 16 lanes: name##W(bodies, blocks, count, pass) calls name##Lanes<W> for
// each W lanes up to `count`. Lanes past it in the last W are padding: no mass, no body.
#define HUESTEP_PASS(name, Block, Pass, W, attributes)                              \
    attributes void name##W(SolverBody* bodies, Block* blocks, std::uint32_t count, \
                            const Pass& pass) {                                     \
        for (std::uint32_t first = 0; first < count; first += W) {                  \
            name##Lanes<W>(bodies, blocks[first / blockLanes],                      \
                           static_cast<int>(first % blockLanes), pass);             \
        }                                                                           \
    }
