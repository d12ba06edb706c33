#include "tools/metrics/ballistic.h"

#include "core/scene/in_double.h"

namespace huestep::tools {
namespace {

using Vec2d = Vec2T<double>;

constexpr double flight = 1.0;  // s

}  // namespace

std::optional<Ballistic> Ballistic::find(const World& start) {
    if (!start.joints().empty()) return std::nullopt;
    Ballistic b;
    b.m_step = static_cast<double>(start.info().stepSeconds);
    for (std::size_t i = 0; i < start.bodies().size(); ++i) {
        const BodyInfo& body = start.bodies()[i];
        if (!body.dynamic()) continue;
        if (body.linearDamping > 0.0f) return std::nullopt;
        const BodyMotion& motion = start.motions()[i];
        if (motion.asleep()) return std::nullopt;  // something holds it, or it would fall
        b.m_bodies.push_back(
            {i, inDouble(motion.position), inDouble(motion.velocity),
             static_cast<double>(body.gravityScale) * inDouble(start.info().gravity)});
    }
    if (b.m_bodies.empty()) return std::nullopt;
    return b;
}

void Ballistic::watch(std::span<const BodyMotion> motions, bool touching) {
    // Half a tick of tolerance: sixty steps of float(1/60) are not one second to the last bit.
    if (m_touched || m_seconds + 0.5 * m_step > flight) return;
    m_touched = touching;
    m_seconds += m_step;
    const double t = m_seconds;
    m_result = {t, 0.0};
    for (const Body& body : m_bodies) {
        const Vec2d exact = body.position + t * body.velocity + (0.5 * t * t) * body.gravity;
        const double error = length(inDouble(motions[body.place].position) - exact);
        if (!(error <= m_result.maxError)) m_result.maxError = error;  // nor is NaN passed over
    }
}

std::optional<BallisticResult> Ballistic::result() const {
    if (m_touched || m_seconds == 0.0) return std::nullopt;
    return m_result;
}

}  // namespace huestep::tools
