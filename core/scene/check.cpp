// One walk over a scene that stops at the first thing wrong and names its path.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/scene/in_double.h"
#include "core/scene/scene.h"

namespace huestep {

namespace {

/// A step of a path, linked to the step before: the text is made only where something is wrong,
/// so that checking a large scene writes no strings.
struct Place {
    const Place* parent = nullptr;
    std::string_view name;
    std::int64_t index = -1;

    [[nodiscard]] Place at(std::string_view child, std::int64_t childIndex = -1) const {
        return {this, child, childIndex};
    }

    [[nodiscard]] std::string text() const {
        std::string result = parent != nullptr ? parent->text() : std::string();
        if (!result.empty() && !name.empty()) result += '.';
        result += name;
        if (index >= 0) result += '[' + std::to_string(index) + ']';
        return result;
    }
};

/// The shortest text that reads back as the same number, whatever the locale.
template <class Number>
std::string text(Number value) {
    std::array<char, 64> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

/// Remembers the first sentence; every check returns whether all is well, so that checks chain
/// with &&.
class Checker {
 public:
    bool fail(const Place& place, std::string_view sentence) {
        const std::string path = place.text();
        m_sentence = path.empty() ? std::string(sentence) : path + ": " + std::string(sentence);
        return false;
    }

    bool finite(const Place& place, float value) {
        return std::isfinite(value) || fail(place, "not a finite number");
    }

    bool within(const Place& place, float value, float low, float high) {
        if (!finite(place, value)) return false;
        if (low <= value && value <= high) return true;
        return fail(place,
                    "must be from " + text(low) + " to " + text(high) + ", is " + text(value));
    }

    bool within(const Place& place, std::uint32_t value, std::uint32_t low, std::uint32_t high) {
        if (low <= value && value <= high) return true;
        return fail(place,
                    "must be from " + text(low) + " to " + text(high) + ", is " + text(value));
    }

    bool within(const Place& place, Vec2 value, float bound) {
        return within(place.at("x"), value.x, -bound, bound) &&
               within(place.at("y"), value.y, -bound, bound);
    }

    bool unit(const Place& place, Rotation q) {
        if (!finite(place.at("c"), q.c) || !finite(place.at("s"), q.s)) return false;
        const Vec2T<double> v{static_cast<double>(q.c), static_cast<double>(q.s)};
        const double square = lengthSquared(v);
        if (std::abs(square - 1.0) <= static_cast<double>(caps::rotationTolerance)) return true;
        return fail(place, "(c, s) must be (cos, sin) of an angle, but c*c + s*s is " +
                               text(static_cast<float>(square)));
    }

    bool body(const Place& place, const BodyDef& body);
    bool joint(const Place& place, const JointDef& joint, std::size_t bodyCount);
    bool scene(const Scene& scene);

    [[nodiscard]] Status status(bool ok) const {
        if (ok) return Done{};
        return Error{m_sentence};
    }

 private:
    bool vertexCount(const Place& place, const ShapeDef& shape);
    bool polygon(const Place& place, const ShapeDef& shape);
    bool shape(const Place& place, const ShapeDef& shape);
    bool massOf(const Place& place, const BodyDef& body);
    bool spring(const Place& place, const SpringDef& spring);
    bool limit(const Place& place, const JointDef& joint);
    bool players(const Place& place, const PlayerDef& players);
    bool need(const Place& place, const Scene& scene);
    bool rules(const Place& place, const RulesDef& def);
    bool limits(const Scene& scene);
    template <class Def>
    bool ids(const std::vector<Def>& defs, std::string_view list);

    std::string m_sentence;
};

bool Checker::vertexCount(const Place& place, const ShapeDef& shape) {
    const std::uint32_t count = shape.vertexCount;
    switch (shape.kind) {
        case ShapeKind::Circle:
            return count == 1 || fail(place, "a circle has 1 vertex, not " + text(count));
        case ShapeKind::Capsule:
            return count == 2 || fail(place, "a capsule has 2 vertices, not " + text(count));
        case ShapeKind::Segment:
            return count == 2 || fail(place, "a segment has 2 vertices, not " + text(count));
        case ShapeKind::ChainSegment:
            return count == 4 || fail(place, "a chain segment has 4 vertices, not " + text(count));
        case ShapeKind::Polygon:
            return (count >= 3 && count <= maxPolygonVertices) ||
                   fail(place, "a polygon has 3 to 8 vertices, not " + text(count));
    }
    return true;
}

/// Every vertex must lie to the left of every edge that it does not end, by `minVertexDepth`. This
/// one rule refuses clockwise, concave, self-crossing, flat and nearly collinear polygons alike.
bool Checker::polygon(const Place& place, const ShapeDef& shape) {
    const std::size_t count = shape.vertexCount;
    double area = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2T<double> a = inDouble(shape.vertices[i]) - inDouble(shape.vertices[0]);
        const Vec2T<double> b =
            inDouble(shape.vertices[(i + 1) % count]) - inDouble(shape.vertices[0]);
        area += 0.5 * cross(a, b);
    }
    if (area < 0.0) return fail(place.at("vertices"), "run clockwise, must run counter-clockwise");
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = (i + 1) % count;
        const Vec2T<double> edge = inDouble(shape.vertices[next]) - inDouble(shape.vertices[i]);
        const double edgeLength = length(edge);
        for (std::size_t j = 0; j < count; ++j) {
            if (j == i || j == next) continue;
            const double depth =
                cross(edge, inDouble(shape.vertices[j]) - inDouble(shape.vertices[i])) / edgeLength;
            if (depth >= static_cast<double>(caps::minVertexDepth)) continue;
            const Place vertices = place.at("vertices", static_cast<std::int64_t>(j));
            const std::string edgeText = "the edge from vertex " + text(i) + " to " + text(next);
            if (depth < -static_cast<double>(caps::minVertexDepth)) {
                return fail(vertices, "the polygon is not convex: outside of " + edgeText);
            }
            return fail(vertices, "the polygon is flat here: less than " +
                                      text(caps::minVertexDepth) + " m inside of " + edgeText);
        }
    }
    return true;
}

bool Checker::shape(const Place& place, const ShapeDef& shape) {
    if (static_cast<std::uint32_t>(shape.kind) >
        static_cast<std::uint32_t>(ShapeKind::ChainSegment)) {
        return fail(place.at("kind"), "is not circle, capsule, polygon, segment or chain segment");
    }
    if (!vertexCount(place.at("vertices"), shape)) return false;
    const std::size_t count = shape.vertexCount;
    for (std::size_t i = 0; i < count; ++i) {
        const Place vertices = place.at("vertices", static_cast<std::int64_t>(i));
        if (!within(vertices, shape.vertices[i], caps::maxExtent)) return false;
    }
    const std::size_t edges = shape.kind == ShapeKind::Polygon ? count : count - 1;
    for (std::size_t i = 0; i < edges; ++i) {
        const std::size_t next = (i + 1) % count;
        if (length(inDouble(shape.vertices[next]) - inDouble(shape.vertices[i])) <
            static_cast<double>(caps::minEdge)) {
            return fail(place.at("vertices", static_cast<std::int64_t>(next)),
                        "less than " + text(caps::minEdge) + " m from vertex " + text(i));
        }
    }
    if (shape.kind == ShapeKind::Polygon && !polygon(place, shape)) return false;
    const bool round = shape.kind == ShapeKind::Circle || shape.kind == ShapeKind::Capsule;
    const bool segment = shape.kind == ShapeKind::Segment || shape.kind == ShapeKind::ChainSegment;
    if (!within(place.at("radius"), shape.radius, round ? caps::minEdge : 0.0f,
                segment ? 0.0f : caps::maxExtent)) {
        return false;
    }
    if (!within(place.at("density"), shape.density, 0.0f, caps::maxDensity)) return false;
    if (shape.density > 0.0f && shape.density < caps::minDensity) {
        return fail(place.at("density"), "must be 0 or at least " + text(caps::minDensity) +
                                             ", is " + text(shape.density));
    }
    const Place material = place.at("material");
    return within(material.at("friction"), shape.material.friction, 0.0f, 100.0f) &&
           within(material.at("restitution"), shape.material.restitution, 0.0f, 1.0f) &&
           within(material.at("rollingResistance"), shape.material.rollingResistance, 0.0f,
                  100.0f) &&
           within(material.at("tangentSpeed"), shape.material.tangentSpeed, -10'000.0f, 10'000.0f);
}

/// A dynamic body without mass is refused, not given some: a scene then means what it says.
bool Checker::massOf(const Place& place, const BodyDef& body) {
    const bool hasMass =
        std::any_of(body.shapes.begin(), body.shapes.end(), [](const ShapeDef& shape) {
            return shape.kind != ShapeKind::Segment && shape.kind != ShapeKind::ChainSegment &&
                   shape.density > 0.0f;
        });
    return hasMass || fail(place,
                           "a dynamic body needs mass: give it a circle, capsule or polygon with "
                           "a density above 0");
}

bool Checker::body(const Place& place, const BodyDef& body) {
    if (static_cast<std::uint32_t>(body.type) > static_cast<std::uint32_t>(BodyType::Dynamic)) {
        return fail(place.at("type"), "is not static, kinematic or dynamic");
    }
    if (!within(place.at("id"), body.id, 0u, caps::maxId)) return false;
    if (!within(place.at("firstShape"), body.firstShape, 0u, caps::maxId)) return false;
    if (body.firstShape != 0 && body.id == 0) {
        return fail(place.at("firstShape"), "needs an id of the body as well");
    }
    if (!within(place.at("position"), body.position, maxCoordinate)) return false;
    if (!unit(place.at("rotation"), body.rotation)) return false;
    if (!within(place.at("velocity"), body.velocity, maxSpeed) ||
        !within(place.at("angularVelocity"), body.angularVelocity, -maxSpeed, maxSpeed) ||
        !within(place.at("linearDamping"), body.linearDamping, 0.0f, 1000.0f) ||
        !within(place.at("angularDamping"), body.angularDamping, 0.0f, 1000.0f) ||
        !within(place.at("gravityScale"), body.gravityScale, -1000.0f, 1000.0f)) {
        return false;
    }
    const bool moves =
        body.velocity.x != 0.0f || body.velocity.y != 0.0f || body.angularVelocity != 0.0f;
    if (body.type == BodyType::Static && moves) {
        return fail(place.at("velocity"), "a static body has none");
    }
    if (body.asleep) {
        if (body.type != BodyType::Dynamic) {
            return fail(place.at("asleep"), "only a dynamic body can sleep");
        }
        if (!body.maySleep) return fail(place.at("asleep"), "contradicts maySleep");
        if (moves) return fail(place.at("asleep"), "a sleeping body has no velocity");
    }
    if (body.shapes.size() > maxShapesPerBody) {
        return fail(place.at("shapes"), text(body.shapes.size()) + " are more than the " +
                                            text(maxShapesPerBody) + " a body may have");
    }
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
        if (!shape(place.at("shapes", static_cast<std::int64_t>(i)), body.shapes[i])) return false;
    }
    return body.type != BodyType::Dynamic || massOf(place, body);
}

