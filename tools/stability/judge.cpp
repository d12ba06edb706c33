#include "tools/stability/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/in_double.h"
#include "core/scene/measure.h"
#include "tools/stability/measures.h"
#include "tools/text.h"

namespace huestep::tools::stability {

namespace {

constexpr double hopelessShare = 10.0;  // of a limit, beyond which a run is given up

bool finite(const BodyMotion& motion) {
    for (const float value :
         {motion.position.x, motion.position.y, motion.rotation.c, motion.rotation.s,
          motion.velocity.x, motion.velocity.y, motion.angularVelocity})
        if (!std::isfinite(value)) return false;
    return true;
}

/// The pose of a centre of mass in the scene's own frame.
Posed ownPose(const Posed& frame, const BodyMotion& motion) {
    const Posed pose{inDouble(motion.position), normalized(inDouble(motion.rotation))};
    return relative(frame, pose);
}

std::string secondsText(std::uint64_t tick, double stepSeconds) {
    return number(static_cast<double>(tick) * stepSeconds) + " s";
}

enum class Among { Failing, All };

/// The criterion furthest beyond its limit, or nearest to it; null of none. `cut`: the run ended
/// early, so that one whose window never came says nothing.
const Watch* extreme(const std::vector<Watch>& watches, Among among, bool cut) {
    const Watch* found = nullptr;
    for (const Watch& watch : watches) {
        if (cut && !watch.looked()) continue;
        if (among == Among::Failing && watch.holds()) continue;
        if (found == nullptr || watch.share() > found->share()) found = &watch;
    }
    return found;
}

}  // namespace

Criterion speedRule() {
    return {"fastest body", "m/s", 100.0, fastest};
}

Criterion energyRule() {
    return {"energy above the start's, of weight times extent", "1", 0.01, energyGain};
}

Judge::Judge(const World& start, const Placement& placement, std::vector<Criterion> own,
             std::vector<Criterion> rules)
    : m_definitions(start),
      m_frame(frameOf(placement)),
      m_stepSeconds(static_cast<double>(start.info().stepSeconds)),
      m_energyScale(energyScale(start.info(), start.bodies(), start.motions())),
      m_startEnergy(energyOf(start.info(), start.bodies(), start.motions())) {
    for (Criterion& criterion : own) m_own.emplace_back(std::move(criterion));
    for (Criterion& criterion : rules) m_rules.emplace_back(std::move(criterion));
    for (std::size_t i = 0; i < start.bodies().size(); ++i) {
        const BodyInfo& info = start.bodies()[i];
        const BodyMotion& motion = start.motions()[i];
        Tracked body;
        body.id = info.id;
        body.dynamic = info.dynamic();
        body.mass = static_cast<double>(info.mass);
        body.inertia = static_cast<double>(info.inertia);
        body.start = body.now = ownPose(m_frame, motion);
        body.startVelocity = body.velocity = unrotate(m_frame.q, inDouble(motion.velocity));
        body.startSpin = body.spin = static_cast<double>(motion.angularVelocity);
        m_bodies.push_back(body);
    }
}

void Judge::follow(std::span<const BodyMotion> motions) {
    // Both lists are by id; what came later is not followed, what went is dropped.
    std::size_t kept = 0;
    std::size_t place = 0;
    const std::span<const BodyInfo> there = m_definitions.bodies();
    for (Tracked& body : m_bodies) {
        while (place < there.size() && there[place].id < body.id) ++place;
        if (place == there.size() || there[place].id != body.id) continue;
        const BodyMotion& motion = motions[place];
        body.now = ownPose(m_frame, motion);
        body.velocity = unrotate(m_frame.q, inDouble(motion.velocity));
        body.spin = static_cast<double>(motion.angularVelocity);
        m_bodies[kept++] = body;
    }
    m_bodies.resize(kept);
}

void Judge::lose(std::uint64_t tick, const std::string& why) {
    if (!m_lost.empty()) return;
    m_lost = why + " after " + secondsText(tick, m_stepSeconds);
    m_hopeless = m_broken = true;
    m_lostAt = tick;
}

void Judge::lost(std::uint64_t tick, BodyId body) {
    lose(tick, "body " + std::to_string(body) + " left the world or the numbers");
}

void Judge::watch(std::uint64_t tick, std::span<const Command> commands,
                  std::span<const BodyMotion> motions) {
    m_definitions.apply(commands);
    for (std::size_t i = 0; i < motions.size(); ++i)
        if (!finite(motions[i]))
            lose(tick, "body " + std::to_string(m_definitions.bodies()[i].id) + " is not finite");
    if (!m_lost.empty()) return;
    follow(motions);
    Moment moment{static_cast<double>(tick) * m_stepSeconds, m_bodies, &m_definitions, motions,
                  0.0};
    // What came and went brought energy and took some: no drift of the solver's.
    if (!m_definitions.changed())
        moment.energyGain =
            (energyOf(m_definitions.info(), m_definitions.bodies(), motions) - m_startEnergy) /
            m_energyScale;
    for (std::vector<Watch>* watches : {&m_own, &m_rules})
        for (Watch& watch : *watches) {
            watch.look(moment, tick);
            if (watch.brokenAt() == 0) continue;
            m_broken = true;
            if (watch.share() > hopelessShare && watch.criterion().from == 0.0) m_hopeless = true;
        }
}

Judgement Judge::judgement() const {
    Judgement result;
    const Watch* worst = extreme(m_own, Among::Failing, m_hopeless);
    if (worst == nullptr) worst = extreme(m_rules, Among::Failing, m_hopeless);
    result.pass = worst == nullptr && m_lost.empty();
    if (worst == nullptr) worst = extreme(m_own, Among::All, m_hopeless);
    if (worst == nullptr) worst = extreme(m_rules, Among::All, m_hopeless);
    if (worst != nullptr) {
        const Criterion& criterion = worst->criterion();
        result.value = worst->value();
        result.limit = criterion.limit;
        result.unit = criterion.unit;
        result.what = criterion.what;
        if (worst->brokenAt() != 0) result.brokenAt = worst->brokenAt();
    }
    if (!m_lost.empty()) {
        result.brokenAt = m_lostAt;
        result.value = std::numeric_limits<double>::infinity();
        result.why = m_lost;
    } else if (!result.pass) {
        result.why = result.what + ": " + withUnit(result.value, result.unit) + ", limit " +
                     withUnit(result.limit, result.unit);
        if (result.brokenAt)
            result.why += ", first broken after " + secondsText(*result.brokenAt, m_stepSeconds);
    }
    return result;
}

}  // namespace huestep::tools::stability
