// A snapshot comes from outside: its checksums say that it arrived whole, not that it makes sense.

#include "core/state/validate.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numbers>
#include <utility>

#include "core/collision/hull.h"
#include "core/math/finite.h"
#include "core/state/effort.h"

namespace huestep {

namespace {

std::string nth(std::string_view record, std::size_t i) {
    return std::string(record) + " " + std::to_string(i);
}

/// Every float of every record is finite and no −0.
template <class Record>
std::string badNumber(std::string_view name, const std::vector<Record>& array) {
    for (std::size_t i = 0; i < array.size(); ++i) {
        const auto* base = reinterpret_cast<const char*>(&array[i]);
        for (const Field& field : fieldsOf<Record>) {
            if (field.type != FieldType::F32) continue;
            for (std::uint32_t k = 0; k < field.count; ++k) {
                float value;
                std::memcpy(&value, base + field.offset + 4 * k, 4);
                const bool minusZero = std::bit_cast<std::uint32_t>(value) == 0x80000000u;
                if (isFinite(value) && !minusZero) continue;
                return nth(name, i) + " " + field.name + ": " +
                       (minusZero ? "a zero with a sign" : "not a finite number");
            }
        }
    }
    return {};
}

template <class Record>
std::string badOrder(std::string_view name, const std::vector<Record>& array, std::uint32_t next) {
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < array.size(); ++i) {
        if (array[i].id <= last) return nth(name, i) + " id: ids must rise";
        if (array[i].id >= next) return nth(name, i) + " id: at or above the counter";
        last = array[i].id;
    }
    return {};
}

template <class Record>
const Record* findById(const std::vector<Record>& array, std::uint32_t id) {
    std::size_t low = 0;
    std::size_t high = array.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (array[middle].id < id) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < array.size() && array[low].id == id ? &array[low] : nullptr;
}

bool unit(Rotation q) {
    const float l = q.c * q.c + q.s * q.s;
    return l > 0.999f && l < 1.001f;
}

bool within(float v, float low, float high) {
    return v >= low && v <= high;
}

bool within(Vec2 v, float most) {
    return within(v.x, -most, most) && within(v.y, -most, most);
}

/// Counter-clockwise, once around, every corner a left turn: then no vertex is outside an edge.
bool isConvex(const Hull& hull) {
    int rounds = 0;
    for (int i = 0; i < hull.count; ++i) {
        const Vec2 here = hull.normals[static_cast<std::size_t>(i)];
        const Vec2 next = hull.normals[static_cast<std::size_t>(hull.next(i))];
        if (cross(here, next) <= 0.0f) return false;
        rounds += here.y < 0.0f && next.y >= 0.0f;
    }
    return rounds == 1;
}

// A centre of mass may be farther out than its body's origin, by the extent of the shapes.
constexpr float farthestCenter = maxCoordinate + 2.0f * caps::maxExtent;
constexpr float maxMass = 1.0e20f;  // kg; far above that of any definition

std::string badInfo(const WorldInfo& w) {
    if (!within(w.stepSeconds, caps::minStepSeconds, 0.1f)) {
        return "world stepSeconds: out of range";
    }
    if (w.substeps > 64) return "world substeps: out of range";
    const auto need = [](float tolerance) {
        return tolerance == 0.0f || within(tolerance, caps::minTolerance, caps::maxTolerance);
    };
    if (!need(w.penetrationNeed)) return "world penetrationNeed: out of range";
    if (!need(w.jointNeed)) return "world jointNeed: out of range";
    if (w.nextBody == 0 || w.nextShape == 0 || w.nextJoint == 0) return "world counters: zero";
    if (w.flags > (WorldInfo::sleep | WorldInfo::players)) return "world flags: unknown bits";
    if (!within(w.gravity, caps::maxGravity)) return "world gravity: out of range";
    if (w.maxBodies > caps::maxBodies || w.maxShapes > caps::maxShapes ||
        w.maxJoints > caps::maxJoints) {
        return "world limits: out of range";
    }
    if (!(w.maxCommandsPerTick >= 1 && w.maxCommandsPerTick <= caps::maxCommands)) {
        return "world maxCommandsPerTick: out of range";
    }
    if (w.maxPlayers > caps::maxPlayers) return "world maxPlayers: out of range";
    if (w.maxSpawned > caps::maxSpawned) return "world maxSpawned: out of range";
    if (!within(w.maxImpulse, 0, caps::maxPush)) return "world maxImpulse: out of range";
    if (!within(w.maxForce, 0, caps::maxPush)) return "world maxForce: out of range";
    if (w.method > static_cast<std::uint32_t>(lastMethod)) return "world method: unknown";
    return {};
}

std::string badSpawnPoint(const SpawnPoint& p) {
    if (!within(p.position.x, -maxCoordinate, maxCoordinate)) return "position.x: out of range";
    if (!within(p.position.y, -maxCoordinate, maxCoordinate)) return "position.y: out of range";
    return {};
}

/// Impulses are bounded by their being finite; a push is never negative.
std::string badContact(const ContactState& c) {
    if (!unit(c.relative.q)) return "relative: not a unit vector";
    if (!within(c.turn, -3.0f, 3.0f)) return "turn: out of range";
    if (c.normalImpulse[0] < 0 || c.normalImpulse[1] < 0) return "normalImpulse: negative";
    return {};
}

/// Whether anything lets two shapes touch: filters, types, and joints between their bodies.
bool mayPair(const WorldState& s, const ShapeInfo& a, const ShapeInfo& b,
             const std::vector<std::pair<BodyId, BodyId>>& forbidden) {
    if (a.body == b.body || !mayTouch(a.filter(), b.filter())) return false;
    if (!findById(s.bodies, a.body)->dynamic() && !findById(s.bodies, b.body)->dynamic()) {
        return false;
    }
    const std::pair<BodyId, BodyId> bodies = std::minmax(a.body, b.body);
    return !std::binary_search(forbidden.begin(), forbidden.end(), bodies);
}

std::string badReferences(const WorldState& s) {
    BodyId last = 0;
    for (std::size_t i = 0; i < s.shapes.size(); ++i) {
        if (s.shapes[i].body < last) return nth("shape", i) + " body: shapes follow their bodies";
        last = s.shapes[i].body;
        if (!placeById(s.bodies, last)) return nth("shape", i) + " body: no such body";
    }
    for (std::size_t i = 0; i < s.joints.size(); ++i) {
        const JointInfo& j = s.joints[i];
        if (j.bodyA == j.bodyB) return nth("joint", i) + " bodyB: the same as bodyA";
        // A grab draws its body to a point of the world: it has no body A.
        const bool mouse = j.kind() == JointKind::Mouse;
        if (mouse ? j.bodyA != 0 : !placeById(s.bodies, j.bodyA)) {
            return nth("joint", i) + " bodyA: no such body";
        }
        if (!placeById(s.bodies, j.bodyB)) return nth("joint", i) + " bodyB: no such body";
    }
    std::vector<std::pair<BodyId, BodyId>> forbidden;
    for (const JointInfo& j : s.joints) {
        if (!j.has(JointInfo::collideConnected)) {
            forbidden.push_back(std::minmax(j.bodyA, j.bodyB));
        }
    }
    std::sort(forbidden.begin(), forbidden.end());
    ShapeId lastA = 0, lastB = 0;
    for (std::size_t i = 0; i < s.contacts.size(); ++i) {
        const ContactState& c = s.contacts[i];
        if (c.shapeA < lastA || (c.shapeA == lastA && c.shapeB <= lastB)) {
            return nth("contact", i) + " shapeA: contacts must be in key order";
        }
        lastA = c.shapeA;
        lastB = c.shapeB;
        const auto a = placeById(s.shapes, c.shapeA);
        const auto b = placeById(s.shapes, c.shapeB);
        if (c.shapeA >= c.shapeB || !a || !b) return nth("contact", i) + " shapeB: no such pair";
        if (!mayPair(s, s.shapes[*a], s.shapes[*b], forbidden)) {
            return nth("contact", i) + " shapeB: these two may not touch";
        }
        if (std::string bad = badContact(c); !bad.empty()) return nth("contact", i) + " " + bad;
    }
    return {};
}

std::string badPlayers(const WorldState& s) {
    if (s.players.empty() || s.players.front().id != 0) return "player 0: the host is missing";
    for (std::size_t i = 0; i < s.players.size(); ++i) {
        const PlayerRecord& p = s.players[i];
        if (i > 0 && p.id <= s.players[i - 1].id) return nth("player", i) + " id: ids must rise";
        if (p.body != 0 && !placeById(s.bodies, p.body)) return nth("player", i) + " body: none";
        if (p.grab == 0) continue;
        const auto held = placeById(s.joints, p.grab);
        if (!held) return nth("player", i) + " grab: none";
        const JointInfo& joint = s.joints[*held];
        if (joint.owner != p.id) return nth("player", i) + " grab: another's";
        if (joint.kind() != JointKind::Mouse) return nth("player", i) + " grab: no grab";
    }
    return {};
}

/// What the rules themselves say of their state is asked where they are known.
std::string badRules(const WorldState& s) {
    if (s.rules.size() > 1) return "rules: more than one";
    if (s.rules.empty()) return s.rulesWords.empty() ? "" : "rulesWord: without rules";
    if (s.rulesWords.size() * sizeof(RulesWord) > maxRulesBytes) return "rulesWord: too many";
    const auto& name = s.rules.front().name;
    const auto end = std::find(name.begin(), name.end(), std::uint8_t{0});
    if (!isRulesName(std::string(name.begin(), end)))
        return "rules name: not 1 to 32 of [a-z0-9_-]";
    const bool clean = std::all_of(end, name.end(), [](std::uint8_t c) { return c == 0; });
    return clean ? "" : "rules name: more than zeros behind it";
}

template <class Record, class Check>
std::string firstBad(std::string_view name, const std::vector<Record>& array, Check check) {
    for (std::size_t i = 0; i < array.size(); ++i) {
        if (std::string bad = check(array[i]); !bad.empty()) return nth(name, i) + " " + bad;
    }
    return {};
}

std::string badState(const WorldState& s) {
    if (s.world.size() != 1) return "world: not exactly one record";
    if (s.motions.size() != s.bodies.size()) return "motion: not one a body";
    if (s.jointImpulses.size() != s.joints.size()) return "jointImpulse: not one a joint";
    if (s.playerBody.size() > 1) return "playerBody: more than one";
    if (s.playerMotion.size() != s.playerBody.size()) return "playerMotion: not one a playerBody";
    const auto fault = [](const auto& record) { return faultOf(record); };
    std::string bad;
    forEachArray(s, [&](std::string_view name, const auto& array) {
        if (bad.empty()) bad = badNumber(name, array);
    });
    const WorldInfo& info = s.info();
    if (bad.empty()) bad = badInfo(info);
    if (bad.empty()) bad = badOrder("body", s.bodies, info.nextBody);
    if (bad.empty()) bad = badOrder("shape", s.shapes, info.nextShape);
    if (bad.empty()) bad = badOrder("joint", s.joints, info.nextJoint);
    if (bad.empty()) bad = firstBad("motion", s.motions, fault);
    if (bad.empty()) bad = firstBad("body", s.bodies, fault);
    if (bad.empty()) bad = firstBad("shape", s.shapes, fault);
    if (bad.empty()) bad = firstBad("playerBody", s.playerBody, fault);
    if (bad.empty()) bad = firstBad("playerMotion", s.playerMotion, fault);
    if (bad.empty()) bad = firstBad("playerShape", s.playerShapes, fault);
    if (bad.empty()) bad = firstBad("spawnPoint", s.spawnPoints, badSpawnPoint);
    if (bad.empty()) bad = firstBad("joint", s.joints, fault);
    if (bad.empty()) bad = badReferences(s);
    if (bad.empty()) bad = badPlayers(s);
    if (bad.empty()) bad = badRules(s);
    return bad;
}

}  // namespace

