/// The contact passes for every SIMD width this machine may have.
#pragma once

#include "core/solver/contact_block.h"
#include "core/solver/simd.h"

namespace huestep {

/// Kernels of a width that is available; `Auto` gives the widest. All give the same bits.
const ContactKernels& contactKernels(Simd simd);
const ContactLanePasses& contactLanePasses();

// Of pgs_kernels.cpp, for the list of kernels by width.
#define HUESTEP_DECLARE_PGS(W, attributes)                                                    \
    attributes void project##W(SolverBody* bodies, ContactBlock* blocks, std::uint32_t count, \
                               const ContactPass& pass);                                      \
    attributes void correct##W(SolverBody* bodies, ContactBlock* blocks, std::uint32_t count, \
                               const ContactPass& pass);
HUESTEP_EACH_WIDTH(HUESTEP_DECLARE_PGS)
#undef HUESTEP_DECLARE_PGS

}  // namespace huestep
