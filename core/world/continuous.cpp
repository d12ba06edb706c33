// The continuous stage: no fast body goes through what does not give way.
//
// Contacts are found where bodies are at the start of a step, so what moves by more than its own
// thickness in one step may pass a wall between two looks. Such a body is stopped where it meets
// the wall and goes on from there in the next step, in which the two have a contact. Nothing else
// is changed: a way past a wall is not bent, however near, and contacts, rows and events know of
// nothing. (Contact points that reach ahead as far as a body may go bend it: a disc that would pass
// a wall by 5 cm meets the plane through the wall's end.)

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/collision/sweep.h"
#include "core/parallel/over_range.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

constexpr std::uint32_t leapGrain = 8;
// A body may sink in by this part of its thickness before it is stopped: what the solver lets
// overlap while it slides, over the seams of a floor too, is none of this stage's business.
constexpr float sinkPart = 0.25f;
// What is in deeper than this part already may be on either side.
constexpr float lostPart = 0.75f;
constexpr float meetTolerance = 0.001f;  // m, how far from each other bodies are stopped

/// How far a body turned from a rotation to another, rad: as its spin (rad over the step) says
/// where it may have gone round more than half.
float turnBetween(Rotation from, Rotation to, float spin) {
    if (from == to && absoluteOf(spin) < 1.0f) return 0.0f;
    const float angle = angleOf(relative(from, to));
    constexpr float round = static_cast<float>(2.0 * pi);
    const float turns = (spin - angle) / round;
    const auto whole = static_cast<std::int64_t>(turns + (turns < 0.0f ? -0.5f : 0.5f));
    return angle + static_cast<float>(whole) * round;
}

/// Bounds of all places of a hull on its way. Between its two ends a point is off their chord by at
/// most reach · (1 − cos θ/2) ≤ reach · sin² θ/2 for |θ| ≤ π; beyond, it may be all around.
Bounds boundsOnTheWay(const Hull& hull, const Pose& from, const Pose& to, float spin) {
    const float reach = coreReachOf(hull);
    const Vec2 chord{to.q.c - from.q.c, to.q.s - from.q.s};
    // Both turned and spun by less than a right angle: no need to ask for the angle itself.
    const bool little = lengthSquared(chord) < 1.9f && absoluteOf(spin) < 1.5f;
    if (!little && absoluteOf(turnBetween(from.q, to.q, spin)) > static_cast<float>(pi)) {
        return grown(Bounds{minOf(from.p, to.p), maxOf(from.p, to.p)}, reach + hull.radius);
    }
    return grown(unite(boundsOf(hull, from), boundsOf(hull, to)),
                 reach * (0.25f * lengthSquared(chord)));
}

/// The greatest way of a point of a body.
float wayOf(const Pose& from, const Pose& to, float reach) {
    return length(to.p - from.p) + reach * length(Vec2{to.q.c - from.q.c, to.q.s - from.q.s});
}

/// When a hull on its way is to stop before a wall, and whether it touched that to begin with.
struct Meeting {
    float time = 1.0f;
    bool touched = false;
};

/// Where a body is to stop.
struct Stop {
    Meeting first;
    Pose at;
};

/// A chain lets through what comes from behind: its middle says where a hull is.
bool isBehind(const Hull& chain, const Hull& hull, const Pose& relative) {
    Vec2 sum;
    for (std::size_t i = 0; i < static_cast<std::size_t>(hull.count); ++i) {
        sum += transform(relative, hull.vertices[i]) - chain.vertices[0];
    }
    return dot(sum, chain.normals[0]) < 0.0f;
}

/// A wall that a shape may meet on its way, and how they start.
struct Wall {
    SweptHull swept;
    std::uint32_t body = 0;
    Separation before;
    bool drives = false;
};

/// None before `until`. `sunk`: how deep the shape is in any wall already, m, ≤ 0.
std::optional<Meeting> meetingOf(const Wall& wall, const SweptHull& body, float thickness,
                                 float sunk, float until) {
    const float sink = sinkPart * thickness;
    const float deepest = maxOf(sunk - sink, -lostPart * thickness);
    const float tolerance = 0.25f * sink;
    if (!(wall.before.distance > deepest + tolerance)) return std::nullopt;
    const auto through = timeOfApproach(wall.swept, body, wall.before, deepest, tolerance, until);
    if (!through) return std::nullopt;
    if (!(wall.before.distance > meetTolerance)) return Meeting{*through, true};
    const auto met = timeOfApproach(wall.swept, body, wall.before, 0.0f, meetTolerance, *through);
    return Meeting{met ? *met : *through, false};
}