std::string faultOf(const BodyMotion& m) {
    if (!unit(m.rotation)) return "rotation: not a unit vector";
    if (!within(m.position.x, -farthestCenter, farthestCenter)) return "position.x: out of range";
    if (!within(m.position.y, -farthestCenter, farthestCenter)) return "position.y: out of range";
    if (!within(m.velocity.x, -maxSpeed, maxSpeed)) return "velocity.x: out of range";
    if (!within(m.velocity.y, -maxSpeed, maxSpeed)) return "velocity.y: out of range";
    if (!within(m.angularVelocity, -maxSpeed, maxSpeed)) return "angularVelocity: out of range";
    if (levelOf(m.effort) > highestEffort) return "effort: out of range";
    if (rampOf(m.calm) > highestRamp || m.calm >= calmSteps) return "calm: out of range";
    return {};
}

std::string faultOf(const BodyInfo& b) {
    if ((b.flags & BodyInfo::typeMask) > 2) return "flags: no such body type";
    if (b.flags > 15) return "flags: unknown bits";
    if (b.dynamic() != (b.inverseMass > 0.0f)) return "inverseMass: does not fit the type";
    if (b.mass < 0 || b.inertia < 0 || b.inverseInertia < 0) return "mass: negative";
    if (b.mass > maxMass) return "mass: out of range";
    if (!within(b.localCenter, caps::maxExtent)) return "localCenter: out of range";
    if (!b.dynamic() && b.inverseInertia != 0) return "inverseInertia: does not fit the type";
    if (!within(b.linearDamping, 0, 1000)) return "linearDamping: out of range";
    if (!within(b.angularDamping, 0, 1000)) return "angularDamping: out of range";
    if (!within(b.gravityScale, -1000, 1000)) return "gravityScale: out of range";
    return {};
}

