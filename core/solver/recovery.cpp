#include "core/solver/recovery.h"

#include <algorithm>
#include <cstring>

namespace huestep {

namespace {

void copyRow(const LaneRow& from, LaneRow& to) {
    std::memcpy(to, from, sizeof(LaneRow));
}

}  // namespace

void Recovery::keep(const Rows& rows, const Batch& batch) {
    m_velocities.clear();
    for (std::uint32_t place = batch.firstPlace; place < batch.endCopy; ++place) {
        const SolverBody& body = rows.bodies[place];
        m_velocities.push_back({body.vx, body.vy, body.w});
    }
    m_contacts.resize(batch.endBlock - batch.firstBlock);
    for (std::size_t i = 0; i < m_contacts.size(); ++i) {
        const ContactBlock& block = rows.blocks[batch.firstBlock + i];
        for (std::size_t k = 0; k < 2; ++k) {
            copyRow(block.points[k].normalImpulse, m_contacts[i].normal[k]);
            copyRow(block.points[k].tangentImpulse, m_contacts[i].tangent[k]);
        }
        copyRow(block.rollingImpulse, m_contacts[i].rolling);
    }
    m_joints.clear();
    for (std::uint32_t i = batch.firstJoint; i < batch.endJoint; ++i) {
        m_joints.push_back(rows.joints[i].impulses);
    }
    m_revolutes.assign(rows.revolutes.begin() + batch.firstRevoluteBlock,
                       rows.revolutes.begin() + batch.endRevoluteBlock);
}

void Recovery::restore(Rows& rows, const Batch& batch) const {
    for (std::size_t i = 0; i < m_velocities.size(); ++i) {
        SolverBody& body = rows.bodies[batch.firstPlace + i];
        body.vx = m_velocities[i].x;
        body.vy = m_velocities[i].y;
        body.w = m_velocities[i].w;
    }
    for (std::size_t i = 0; i < m_contacts.size(); ++i) {
        ContactBlock& block = rows.blocks[batch.firstBlock + i];
        for (std::size_t k = 0; k < 2; ++k) {
            copyRow(m_contacts[i].normal[k], block.points[k].normalImpulse);
            copyRow(m_contacts[i].tangent[k], block.points[k].tangentImpulse);
        }
        copyRow(m_contacts[i].rolling, block.rollingImpulse);
    }
    for (std::size_t i = 0; i < m_joints.size(); ++i) {
        rows.joints[batch.firstJoint + i].impulses = m_joints[i];
    }
    std::copy(m_revolutes.begin(), m_revolutes.end(),
              rows.revolutes.begin() + batch.firstRevoluteBlock);
}

}  // namespace huestep