/// The step's end as the stage sees it: everything has moved, and nothing has been stopped.
class Stopper {
 public:
    Stopper(WorldState& state, const Accelerators& acc, std::span<const Leap> driven)
        : m_state(state), m_acc(acc), m_known(acc.shapes), m_driven(driven) {
        // Broad phase and bounds are those of the step's start: driven bodies have gone on since.
        for (const Leap& d : driven) {
            const float way = wayOf(d.from, poseOf(d.body), m_known.reach[d.body]);
            m_farthestDriven = maxOf(m_farthestDriven, way);
        }
    }

    struct Scratch {
        std::vector<std::uint32_t> near;
        std::vector<Wall> walls;
    };

    [[nodiscard]] Stop stopOf(const Leap& leap, Scratch& scratch) const {
        Meeting first;
        Pose stopped;
        for (std::uint32_t s = m_known.first[leap.body]; s < m_known.first[leap.body + 1]; ++s) {
            if (m_known.proxies[s].alone || !(m_known.thickness[s] > 0.0f)) continue;
            findWalls(s, leap, scratch);
            if (scratch.walls.empty()) continue;
            const SweptHull body = swept(s, leap.body, leap.from);
            // Of a floor of many boxes it is as deep in the next one as in those it lies on.
            float sunk = 0.0f;
            for (const Wall& wall : scratch.walls) sunk = minOf(sunk, wall.before.distance);
            for (const Wall& wall : scratch.walls) {
                const auto meeting = meetingOf(wall, body, m_known.thickness[s], sunk, first.time);
                if (!meeting) continue;
                first = *meeting;
                stopped = body.at(first.time);
                if (!wall.drives) continue;
                // Where it met a wall that goes on, it goes on with the wall.
                const Pose met = relativeAt(wall.swept, body, first.time);
                const Pose end = poseOf(wall.body);
                stopped = {transform(end, met.p), compose(end.q, met.q)};
            }
        }
        return {first, stopped};
    }

    /// Bodies on joints stop together: where one of them alone did, the joint would be torn open by
    /// as far as the others go on, and close with a jerk. `stops`: by leap.
    void stopJointed(std::span<const Leap> leaps, std::span<Stop> stops) const {
        std::vector<std::uint32_t> leapOf(m_state.bodies.size(), none);
        for (std::uint32_t i = 0; i < leaps.size(); ++i) leapOf[leaps[i].body] = i;
        UnionFind sets;
        sets.reset(static_cast<std::uint32_t>(leaps.size()));
        bool any = false;
        for (const ConstraintPlaces& joint : m_known.jointBodies) {
            const std::uint32_t a = leapOf[joint.a], b = leapOf[joint.b];
            if (a == none || b == none) continue;
            sets.unite(a, b);
            any = true;
        }
        if (!any) return;
        std::vector<float> earliest(leaps.size(), 1.0f);
        for (std::uint32_t i = 0; i < leaps.size(); ++i) {
            float& first = earliest[sets.find(i)];
            first = minOf(first, stops[i].first.time);
        }
        for (std::uint32_t i = 0; i < leaps.size(); ++i) {
            const float time = earliest[sets.find(i)];
            if (stops[i].first.time > time) {
                stops[i] = {{time, false}, onTheWay(leaps[i]).at(time)};
            }
        }
    }

    void put(const Leap& leap, const Stop& stop) const { put(leap.body, stop.at, stop.first); }