bool Checker::spring(const Place& place, const SpringDef& spring) {
    if (!within(place.at("hertz"), spring.hertz, 0.0f, 1000.0f) ||
        !within(place.at("dampingRatio"), spring.dampingRatio, 0.0f, 1000.0f)) {
        return false;
    }
    return !spring.enabled || spring.hertz > 0.0f ||
           fail(place.at("hertz"), "must be above 0 where the spring is enabled");
}

bool Checker::limit(const Place& place, const JointDef& joint) {
    const LimitDef& limit = joint.limit;
    if (!finite(place.at("lower"), limit.lower) || !finite(place.at("upper"), limit.upper)) {
        return false;
    }
    if (!limit.enabled) return true;
    if (joint.kind == JointKind::Mouse) return fail(place, "a mouse joint has no limit");
    if (joint.kind == JointKind::Weld) return fail(place, "a weld joint has no limit");
    if (joint.kind == JointKind::Revolute) {
        const float pi = std::numbers::pi_v<float>;
        if (!(limit.lower > -pi)) return fail(place.at("lower"), "must be above -pi");
        if (!(limit.upper < pi)) return fail(place.at("upper"), "must be below pi");
    } else {
        const float least = joint.kind == JointKind::Distance ? 0.0f : -caps::maxJointLength;
        if (!within(place.at("lower"), limit.lower, least, caps::maxJointLength) ||
            !within(place.at("upper"), limit.upper, least, caps::maxJointLength)) {
            return false;
        }
    }
    return limit.lower <= limit.upper ||
           fail(place, "lower " + text(limit.lower) + " is above upper " + text(limit.upper));
}

