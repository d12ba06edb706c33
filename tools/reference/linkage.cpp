#include "tools/reference/linkage.h"

#include <algorithm>
#include <cmath>

#include "core/scene/in_double.h"

namespace huestep::reference {
namespace {

Vec2d turned(double angle, Vec2d v) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// Solves A x = b for a symmetric positive definite A of b's size, by rows, in place: Cholesky.
void solveSymmetric(std::vector<double>& a, std::vector<double>& b) {
    const std::size_t n = b.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = j; i < n; ++i) {
            double sum = a[i * n + j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
            a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i * n + k] * b[k];
        b[i] /= a[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k * n + i] * b[k];
        b[i] /= a[i * n + i];
    }
}

std::size_t placeOf(const World& world, BodyId id) {
    return world.find(id).value();
}

}  // namespace

bool Linkage::hang(const World& start, const JointInfo& joint, std::size_t above,
                   std::size_t below) {
    const BodyInfo& body = start.bodies()[below];
    const BodyMotion& motion = start.motions()[below];
    const bool damped = body.linearDamping > 0.0f || body.angularDamping > 0.0f;
    if (!body.dynamic() || damped || !(body.inertia > 0.0f)) return false;
    const bool aboveIsA = joint.bodyA == start.bodies()[above].id;
    Link link;
    link.place = below;
    link.parent = m_linkOf[above];
    link.hook = inDouble(aboveIsA ? joint.anchorA : joint.anchorB);
    if (link.parent == none) {
        const BodyMotion& holder = start.motions()[above];
        link.hook =
            inDouble(holder.position) + rotate(normalized(inDouble(holder.rotation)), link.hook);
    }
    link.arm = inDouble(aboveIsA ? joint.anchorB : joint.anchorA);
    link.mass = static_cast<double>(body.mass);
    link.inertia = static_cast<double>(body.inertia);
    link.weight =
        link.mass * static_cast<double>(body.gravityScale) * inDouble(start.info().gravity);
    m_linkOf[below] = m_links.size();
    m_links.push_back(link);
    m_state.angle.push_back(
        std::atan2(static_cast<double>(motion.rotation.s), static_cast<double>(motion.rotation.c)));
    m_state.rate.push_back(static_cast<double>(motion.angularVelocity));
    return true;
}

std::optional<Linkage> Linkage::find(const World& start) {
    Linkage linkage;
    linkage.m_linkOf.assign(start.bodies().size(), none);
    std::vector<bool> reached;
    for (std::size_t i = 0; i < start.bodies().size(); ++i) {
        reached.push_back(start.bodies()[i].type() == BodyType::Static);
        linkage.m_fixed.push_back(inDouble(start.motions()[i].position));
    }
    // Joint after joint that leads from what is reached to what is not.
    std::vector<JointInfo> left(start.joints().begin(), start.joints().end());
    while (!left.empty()) {
        const auto leads = [&](const JointInfo& j) {
            return reached[placeOf(start, j.bodyA)] != reached[placeOf(start, j.bodyB)];
        };
        const auto next = std::find_if(left.begin(), left.end(), leads);
        if (next == left.end()) return std::nullopt;
        const std::uint32_t parts = JointInfo::spring | JointInfo::limit | JointInfo::motor;
        if (next->kind() != JointKind::Revolute || next->has(parts)) return std::nullopt;
        const std::size_t a = placeOf(start, next->bodyA);
        const std::size_t b = placeOf(start, next->bodyB);
        if (!linkage.hang(start, *next, reached[a] ? a : b, reached[a] ? b : a))
            return std::nullopt;
        reached[a] = reached[b] = true;
        left.erase(next);
    }
    if (std::find(reached.begin(), reached.end(), false) != reached.end()) return std::nullopt;
    return linkage;
}

std::vector<Vec2d> Linkage::centers(const std::vector<double>& angle) const {
    std::vector<Vec2d> result;
    for (std::size_t i = 0; i < m_links.size(); ++i) {
        const Link& link = m_links[i];
        Vec2d joint = link.hook;
        if (link.parent != none)
            joint = result[link.parent] + turned(angle[link.parent], link.hook);
        result.push_back(joint - turned(angle[i], link.arm));
    }
    return result;
}