std::string faultOf(const ShapeInfo& s) {
    const int n = s.vertexCount();
    bool countFits = false;
    switch (s.kind & 0xffu) {
        case 0:
            countFits = n == 1;
            break;
        case 1:
        case 3:
            countFits = n == 2;
            break;
        case 2:
            countFits = n >= 3 && n <= maxPolygonVertices;
            break;
        case 4:
            countFits = n == 4;
            break;
        default:
            return "kind: no such shape";
    }
    if (!countFits || s.kind > 0xffff) return "kind: wrong number of vertices";
    if (!within(s.radius, 0, 10'000)) return "radius: out of range";
    if (!within(s.friction, 0, 100)) return "friction: out of range";
    if (!within(s.restitution, 0, 1)) return "restitution: out of range";
    if (!within(s.rollingResistance, 0, 100)) return "rollingResistance: out of range";
    if (!within(s.tangentSpeed, -maxSpeed, maxSpeed)) return "tangentSpeed: out of range";
    if (!within(s.density, 0, caps::maxDensity)) return "density: out of range";
    // From the centre of mass: twice what is allowed from the origin.
    for (const Vec2 v : s.vertices) {
        if (!within(v, 2.0f * caps::maxExtent)) return "vertices: out of range";
    }
    const auto hull = hullOf<float>(s);
    for (int i = 0; n > 1 && i < n; ++i) {
        if (hull.normals[static_cast<std::size_t>(i)] == Vec2{}) return "vertices: two coincide";
    }
    if (s.shapeKind() == ShapeKind::Polygon && !isConvex(hull)) return "vertices: not convex";
    return {};
}

std::string faultOf(const JointInfo& j) {
    if ((j.flags & 0xffu) > 4 || j.flags > 0x1fff) return "flags: unknown";
    const JointKind kind = j.kind();
    constexpr std::uint32_t driven = JointInfo::limit | JointInfo::motor | JointInfo::hasMotor;
    if (kind == JointKind::Weld && j.has(driven)) return "flags: a weld has no limit and no motor";
    // From the centres of mass, as far out as those may be.
    if (!within(j.anchorA, farthestCenter)) return "anchorA: out of range";
    if (!within(j.anchorB, farthestCenter)) return "anchorB: out of range";
    if (!within(j.target, maxCoordinate)) return "target: out of range";
    if (kind == JointKind::Prismatic && !unit({j.axis().x, j.axis().y})) {
        return "target: an axis that is not a unit vector";
    }
    if (!unit(j.reference)) return "reference: not a unit vector";
    if (!within(j.length, 0, caps::maxJointLength)) return "length: out of range";
    if (!within(j.maxForce, 0, caps::maxEffort)) return "maxForce: out of range";
    if (!within(j.motorMaxEffort, 0, caps::maxEffort)) return "motorMaxEffort: out of range";
    if (!within(j.motorSpeed, -maxSpeed, maxSpeed)) return "motorSpeed: out of range";
    if (!within(j.springHertz, 0, 1000)) return "springHertz: out of range";
    if (!within(j.springDamping, 0, 1000)) return "springDamping: out of range";
    if (!j.has(JointInfo::limit)) return {};
    const bool turns = kind == JointKind::Revolute;
    const float most = turns ? std::numbers::pi_v<float> : caps::maxJointLength;
    const float least = kind == JointKind::Distance ? 0.0f : -most;
    if (!within(j.lower, least, most)) return "lower: out of range";
    if (!within(j.upper, least, most)) return "upper: out of range";
    if (j.lower > j.upper) return "lower: above upper";
    return {};
}

Status validate(const WorldState& state) {
    std::string bad = badState(state);
    if (!bad.empty()) return Error{std::move(bad)};
    return Done{};
}

}  // namespace huestep
