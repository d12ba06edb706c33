/// SIMD lanes by vector extensions: W floats that are worked on side by side.
///
/// Every operation is the IEEE operation of a single float in each lane, so results do not depend
/// on W. There is no fused multiply-add, no approximate reciprocal; minimum and maximum are a
/// compare and a select. `Lanes<1>` is plain float: the scalar build of the same source.
///
/// Code that uses Lanes<8> or Lanes<16> is always inlined into an entry function with a `target`
/// attribute, so one translation unit holds all widths and no other unit needs -m flags.
#pragma once

#include <cstdint>

#define HUESTEP_INLINE __attribute__((always_inline)) inline

// Wide vectors never cross a real call here, so the calling convention they would change is unused.
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace huestep {

template <int W>
struct Lanes;

template <>
struct Lanes<1> {
    using F = float;
    using Mask = bool;
};
template <>
struct Lanes<4> {
    typedef float F __attribute__((vector_size(16)));
    typedef std::int32_t Mask __attribute__((vector_size(16)));
};
template <>
struct Lanes<8> {
    typedef float F __attribute__((vector_size(32)));
    typedef std::int32_t Mask __attribute__((vector_size(32)));
};
template <>
struct Lanes<16> {
    typedef float F __attribute__((vector_size(64)));
    typedef std::int32_t Mask __attribute__((vector_size(64)));
};

template <int W>
using LaneF = typename Lanes<W>::F;

template <int W>
HUESTEP_INLINE LaneF<W> loadLanes(const float* from) {
    typedef LaneF<W> Unaligned __attribute__((aligned(4), may_alias));
    return *reinterpret_cast<const Unaligned*>(from);
}

template <int W>
HUESTEP_INLINE void storeLanes(float* to, const LaneF<W>& v) {
    typedef LaneF<W> Unaligned __attribute__((aligned(4), may_alias));
    *reinterpret_cast<Unaligned*>(to) = v;
}

/// All lanes the same, as integers: of `x − LaneF<16>{}` g++ 12 makes sixteen masked moves one
/// after another where x lies in memory.
template <int W>
HUESTEP_INLINE LaneF<W> splat(float x) {
    if constexpr (W == 1) {
        return x;
    } else {
        typedef typename Lanes<W>::Mask Bits;
        return __builtin_bit_cast(LaneF<W>, __builtin_bit_cast(std::int32_t, x) - Bits{});
    }
}

/// A mask of numbers that are 0 or not, W of them; of more than one lane they are 0 or −1.
template <int W>
HUESTEP_INLINE typename Lanes<W>::Mask loadMask(const std::int32_t* from) {
    if constexpr (W == 1) {
        return *from != 0;
    } else {
        typedef typename Lanes<W>::Mask Unaligned __attribute__((aligned(4), may_alias));
        return *reinterpret_cast<const Unaligned*>(from);
    }
}

/// The other sign, of zeros too.
template <int W>
HUESTEP_INLINE LaneF<W> negated(const LaneF<W>& v) {
    return -v;
}

HUESTEP_INLINE float selectLanes(bool mask, float yes, float no) {
    return mask ? yes : no;
}

template <class Mask, class F>
HUESTEP_INLINE F selectLanes(const Mask& mask, const F& yes, const F& no) {
    return mask ? yes : no;
}

HUESTEP_INLINE bool both(bool a, bool b) {
    return a && b;
}
template <class Mask>
HUESTEP_INLINE Mask both(const Mask& a, const Mask& b) {
    return a & b;
}
HUESTEP_INLINE bool either(bool a, bool b) {
    return a || b;
}
template <class Mask>
HUESTEP_INLINE Mask either(const Mask& a, const Mask& b) {
    return a | b;
}

HUESTEP_INLINE bool allSet(const Lanes<4>::Mask& mask) {
#if defined(__SSE2__)
    typedef float Bits __attribute__((vector_size(16)));
    return __builtin_ia32_movmskps(reinterpret_cast<const Bits&>(mask)) == 15;
#else
    typedef std::int64_t Halves __attribute__((vector_size(16), may_alias));
    const Halves halves = reinterpret_cast<const Halves&>(mask);
    return (halves[0] & halves[1]) == -1;
#endif
}

/// −1 where the mask is set, 0 elsewhere.
template <int W>
HUESTEP_INLINE void storeMask(std::int32_t* to, const typename Lanes<W>::Mask& mask) {
    if constexpr (W == 1) {
        *to = mask ? -1 : 0;
    } else {
        typedef typename Lanes<W>::Mask Unaligned __attribute__((aligned(4), may_alias));
        *reinterpret_cast<Unaligned*>(to) = mask;
    }
}

template <class F>
HUESTEP_INLINE F maxLanes(const F& a, const F& b) {
    return selectLanes(a > b, a, b);
}
template <class F>
HUESTEP_INLINE F minLanes(const F& a, const F& b) {
    return selectLanes(a < b, a, b);
}

/// What `to` is more than `from`: nothing where they are the same, and be they infinite, whose
/// difference is no number. A pass that does not concern a body must not be seen in it, for whether
/// the pass is made depends on what else is in the batch.
template <int W>
HUESTEP_INLINE LaneF<W> changeOf(const LaneF<W>& from, const LaneF<W>& to) {
    return selectLanes(to == from, LaneF<W>{}, to - from);
}

}  // namespace huestep
