/// The contact passes for every SIMD width this machine may have.
#pragma once

#include "core/solver/contact_block.h"
#include "core/solver/simd.h"

namespace huestep {

/// Kernels of a width that is available; `Auto` gives the widest. All give the same bits.
const ContactKernels& contactKernels(Simd simd);

}  // namespace huestep
