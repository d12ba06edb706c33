#include "tools/floats.h"

#include <limits>

namespace huestep::tools {

Status checkFloats() {
    // volatile: the compiler must neither fold these nor see through them.
    volatile float smallest = std::numeric_limits<float>::min();
    volatile float half = 0.5f;
    const volatile float denormal = smallest * half;
    const volatile float restored = denormal + denormal;
    if (!(denormal > 0.0f) || restored != smallest)
        return Error{
            "this process flushes denormal numbers to zero, so its results would differ "
            "from other machines'; look for a library built with -ffast-math"};
    // (1 + e)(1 − e) is 1 − e² exactly, and 1 once rounded: a fused operation leaves −e² behind.
    volatile float e = std::numeric_limits<float>::epsilon();
    const float above = 1.0f + e;
    const float below = 1.0f - e;
    const float left = above * below - 1.0f;
    if (left != 0.0f)
        return Error{
            "this program was built with fused multiply-add; build it by the presets of "
            "CMakePresets.json, which switch that off"};
    return Done{};
}

}  // namespace huestep::tools
