#include "tools/metrics/pendulum.h"

#include <cmath>
#include <numbers>

#include "core/scene/in_double.h"

namespace huestep::tools {
namespace {

using Vec2d = Vec2T<double>;

/// The arithmetic-geometric mean by its own iteration, which converges quadratically.
double agm(double a, double b) {
    while (std::abs(a - b) > 1e-15 * a) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return a;
}

/// Where in [0, 1] the cubic with these ends and slopes is zero; the ends have opposite signs.
double zeroOfCubic(double from, double slopeFrom, double to, double slopeTo) {
    const auto cubic = [&](double t) {
        const double u = 1.0 - t;
        return (1.0 + 2.0 * t) * u * u * from + t * u * u * slopeFrom +
               t * t * (3.0 - 2.0 * t) * to - t * t * u * slopeTo;
    };
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        ((cubic(middle) < 0.0) == (from < 0.0) ? low : high) = middle;
    }
    return low;
}

bool swingsFreely(const BodyInfo& body, const BodyMotion& motion) {
    const bool undamped = body.linearDamping == 0.0f && body.angularDamping == 0.0f;
    const bool atRest = motion.velocity == Vec2{} && motion.angularVelocity == 0.0f;
    return body.dynamic() && undamped && atRest;
}

}  // namespace

std::optional<Pendulum> Pendulum::find(const World& start) {
    if (start.joints().size() != 1 || start.bodies().size() != 2) return std::nullopt;
    const JointInfo& joint = start.joints()[0];
    const std::uint32_t parts = JointInfo::spring | JointInfo::limit | JointInfo::motor;
    if (joint.kind() != JointKind::Revolute || joint.has(parts)) return std::nullopt;

    const std::size_t bob = start.bodies()[0].dynamic() ? 0 : 1;
    const std::size_t hook = 1 - bob;
    const BodyInfo& body = start.bodies()[bob];
    const BodyMotion& motion = start.motions()[bob];
    if (start.bodies()[hook].type() != BodyType::Static || !swingsFreely(body, motion))
        return std::nullopt;
    const bool bobIsA = joint.bodyA == body.id;

    Pendulum p;
    p.m_bob = bob;
    p.m_step = static_cast<double>(start.info().stepSeconds);
    p.m_mass = static_cast<double>(body.mass);
    p.m_inertia = static_cast<double>(body.inertia);
    p.m_length = length(inDouble(bobIsA ? joint.anchorA : joint.anchorB));
    const Vec2 anchor = bobIsA ? joint.anchorB : joint.anchorA;
    p.m_pivot = inDouble(transform(start.motions()[hook].pose(), anchor));
    const Vec2d gravity = static_cast<double>(body.gravityScale) * inDouble(start.info().gravity);
    p.m_gravity = length(gravity);
    p.m_down = normalized(gravity);
    if (!(p.m_length > 0.0) || !(p.m_gravity > 0.0)) return std::nullopt;

    p.m_lastAngle = p.angle(motion);
    p.m_startEnergy = p.energy(motion);
    const double equivalent = (p.m_inertia / p.m_mass + p.m_length * p.m_length) / p.m_length;
    p.m_exact = 2.0 * std::numbers::pi * std::sqrt(equivalent / p.m_gravity) /
                agm(1.0, std::cos(0.5 * p.m_lastAngle));
    return p;
}

double Pendulum::angle(const BodyMotion& bob) const {
    const Vec2d arm = inDouble(bob.position) - m_pivot;
    return std::atan2(cross(m_down, arm), dot(m_down, arm));
}

double Pendulum::rate(const BodyMotion& bob) const {
    const Vec2d arm = inDouble(bob.position) - m_pivot;
    return cross(arm, inDouble(bob.velocity)) / lengthSquared(arm);
}

double Pendulum::energy(const BodyMotion& bob) const {
    const auto spin = static_cast<double>(bob.angularVelocity);
    const double height = m_length - dot(m_down, inDouble(bob.position) - m_pivot);
    return m_mass * m_gravity * height + 0.5 * m_mass * lengthSquared(inDouble(bob.velocity)) +
           0.5 * m_inertia * spin * spin;
}

void Pendulum::watch(std::span<const BodyMotion> motions) {
    const double now = angle(motions[m_bob]);
    const double rateNow = rate(motions[m_bob]);
    // Angles and rates at both ends of the tick give the passage to fourth order. Far from the
    // lowest point a change of sign is the jump of atan2 at ±π.
    const bool low = std::abs(now) < 0.5 * std::numbers::pi;
    if (low && (now < 0.0) != (m_lastAngle < 0.0)) {
        const double part = zeroOfCubic(m_lastAngle, m_step * m_lastRate, now, m_step * rateNow);
        m_crossings.push_back(m_seconds + m_step * part);
    }
    m_lastAngle = now;
    m_lastRate = rateNow;
    m_seconds += m_step;
}

std::optional<PendulumResult> Pendulum::result(std::span<const BodyMotion> last) const {
    if (m_crossings.size() < 3) return std::nullopt;
    const std::size_t swings = (m_crossings.size() - 1) / 2;
    const double time = m_crossings[2 * swings] - m_crossings[0];
    PendulumResult result;
    result.period = time / static_cast<double>(swings);
    result.exact = m_exact;
    // From rest it passes after a quarter of its period, then every half.
    const double due = (0.25 + 0.5 * static_cast<double>(m_crossings.size() - 1)) * m_exact;
    result.phase = 2.0 * std::numbers::pi * (m_crossings.back() - due) / m_exact;
    result.energyLoss = (m_startEnergy - energy(last[m_bob])) / m_startEnergy;
    return result;
}

}  // namespace huestep::tools
