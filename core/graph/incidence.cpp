#include "core/graph/incidence.h"

namespace huestep {

Incidence incidenceOf(std::span<const ConstraintBodies> joints,
                      std::span<const ConstraintBodies> revoluteLanes,
                      std::span<const ConstraintBodies> contactLanes, std::uint32_t placeCount) {
    Incidence result;
    result.joints = static_cast<std::uint32_t>(joints.size());
    result.revoluteLanes = static_cast<std::uint32_t>(revoluteLanes.size());
    result.contactLanes = static_cast<std::uint32_t>(contactLanes.size());
    const auto overSides = [&](auto&& f) {
        std::uint32_t slot = 0;
        for (const auto& rows : {joints, revoluteLanes, contactLanes}) {
            for (const ConstraintBodies& bodies : rows) {
                if (bodies.a >= 0 && bodies.a != bodies.b) f(bodies.a, slot);
                if (bodies.b >= 0) f(bodies.b, slot + 1);
                slot += 2;
            }
        }
    };
    result.first.assign(placeCount + 1, 0);
    overSides([&](BodyPlace place, std::uint32_t) {
        ++result.first[static_cast<std::size_t>(place) + 1];
    });
    for (std::uint32_t i = 0; i < placeCount; ++i) result.first[i + 1] += result.first[i];
    std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
    result.touches.resize(result.first.back());
    overSides([&](BodyPlace place, std::uint32_t slot) {
        result.touches[next[static_cast<std::size_t>(place)]++] = slot;
    });
    return result;
}

}  // namespace huestep
