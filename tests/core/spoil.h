/// A fault on purpose: what desync reports are tested with. And limits that are not the standard
/// ones, to show what these do. No product has a door like it.
#pragma once

#include "core/world/world_data.h"

namespace huestep {

struct WorldSpoiler {
    /// Flips one bit of one field of `fieldsOf<BodyMotion>`; does nothing where there is none.
    static void flip(const World& world, BodyId body, std::uint32_t fieldIndex, std::uint32_t bit) {
        const auto place = world.m_data->findBody(body);
        if (!place || fieldIndex >= fieldsOf<BodyMotion>.size() || bit >= 32) return;
        auto* bytes = reinterpret_cast<std::byte*>(&world.m_data->state.motions[*place]);
        bytes[fieldsOf<BodyMotion>[fieldIndex].offset + bit / 8] ^= std::byte{1} << (bit % 8);
    }
    static void limitPlans(World& world, PlanLimits limits) {
        world.dropAccelerators();
        world.m_data->planLimits = limits;
    }
};

}  // namespace huestep