bool Checker::joint(const Place& place, const JointDef& joint, std::size_t bodyCount) {
    if (static_cast<std::uint32_t>(joint.kind) > static_cast<std::uint32_t>(JointKind::Prismatic)) {
        return fail(place.at("kind"), "is not revolute, distance, mouse, weld or prismatic");
    }
    if (!within(place.at("id"), joint.id, 0u, caps::maxId)) return false;
    const auto missing = [&](const Place& end, std::uint32_t body) {
        return fail(end, "there is no body " + text(body) + " among " + text(bodyCount));
    };
    if (joint.bodyA >= bodyCount) return missing(place.at("bodyA"), joint.bodyA);
    if (joint.bodyB >= bodyCount) return missing(place.at("bodyB"), joint.bodyB);
    const bool mouse = joint.kind == JointKind::Mouse;
    if (!mouse && joint.bodyA == joint.bodyB) {
        return fail(place.at("bodyB"), "is body A: a joint needs two bodies");
    }
    if (mouse && joint.motor.enabled) return fail(place.at("motor"), "a mouse joint has none");
    if (joint.kind == JointKind::Weld && joint.motor.enabled) {
        return fail(place.at("motor"), "a weld joint has none");
    }
    if (mouse && !joint.spring.enabled) return fail(place.at("spring"), "a mouse joint needs one");
    if (!within(place.at("anchorA"), joint.anchorA, maxCoordinate) ||
        !within(place.at("anchorB"), joint.anchorB, maxCoordinate) ||
        !unit(place.at("reference"), joint.reference) || !unit(place.at("axis"), joint.axis) ||
        !within(place.at("length"), joint.length, 0.0f, caps::maxJointLength)) {
        return false;
    }
    if (joint.kind == JointKind::Distance && !(joint.length >= caps::minJointLength)) {
        return fail(place.at("length"), "must be at least " + text(caps::minJointLength) +
                                            " m, is " + text(joint.length));
    }
    const Place motor = place.at("motor");
    return within(place.at("target"), joint.target, maxCoordinate) &&
           within(place.at("maxForce"), joint.maxForce, 0.0f, caps::maxEffort) &&
           spring(place.at("spring"), joint.spring) && limit(place.at("limit"), joint) &&
           within(motor.at("speed"), joint.motor.speed, -maxSpeed, maxSpeed) &&
           within(motor.at("maxEffort"), joint.motor.maxEffort, 0.0f, caps::maxEffort);
}

