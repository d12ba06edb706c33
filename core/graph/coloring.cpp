#include "core/graph/coloring.h"

#include <bit>
#include <cassert>

namespace huestep {

void color(std::span<const ConstraintBodies> constraints, std::uint32_t bodyCount,
           std::vector<std::uint8_t>& colours) {
    struct Used {
        std::uint64_t moving = 0;
        std::uint64_t fixed = 0;
    };
    std::vector<Used> used(bodyCount);
    colours.resize(constraints.size(), 0);
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        const ConstraintBodies c = constraints[i];
        if (isHub(colours[i])) continue;
        assert(c.a >= 0 || c.b >= 0);
        if (c.a >= 0 && c.b >= 0) {
            Used& a = used[static_cast<std::size_t>(c.a)];
            Used& b = used[static_cast<std::size_t>(c.b)];
            const int first = std::countr_one(a.moving | b.moving);
            colours[i] = static_cast<std::uint8_t>(first);  // 64 is the overflow
            if (first == 64) continue;
            a.moving |= std::uint64_t{1} << first;
            b.moving |= std::uint64_t{1} << first;
        } else {
            Used& body = used[static_cast<std::size_t>(c.a >= 0 ? c.a : c.b)];
            const int first = std::countr_one(body.fixed);
            if (first == 64) {
                colours[i] = fixedOverflowColour;
            } else {
                colours[i] = static_cast<std::uint8_t>(firstFixedColour + first);
                body.fixed |= std::uint64_t{1} << first;
            }
        }
    }
}

}  // namespace huestep
