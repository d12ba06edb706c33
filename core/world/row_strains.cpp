#include "core/world/row_strains.h"

namespace huestep {

namespace {

float mostOf(const float (&lanes)[blockLanes], float most) {
    for (const float lane : lanes) most = maxOf(most, lane);
    return most;
}

}  // namespace

RowStrains::RowStrains(const World::Data& world, const Batch& batch)
    : m_plan(world.accelerators.plan), m_rows(world.accelerators.rows), m_batch(batch) {
    const float h = world.state.info().stepSeconds / static_cast<float>(batch.substeps);
    const RowFrequency frequency = rowFrequency(batch.substeps, batch.gentle, batch.large);
    m_contactFloor = softFloor(frequency.contact * rampShare(batch.ramp), h);
    m_jointFloor = softFloor(frequency.joint * rampShare(batch.ramp), h);
}

RowStrain RowStrains::most() const {
    RowStrain most;
    float contacts = 0.0f, revolutes = 0.0f;
    for (std::uint32_t block = m_batch.firstBlock; block < m_batch.endBlock; ++block) {
        contacts = mostOf(m_rows.blocks[block].strain, contacts);
    }
    for (std::uint32_t at = m_batch.firstRevoluteBlock; at < m_batch.endRevoluteBlock; ++at) {
        revolutes = mostOf(m_rows.revolutes[at].strain, revolutes);
    }
    for (std::uint32_t i = m_batch.firstJoint; i < m_batch.endJoint; ++i) {
        most = larger(most, ofJoint(m_rows.joints[i]));
    }
    return larger(most, {.contacts = m_contactFloor * contacts,
                         .swept = m_jointFloor * std::sqrt(revolutes)});
}

}  // namespace huestep