/// M(θ) θ̈ = Σ Jᵀ (weight − m γ), where J holds the derivatives of a body's centre by all angles
/// and γ is its acceleration at θ̈ = 0.
std::vector<double> Linkage::accelerations(const State& at) const {
    const std::size_t n = m_links.size();
    std::vector<Vec2d> jacobian(n * n);  // row i: of the centre of link i
    std::vector<Vec2d> drift(n);         // γ
    std::vector<double> mass(n * n, 0.0);
    std::vector<double> force(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const Link& link = m_links[i];
        const Vec2d arm = turned(at.angle[i], link.arm);
        if (link.parent != none) {
            const std::size_t p = link.parent;
            const Vec2d hook = turned(at.angle[p], link.hook);
            for (std::size_t k = 0; k < n; ++k) jacobian[i * n + k] = jacobian[p * n + k];
            jacobian[i * n + p] += perpLeft(hook);
            drift[i] = drift[p] - (at.rate[p] * at.rate[p]) * hook;
        }
        jacobian[i * n + i] += -perpLeft(arm);
        drift[i] += (at.rate[i] * at.rate[i]) * arm;
        mass[i * n + i] += link.inertia;
        for (std::size_t r = 0; r < n; ++r) {
            force[r] += dot(jacobian[i * n + r], link.weight - link.mass * drift[i]);
            for (std::size_t c = 0; c < n; ++c)
                mass[r * n + c] += link.mass * dot(jacobian[i * n + r], jacobian[i * n + c]);
        }
    }
    solveSymmetric(mass, force);
    return force;
}

void Linkage::advance(double seconds, int steps) {
    const double h = seconds / steps;
    const std::size_t n = m_links.size();
    const auto moved = [&](const State& slope, const std::vector<double>& bend, double by) {
        State next = m_state;
        for (std::size_t i = 0; i < n; ++i) {
            next.angle[i] += by * slope.rate[i];
            next.rate[i] += by * bend[i];
        }
        return next;
    };
    for (int step = 0; step < steps; ++step) {
        const State a = m_state;
        const std::vector<double> ka = accelerations(a);
        const State b = moved(a, ka, 0.5 * h);
        const std::vector<double> kb = accelerations(b);
        const State c = moved(b, kb, 0.5 * h);
        const std::vector<double> kc = accelerations(c);
        const State d = moved(c, kc, h);
        const std::vector<double> kd = accelerations(d);
        for (std::size_t i = 0; i < n; ++i) {
            m_state.angle[i] += h / 6.0 * (a.rate[i] + 2.0 * (b.rate[i] + c.rate[i]) + d.rate[i]);
            m_state.rate[i] += h / 6.0 * (ka[i] + 2.0 * (kb[i] + kc[i]) + kd[i]);
        }
    }
}

Vec2d Linkage::position(std::size_t place) const {
    const std::size_t link = m_linkOf[place];
    return link == none ? m_fixed[place] : centers(m_state.angle)[link];
}

double Linkage::angle(std::size_t place) const {
    const std::size_t link = m_linkOf[place];
    return link == none ? 0.0 : m_state.angle[link];
}

double Linkage::energy() const {
    const std::vector<Vec2d> at = centers(m_state.angle);
    std::vector<Vec2d> velocity(m_links.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < m_links.size(); ++i) {
        const Link& link = m_links[i];
        if (link.parent != none) {
            const std::size_t p = link.parent;
            velocity[i] =
                velocity[p] + m_state.rate[p] * perpLeft(turned(m_state.angle[p], link.hook));
        }
        velocity[i] += -m_state.rate[i] * perpLeft(turned(m_state.angle[i], link.arm));
        sum += 0.5 * link.mass * lengthSquared(velocity[i]) +
               0.5 * link.inertia * m_state.rate[i] * m_state.rate[i] - dot(link.weight, at[i]);
    }
    return sum;
}

double Linkage::distanceTo(const Linkage& other) const {
    const std::vector<Vec2d> here = centers(m_state.angle);
    const std::vector<Vec2d> there = other.centers(other.m_state.angle);
    double most = 0.0;
    for (std::size_t i = 0; i < here.size(); ++i) most = std::max(most, length(here[i] - there[i]));
    return most;
}

LinkageSolution solveLinkage(const Linkage& start, double seconds, double tolerance) {
    constexpr int most = 1 << 20;
    LinkageSolution solution{start, 0.0, 64};
    solution.linkage.advance(seconds, solution.steps);
    do {
        Linkage finer = start;
        finer.advance(seconds, 2 * solution.steps);
        solution.change = finer.distanceTo(solution.linkage);
        solution.linkage = finer;
        solution.steps *= 2;
    } while (solution.change > tolerance && solution.steps < most);
    return solution;
}

}  // namespace huestep::reference