bool Checker::players(const Place& place, const PlayerDef& players) {
    if (!within(place.at("maxSpawned"), players.maxSpawned, 0u, caps::maxSpawned) ||
        !within(place.at("maxImpulse"), players.maxImpulse, 0.0f, caps::maxPush) ||
        !within(place.at("maxForce"), players.maxForce, 0.0f, caps::maxPush)) {
        return false;
    }
    if (players.spawnPoints.size() > caps::maxSpawnPoints) {
        return fail(place.at("spawnPoints"), text(players.spawnPoints.size()) + " are more than " +
                                                 text(caps::maxSpawnPoints));
    }
    for (std::size_t i = 0; i < players.spawnPoints.size(); ++i) {
        const Place point = place.at("spawnPoints", static_cast<std::int64_t>(i));
        if (!within(point, players.spawnPoints[i], maxCoordinate)) return false;
    }
    if (!players.body) return true;
    const Place bodyPlace = place.at("body");
    if (players.body->id != 0) {
        return fail(bodyPlace.at("id"), "must be 0: every player's body gets an id of its own");
    }
    if (players.spawnPoints.empty()) {
        return fail(place.at("spawnPoints"), "players have a body, so there must be at least one");
    }
    return body(bodyPlace, *players.body);
}

bool Checker::limits(const Scene& scene) {
    const Place root;
    const Place limits = root.at("limits");
    const Place counters = root.at("counters");
    return within(limits.at("bodies"), scene.limits.bodies, 0u, caps::maxBodies) &&
           within(limits.at("shapes"), scene.limits.shapes, 0u, caps::maxShapes) &&
           within(limits.at("joints"), scene.limits.joints, 0u, caps::maxJoints) &&
           within(limits.at("commandsPerTick"), scene.limits.commandsPerTick, 1u,
                  caps::maxCommands) &&
           within(limits.at("players"), scene.limits.players, 0u, caps::maxPlayers) &&
           within(counters.at("nextBody"), scene.counters.nextBody, 1u, caps::maxId) &&
           within(counters.at("nextShape"), scene.counters.nextShape, 1u, caps::maxId) &&
           within(counters.at("nextJoint"), scene.counters.nextJoint, 1u, caps::maxId);
}

