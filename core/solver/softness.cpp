#include "core/solver/contact_block.h"

namespace huestep {

Softness softness(float hertz, float dampingRatio, float h) {
    if (!(hertz > 0.0f)) return {0.0f, 1.0f, 0.0f};
    const float omega = 6.28318530718f * hertz;
    const float a1 = 2.0f * dampingRatio + h * omega;
    const float a2 = h * omega * a1;
    const float a3 = 1.0f / (1.0f + a2);
    return {omega / a1, a2 * a3, a3};
}

}  // namespace huestep
