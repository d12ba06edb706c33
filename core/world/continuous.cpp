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
#include <utility>

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

/// How far from where it was a point of a body may have been.
float wayOf(const Pose& from, const Pose& to, float spin, float reach) {
    // Beyond half a turn the chord says nothing.
    const bool little = absoluteOf(spin) < 1.5f;
    const Vec2 chord{to.q.c - from.q.c, to.q.s - from.q.s};
    return length(to.p - from.p) + reach * (little ? length(chord) : 2.0f);
}

/// When a hull on its way is to stop before a wall, and whether it touched that to begin with.
struct Meeting {
    float time = 1.0f;
    bool touched = false;
};

/// Where a body is to stop. `drive`: how the wall went, where that is one that goes on.
struct Stop {
    Meeting first;
    Pose at;
    const Leap* drive = nullptr;
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
    Separation before;
    const Leap* drive = nullptr;  ///< where it goes on
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
            const float way = wayOf(d.from, poseOf(d.body), spinOf(d.body), m_known.reach[d.body]);
            m_farthestDriven = maxOf(m_farthestDriven, way);
        }
    }

    /// What was found for one shape, in memory that serves the next.
    struct Scratch {
        std::vector<std::uint32_t> near;
        std::vector<Wall> walls;
        SweptHull body;  ///< how the shape goes; where there are walls
    };

    [[nodiscard]] Stop stopOf(const Leap& leap, Scratch& scratch) const {
        Stop stop;
        for (std::uint32_t s = m_known.first[leap.body]; s < m_known.first[leap.body + 1]; ++s) {
            if (m_known.proxies[s].alone || !(m_known.thickness[s] > 0.0f)) continue;
            findWalls(s, leap, scratch);
            if (scratch.walls.empty()) continue;
            const SweptHull& body = scratch.body;
            // Of a floor of many boxes it is as deep in the next one as in those it lies on.
            float sunk = 0.0f;
            for (const Wall& wall : scratch.walls) sunk = minOf(sunk, wall.before.distance);
            for (const Wall& wall : scratch.walls) {
                const auto meeting =
                    meetingOf(wall, body, m_known.thickness[s], sunk, stop.first.time);
                if (meeting) stop = stopAt(*meeting, body, wall.drive);
            }
        }
        return stop;
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
        // The earliest of each set; of equals that of the lowest body.
        std::vector<std::uint32_t> earliest(leaps.size(), none);
        const auto key = [&](std::uint32_t i) {
            return std::pair(stops[i].first.time, leaps[i].body);
        };
        for (std::uint32_t i = 0; i < leaps.size(); ++i) {
            std::uint32_t& first = earliest[sets.find(i)];
            if (first == none || key(i) < key(first)) first = i;
        }
        const std::vector<Stop> own(stops.begin(), stops.end());
        for (std::uint32_t i = 0; i < leaps.size(); ++i) {
            const Stop& first = own[earliest[sets.find(i)]];
            // Who met a wall that goes on stays before it.
            if (own[i].drive != nullptr || !(own[i].first.time > first.first.time)) continue;
            stops[i] = stopAt({first.first.time, false}, onTheWay(leaps[i]), first.drive);
        }
    }

    void put(std::uint32_t body, const Stop& stop) const {
        BodyMotion& motion = m_state.motions[body];
        motion.position = canonicalZero(stop.at.p);
        motion.rotation = canonicalZero(normalized(stop.at.q));
        // It did not fall for the rest of the step, so it did not gain that speed; whom something
        // held up did not gain it in the first place.
        const float rest = (1.0f - stop.first.time) * m_state.info().stepSeconds;
        const Vec2 fall = (rest * m_state.bodies[body].gravityScale) * m_state.info().gravity;
        const float along = dot(motion.velocity, fall);
        if (along > 0.0f) {
            const float part = minOf(along / lengthSquared(fall), 1.0f);
            motion.velocity = canonicalZero(motion.velocity - part * fall);
        }
        // What went in though it touched has turned in: rows take the velocity of a point for a
        // straight one. It would spin on the spot, ever deeper.
        if (stop.first.touched) {
            motion.angularVelocity =
                canonicalZero((0.5f + 0.5f * stop.first.time) * motion.angularVelocity);
        }
    }

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
        const Bounds way =
            boundsOnTheWay(m_known.hulls[shape], leap.from, poseOf(leap.body), spinOf(leap.body));
        const Bounds wayOfDriven = grown(way, m_farthestDriven);
        scratch.near.clear();
        scratch.walls.clear();
        m_acc.broadPhase.findFixed(shape, wayOfDriven, m_known.proxies, m_known.forbidden,
                                   scratch.near);
        if (scratch.near.empty()) return;
        scratch.body = swept(shape, leap.body, leap.from);
        const SweptHull& body = scratch.body;
        std::sort(scratch.near.begin(), scratch.near.end());
        for (const std::uint32_t other : scratch.near) {
            const std::uint32_t place = m_known.proxies[other].body;
            const Leap* drive = driveOf(place);
            // Tight bounds decide: fat ones depend on what was before.
            if (!overlaps(drive != nullptr ? wayOfDriven : way, m_acc.tight[other])) continue;
            Wall wall{
                swept(other, place, drive != nullptr ? drive->from : poseOf(place)), {}, drive};
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
    /// Where a body stops at a time on its way; where a wall met it that goes on, it goes on with
    /// the wall.
    [[nodiscard]] Stop stopAt(const Meeting& meeting, const SweptHull& body,
                              const Leap* drive) const {
        if (drive == nullptr) return {meeting, body.at(meeting.time), nullptr};
        const Pose met = relativeAt(onTheWay(*drive), body, meeting.time);
        const Pose end = poseOf(drive->body);
        return {meeting, {transform(end, met.p), compose(end.q, met.q)}, drive};
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
        if (stopped(stops[i])) stopper.put(moved.leaps[i].body, stops[i]);
    }
}

}  // namespace huestep