template <class Def>
bool Checker::ids(const std::vector<Def>& defs, std::string_view list) {
    std::vector<std::pair<std::uint32_t, std::size_t>> given;
    for (std::size_t i = 0; i < defs.size(); ++i) {
        if (defs[i].id != 0) given.emplace_back(defs[i].id, i);
    }
    std::sort(given.begin(), given.end());
    const auto twice =
        std::adjacent_find(given.begin(), given.end(),
                           [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twice == given.end()) return true;
    const Place root;
    const auto later = twice + 1;
    const Place entry = root.at(list, static_cast<std::int64_t>(later->second));
    return fail(entry.at("id"), text(later->first) + " is also the id of " + std::string(list) +
                                    "[" + text(twice->second) + "]");
}

bool Checker::need(const Place& place, const Scene& scene) {
    const auto fits = [&](std::string_view name, float tolerance) {
        return tolerance == 0.0f ||
               within(place.at(name), tolerance, caps::minTolerance, caps::maxTolerance);
    };
    return fits("penetration", scene.need.penetration) && fits("joint", scene.need.joint);
}

bool Checker::scene(const Scene& scene) {
    const Place root;
    if (scene.name.size() > caps::maxSceneName) {
        return fail(root.at("name"), "is longer than " + text(caps::maxSceneName) + " bytes");
    }
    if (!within(root.at("gravity"), scene.gravity, caps::maxGravity) ||
        !within(root.at("stepSeconds"), scene.stepSeconds, caps::minStepSeconds, 0.1f) ||
        !within(root.at("substeps"), scene.substeps, 0u, 64u) || !need(root.at("need"), scene) ||
        !limits(scene)) {
        return false;
    }
    if (scene.method > lastMethod) return fail(root.at("method"), "is no method");
    const auto tooMany = [&](std::string_view list, std::size_t count, std::uint32_t most) {
        return fail(root.at(list), text(count) + " are more than the " + text(most) +
                                       " of limits." + std::string(list));
    };
    if (scene.bodies.size() > scene.limits.bodies) {
        return tooMany("bodies", scene.bodies.size(), scene.limits.bodies);
    }
    if (scene.joints.size() > scene.limits.joints) {
        return tooMany("joints", scene.joints.size(), scene.limits.joints);
    }
    std::size_t shapeCount = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Place place = root.at("bodies", static_cast<std::int64_t>(i));
        if (!body(place, scene.bodies[i])) return false;
        shapeCount += scene.bodies[i].shapes.size();
        if (shapeCount > scene.limits.shapes) {
            return fail(place.at("shapes"), "with these the scene has more than the " +
                                                text(scene.limits.shapes) + " of limits.shapes");
        }
    }
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const Place place = root.at("joints", static_cast<std::int64_t>(i));
        if (!joint(place, scene.joints[i], scene.bodies.size())) return false;
    }
    return ids(scene.bodies, "bodies") && ids(scene.joints, "joints") &&
           (!scene.players || players(root.at("players"), *scene.players)) &&
           (!scene.rules || rules(root.at("rules"), *scene.rules));
}

bool Checker::rules(const Place& place, const RulesDef& def) {
    if (!isRulesName(def.name)) return fail(place.at("name"), "must be 1 to 32 of a-z, 0-9, _, -");
    if (def.parameters.size() > caps::maxRulesParameters) {
        return fail(place.at("parameters"), "are more than " + text(caps::maxRulesParameters));
    }
    for (std::size_t i = 0; i < def.parameters.size(); ++i) {
        const RulesParameter& parameter = def.parameters[i];
        const Place here = place.at("parameters", static_cast<std::int64_t>(i));
        const bool letters = std::all_of(parameter.name.begin(), parameter.name.end(), [](char c) {
            return (c >= 'A' && c <= 'Z') || isRulesName(std::string_view(&c, 1));
        });
        if (!letters || parameter.name.empty() || parameter.name.size() > caps::maxRulesName) {
            return fail(here.at("name"), "must be 1 to 32 of a-z, A-Z, 0-9, _, -");
        }
        if (i > 0 && parameter.name <= def.parameters[i - 1].name) {
            return fail(here.at("name"), "must come after the one before it, letter by letter");
        }
        if (!finite(here.at("value"), parameter.value)) return false;
    }
    return true;
}

}  // namespace

Status check(const Scene& scene) {
    Checker checker;
    return checker.status(checker.scene(scene));
}

Status check(const BodyDef& body, const std::string& path) {
    Checker checker;
    const Place root{nullptr, path, -1};
    return checker.status(checker.body(root, body));
}

Status check(const JointDef& joint, std::size_t bodyCount, const std::string& path) {
    Checker checker;
    const Place root{nullptr, path, -1};
    return checker.status(checker.joint(root, joint, bodyCount));
}

}  // namespace huestep
