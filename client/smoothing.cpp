#include "client/smoothing.h"

#include <algorithm>
#include <cmath>

namespace huestep::client {

namespace {

constexpr float leastTurn = 1e-3f;  // rad

const ShownError* find(std::span<const ShownError> errors, BodyId body) {
    const auto at = std::lower_bound(errors.begin(), errors.end(), body,
                                     [](const ShownError& e, BodyId id) { return e.body < id; });
    return at != errors.end() && at->body == body ? &*at : nullptr;
}

}  // namespace

void Smoothing::shown(const World& world) {
    if (m_waiting) return;
    m_waiting = true;
    m_tick = world.tick();
    m_places.clear();
    const auto bodies = world.bodies();
    const auto motions = world.motions();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].type() == BodyType::Static) continue;
        m_places.push_back({bodies[i].id, bodies[i].owner, motions[i].pose()});
    }
}

float Smoothing::corrected(const World& world) {
    m_waiting = false;
    float largest = 0.0f;
    std::vector<ShownError> errors;
    const auto bodies = world.bodies();
    const auto motions = world.motions();
    auto before = m_places.begin();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        while (before != m_places.end() && before->body < bodies[i].id) ++before;
        if (before == m_places.end()) break;
        if (before->body != bodies[i].id || before->owner != bodies[i].owner) continue;
        ShownError error{bodies[i].id, before->pose.p - motions[i].position,
                         relative(motions[i].rotation, before->pose.q)};
        largest = std::max(largest, length(error.offset));
        // What was still hidden of earlier errors was shown too.
        if (const ShownError* old = find(m_errors, error.body)) {
            error.offset += old->offset;
            error.turn = compose(old->turn, error.turn);
        }
        if (worthHiding(error)) errors.push_back(error);
    }
    m_errors = std::move(errors);
    return largest;
}

void Smoothing::forget() {
    m_waiting = false;
    m_errors.clear();
}

bool Smoothing::worthHiding(const ShownError& error) const {
    const float distance = length(error.offset);
    const bool small = distance < m_rules.leastMetres && std::abs(error.turn.s) < leastTurn;
    return distance <= m_rules.mostMetres && error.turn.c > 0.0f && !small;
}

void Smoothing::decay(float seconds) {
    const float kept = std::exp(-seconds / m_rules.seconds);
    for (ShownError& error : m_errors) {
        error.offset = kept * error.offset;
        // On the chord from no turn to this one: of a turn below a quarter never near zero.
        error.turn = normalized(Rotation{1.0f + kept * (error.turn.c - 1.0f), kept * error.turn.s});
    }
    std::erase_if(m_errors, [this](const ShownError& error) { return !worthHiding(error); });
}

Pose Smoothing::posed(BodyId body, const Pose& pose) const {
    const ShownError* error = find(m_errors, body);
    if (!error) return pose;
    return {pose.p + error->offset, compose(error->turn, pose.q)};
}

}  // namespace huestep::client