 private:
    [[nodiscard]] Pose poseOf(std::uint32_t body) const { return m_state.motions[body].pose(); }
    [[nodiscard]] const Leap* driveOf(std::uint32_t body) const {
        const auto at = std::lower_bound(m_driven.begin(), m_driven.end(), body,
                                         [](const Leap& l, std::uint32_t b) { return l.body < b; });
        return at != m_driven.end() && at->body == body ? &*at : nullptr;
    }
    [[nodiscard]] float spinOf(std::uint32_t body) const {
        return m_state.info().stepSeconds * m_state.motions[body].angularVelocity;
    }
    /// In the order of their shapes.
    void findWalls(std::uint32_t shape, const Leap& leap, Scratch& scratch) const {
        const Bounds way = grown(
            boundsOnTheWay(m_known.hulls[shape], leap.from, poseOf(leap.body), spinOf(leap.body)),
            m_farthestDriven);
        scratch.near.clear();
        scratch.walls.clear();
        m_acc.broadPhase.findFixed(shape, way, m_known.proxies, m_known.forbidden, scratch.near);
        if (scratch.near.empty()) return;
        const SweptHull body = swept(shape, leap.body, leap.from);
        std::sort(scratch.near.begin(), scratch.near.end());
        for (const std::uint32_t other : scratch.near) {
            // Tight bounds decide: fat ones depend on what was before.
            if (!overlaps(way, m_acc.tight[other])) continue;
            const std::uint32_t place = m_known.proxies[other].body;
            const Leap* drive = driveOf(place);
            Wall wall{swept(other, place, drive != nullptr ? drive->from : poseOf(place)),
                      place,
                      {},
                      drive != nullptr};
            const Pose first = relativeAt(wall.swept, body, 0.0f);
            const Hull& hull = *wall.swept.hull;
            if (hull.oneSided && isBehind(hull, *body.hull, first)) continue;
            wall.before = separationOf(hull, *body.hull, first);
            scratch.walls.push_back(wall);
        }
    }
    /// How a shape went from where its body was to where that is.
    [[nodiscard]] SweptHull swept(std::uint32_t shape, std::uint32_t body, const Pose& from) const {
        SweptHull way = onTheWay({body, from});
        way.hull = &m_known.hulls[shape];
        way.reach = coreReachOf(*way.hull);
        return way;
    }
    /// The body itself, without a hull.
    [[nodiscard]] SweptHull onTheWay(const Leap& leap) const {
        const BodyMotion& motion = m_state.motions[leap.body];
        const float turn = turnBetween(leap.from.q, motion.rotation, spinOf(leap.body));
        return {nullptr, leap.from, motion.position - leap.from.p, turn, 0.0f};
    }
    void put(std::uint32_t body, const Pose& stopped, const Meeting& meeting) const {
        BodyMotion& motion = m_state.motions[body];
        motion.position = canonicalZero(stopped.p);
        motion.rotation = canonicalZero(normalized(stopped.q));
        // It did not fall for the rest of the step, so it did not gain that speed.
        const float rest = (1.0f - meeting.time) * m_state.info().stepSeconds;
        const float scale = rest * m_state.bodies[body].gravityScale;
        motion.velocity = canonicalZero(motion.velocity - scale * m_state.info().gravity);
        // What went in though it touched has turned in: rows take the velocity of a point for a
        // straight one. It would spin on the spot, ever deeper.
        if (meeting.touched) {
            motion.angularVelocity =
                canonicalZero((0.5f + 0.5f * meeting.time) * motion.angularVelocity);
        }
    }

    WorldState& m_state;
    const Accelerators& m_acc;
    const Shapes& m_known;
    std::span<const Leap> m_driven;
    float m_farthestDriven = 0.0f;
};

}  // namespace

void World::Data::stopLeaps(const Moved& moved, Executor* executor) {
    if (moved.leaps.empty()) return;
    const Stopper stopper(state, accelerators, moved.driven);
    std::vector<Stop> stops(moved.leaps.size());
    overRange(executor, stops.size(), leapGrain, [&](std::uint32_t begin, std::uint32_t end) {
        Stopper::Scratch scratch;
        for (std::uint32_t i = begin; i < end; ++i) {
            stops[i] = stopper.stopOf(moved.leaps[i], scratch);
        }
    });
    const auto stopped = [](const Stop& stop) { return stop.first.time < 1.0f; };
    if (std::none_of(stops.begin(), stops.end(), stopped)) return;
    if (!accelerators.shapes.jointBodies.empty()) stopper.stopJointed(moved.leaps, stops);
    for (std::size_t i = 0; i < stops.size(); ++i) {
        if (stopped(stops[i])) stopper.put(moved.leaps[i], stops[i]);
    }
}

}  // namespace huestep
