#include "core/box2d/b2world.h"

#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/box2d/notes.h"
#include "core/math/trig.h"
#include "core/world/from_definition.h"

namespace huestep {

B2World::B2World() = default;
B2World::B2World(B2World&&) noexcept = default;
B2World& B2World::operator=(B2World&&) noexcept = default;
B2World::~B2World() = default;

namespace {

b2Vec2 toB2(Vec2 v) {
    return {v.x, v.y};
}

/// splitmix64 (Steele, Lea and Flood 2014): well mixed for any seed.
class Shuffler {
 public:
    explicit Shuffler(std::uint64_t seed) : m_state(seed) {}

    std::uint64_t next() {
        m_state += 0x9e3779b97f4a7c15u;
        std::uint64_t z = m_state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    /// The places 0 to count − 1, in the scene's order for seed 0.
    std::vector<std::size_t> order(std::size_t count, bool shuffled) {
        std::vector<std::size_t> places(count);
        std::iota(places.begin(), places.end(), std::size_t{0});
        for (std::size_t i = count; shuffled && i > 1; --i) {
            std::swap(places[i - 1], places[next() % i]);
        }
        return places;
    }

 private:
    std::uint64_t m_state;
};

/// The exact mass of a body's shapes, for bodies whose shapes Box2D only has in part.
b2MassData massDataOf(const BodyDef& body) {
    const MassProperties whole = massOf(body);
    b2MassData data;
    data.mass = static_cast<float>(whole.mass);
    data.center = {static_cast<float>(whole.center.x), static_cast<float>(whole.center.y)};
    data.I = static_cast<float>(whole.inertia + whole.mass * lengthSquared(whole.center));
    return data;
}

/// What Box2D would make of a body's inertia: it subtracts m·|c|² from the moment about the body's
/// origin, in float, and asserts that something is left.
class InertiaSum {
 public:
    /// Of a body whose mass is said as a whole.
    explicit InertiaSum(const b2MassData& whole)
        : m_mass(whole.mass), m_moment(whole.I), m_weighted(whole.mass * whole.center) {}

    /// Of a body's fixtures and one more, in the order in which Box2D adds them: newest first.
    InertiaSum(const b2MassData& newest, const b2Body& body) {
        add(newest);
        for (const b2Fixture* f = body.GetFixtureList(); f != nullptr; f = f->GetNext()) {
            if (f->GetDensity() == 0.0f) continue;
            b2MassData data;
            f->GetMassData(&data);
            add(data);
        }
    }

    /// Whether more is left about the centre of mass than the rounding of what is subtracted.
    [[nodiscard]] bool survives() const {
        constexpr float rounding = 4.0f * std::numeric_limits<float>::epsilon();
        if (!(m_mass > 0.0f) || !(m_moment > 0.0f)) return true;  // Box2D asks no more of it
        const b2Vec2 center = (1.0f / m_mass) * m_weighted;
        const float shifted = m_mass * b2Dot(center, center);
        return m_moment - shifted > rounding * shifted;
    }

 private:
    void add(const b2MassData& data) {
        m_mass += data.mass;
        m_moment += data.I;
        m_weighted += data.mass * data.center;
    }
    float m_mass = 0.0f;
    float m_moment = 0.0f;
    b2Vec2 m_weighted{0.0f, 0.0f};
};

/// Builds one `b2World`; every `bool` member says whether it succeeded, `m_error` why not.
class Builder {
 public:
    Builder(const Scene& scene, const BuildOrder& order, Notes& notes)
        : m_scene(scene), m_order(order), m_random(order.shuffleSeed), m_notes(notes) {}

    Result<B2World> build();
    Result<B2Spawned> spawn(b2World& world);

 private:
    bool addAll();
    bool addBody(std::size_t place);
    bool addShape(const ShapeDef& shape, const std::string& path, b2Body& body, bool& exact);
    bool addPolygon(const ShapeDef& shape, const std::string& path, b2Body& body, bool& exact);
    bool addCapsule(const ShapeDef& shape, const std::string& path, b2Body& body);
    bool addFixture(const ShapeDef& shape, const b2Shape& b2shape, const std::string& path,
                    b2Body& body);
    bool failOfInertia(const std::string& path) {
        return fail(path,
                    "lies so far from its body's origin for its size that Box2D's arithmetic "
                    "leaves it no inertia");
    }
    void addJoint(std::size_t place);
    b2Joint* addRevolute(const JointDef& joint, const std::string& path);
    b2Joint* addDistance(const JointDef& joint, const std::string& path);
    b2Joint* addMouse(const JointDef& joint);
    b2Joint* addWeld(const JointDef& joint);
    b2Joint* addPrismatic(const JointDef& joint, const std::string& path);
    [[nodiscard]] float referenceAngle(const JointDef& joint) const;
    template <class Def>
    Def jointDef(const JointDef& joint) const;
    void makeNoise();
    bool fail(const std::string& path, const std::string& sentence) {
        m_error = path + ": " + sentence;
        return false;
    }

    const Scene& m_scene;
    BuildOrder m_order;
    Shuffler m_random;
    Notes& m_notes;
    b2World* m_world = nullptr;
    std::string m_error;
    std::vector<b2Body*> m_bodies;   ///< place i: body i in the scene's order
    std::vector<b2Joint*> m_joints;  ///< place i: joint i in the scene's order
    b2Body* m_ground = nullptr;      ///< what mouse joints hold on to; only made for them
};

bool Builder::addAll() {
    m_bodies.assign(m_scene.bodies.size(), nullptr);
    m_joints.assign(m_scene.joints.size(), nullptr);
    const bool shuffled = m_order.shuffleSeed != 0;
    for (const std::size_t place : m_random.order(m_scene.bodies.size(), shuffled)) {
        if (!addBody(place)) return false;
    }
    for (const std::size_t place : m_random.order(m_scene.joints.size(), shuffled)) {
        addJoint(place);
    }
    return true;
}

Result<B2World> Builder::build() {
    B2World result;
    result.world = std::make_unique<b2World>(toB2(m_scene.gravity));
    m_world = result.world.get();
    m_world->SetAllowSleeping(m_scene.sleep);
    if (m_order.noise) makeNoise();
    if (m_scene.rules) m_notes.add("rules", "Box2D 2.4 plays by none");
    if (!addAll()) return Error{m_error};
    const std::vector<BodyId> ids = bodyIdsOf(m_scene);
    std::vector<std::size_t> byId(ids.size());
    std::iota(byId.begin(), byId.end(), std::size_t{0});
    std::sort(byId.begin(), byId.end(),
              [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    for (const std::size_t place : byId) result.bodies.push_back(m_bodies[place]);
    result.joints = std::move(m_joints);
    result.notes = m_notes.sentences();
    return result;
}

Result<B2Spawned> Builder::spawn(b2World& world) {
    m_world = &world;
    if (!addAll()) return Error{"spawned " + m_error};
    return B2Spawned{std::move(m_bodies), std::move(m_joints)};
}

bool Builder::addBody(std::size_t place) {
    const BodyDef& body = m_scene.bodies[place];
    b2BodyDef def;
    def.type = body.type == BodyType::Static      ? b2_staticBody
               : body.type == BodyType::Kinematic ? b2_kinematicBody
                                                  : b2_dynamicBody;
    def.position = toB2(body.position);
    def.angle = angleOf(body.rotation);
    def.linearDamping = body.linearDamping;
    def.angularDamping = body.angularDamping;
    def.gravityScale = body.gravityScale;
    def.allowSleep = body.maySleep;
    def.awake = !body.asleep;
    def.fixedRotation = body.fixedRotation;
    b2Body* created = m_world->CreateBody(&def);
    bool exact = true;
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
        const std::string path = pathOf("bodies", place) + "." + pathOf("shapes", i);
        if (!addShape(body.shapes[i], path, *created, exact)) return false;
    }
    if (!exact && body.type == BodyType::Dynamic) {
        const b2MassData mass = massDataOf(body);
        const bool turns = !body.fixedRotation;
        if (turns && !InertiaSum(mass).survives()) return failOfInertia(pathOf("bodies", place));
        created->SetMassData(&mass);
    }
    // Only now: each fixture moves the centre of mass, whose velocity the scene gives.
    if (body.type != BodyType::Static && !body.asleep) {
        created->SetLinearVelocity(toB2(body.velocity));
        created->SetAngularVelocity(body.angularVelocity);
    }
    m_bodies[place] = created;
    return true;
}

bool Builder::addShape(const ShapeDef& shape, const std::string& path, b2Body& body, bool& exact) {
    const bool wideMask = (shape.filter.mask >> 16) != 0xffffu && (shape.filter.mask >> 16) != 0;
    if (shape.filter.category > 0xffffu || wideMask) {
        return fail(path + ".filter", "Box2D's categories have 16 bits");
    }
    if (shape.filter.group < -32768 || shape.filter.group > 32767) {
        return fail(path + ".filter.group", "Box2D's groups have 16 bits");
    }
    if (shape.material.rollingResistance != 0.0f) {
        m_notes.add(path, "Box2D 2.4 has no rolling resistance");
    }
    if (shape.material.tangentSpeed != 0.0f) {
        m_notes.add(path, "Box2D 2.4 has no tangent speed");
    }
    switch (shape.kind) {
        case ShapeKind::Circle: {
            b2CircleShape circle;
            circle.m_p = toB2(shape.vertices[0]);
            circle.m_radius = shape.radius;
            return addFixture(shape, circle, path, body);
        }
        case ShapeKind::Segment: {
            b2EdgeShape edge;
            edge.SetTwoSided(toB2(shape.vertices[0]), toB2(shape.vertices[1]));
            return addFixture(shape, edge, path, body);
        }
        case ShapeKind::ChainSegment: {
            b2EdgeShape edge;
            edge.SetOneSided(toB2(shape.vertices[0]), toB2(shape.vertices[1]),
                             toB2(shape.vertices[2]), toB2(shape.vertices[3]));
            return addFixture(shape, edge, path, body);
        }
        case ShapeKind::Capsule:
            exact = false;
            return addCapsule(shape, path, body);
        case ShapeKind::Polygon:
            return addPolygon(shape, path, body, exact);
    }
    return true;
}

bool Builder::addPolygon(const ShapeDef& shape, const std::string& path, b2Body& body,
                         bool& exact) {
    const std::size_t count = shape.vertexCount;
    std::array<b2Vec2, maxPolygonVertices> points;
    float area = 0.0f;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 last = shape.vertices[(i + count - 1) % count];
        const Vec2 here = shape.vertices[i];
        const Vec2 next = shape.vertices[(i + 1) % count];
        for (std::size_t j = 0; j < i; ++j) {
            if (length(here - shape.vertices[j]) < 0.5f * b2_linearSlop) {
                return fail(path, "Box2D welds vertices within 2.5 mm of each other");
            }
        }
        area += 0.5f * cross(here - shape.vertices[0], next - shape.vertices[0]);
        // The corner of the two edges moved out by the radius.
        const Vec2 before = normalized(perpRight(here - last));
        const Vec2 after = normalized(perpRight(next - here));
        const float mitre = shape.radius / (1.0f + dot(before, after));
        points[i] = toB2(here + mitre * (before + after));
    }
    if (area < 1e-6f) return fail(path, "Box2D takes no polygon of less than 1e-6 m²");
    if (shape.radius > 0.0f) {
        exact = false;
        m_notes.add(path, "its rounded corners are sharp in Box2D 2.4");
    }
    b2PolygonShape polygon;
    polygon.Set(points.data(), static_cast<int32>(count));
    return addFixture(shape, polygon, path, body);
}

bool Builder::addCapsule(const ShapeDef& shape, const std::string& path, b2Body& body) {
    m_notes.add(path, "a capsule is two circles and a box in Box2D 2.4");
    const Vec2 a = shape.vertices[0];
    const Vec2 b = shape.vertices[1];
    b2CircleShape end;
    end.m_radius = shape.radius;
    for (const Vec2 center : {a, b}) {
        end.m_p = toB2(center);
        if (!addFixture(shape, end, path, body)) return false;
    }
    const float halfLength = 0.5f * length(b - a);
    // A box that Box2D would weld adds nothing to the circles that a person could see.
    if (halfLength < b2_linearSlop || shape.radius < b2_linearSlop) return true;
    const Vec2 along = normalized(b - a);
    b2PolygonShape middle;
    middle.SetAsBox(halfLength, shape.radius, toB2(0.5f * (a + b)),
                    angleOf(Rotation{along.x, along.y}));
    return addFixture(shape, middle, path, body);
}

bool Builder::addFixture(const ShapeDef& shape, const b2Shape& b2shape, const std::string& path,
                         b2Body& body) {
    if (shape.density > 0.0f && body.GetType() == b2_dynamicBody && !body.IsFixedRotation()) {
        b2MassData mass;
        b2shape.ComputeMass(&mass, shape.density);
        if (!InertiaSum(mass, body).survives()) return failOfInertia(path);
    }
    b2FixtureDef def;
    def.shape = &b2shape;
    def.density = shape.density;
    def.friction = shape.material.friction;
    def.restitution = shape.material.restitution;
    def.filter.categoryBits = static_cast<uint16>(shape.filter.category);
    def.filter.maskBits = static_cast<uint16>(shape.filter.mask & 0xffffu);
    def.filter.groupIndex = static_cast<int16>(shape.filter.group);
    body.CreateFixture(&def);
    return true;
}

void Builder::addJoint(std::size_t place) {
    const JointDef& joint = m_scene.joints[place];
    const std::string path = pathOf("joints", place);
    b2Joint*& created = m_joints[place];
    switch (joint.kind) {
        case JointKind::Revolute:
            created = addRevolute(joint, path);
            break;
        case JointKind::Distance:
            created = addDistance(joint, path);
            break;
        case JointKind::Mouse:
            created = addMouse(joint);
            break;
        case JointKind::Weld:
            created = addWeld(joint);
            break;
        case JointKind::Prismatic:
            created = addPrismatic(joint, path);
            break;
    }
}

/// What the joints between two bodies have in common.
template <class Def>
Def Builder::jointDef(const JointDef& joint) const {
    Def def;
    def.bodyA = m_bodies[joint.bodyA];
    def.bodyB = m_bodies[joint.bodyB];
    def.collideConnected = joint.collideConnected;
    def.localAnchorA = toB2(joint.anchorA);
    def.localAnchorB = toB2(joint.anchorB);
    return def;
}

/// Box2D's coordinate is the difference of its angles less this; ours that of the rotations.
float Builder::referenceAngle(const JointDef& joint) const {
    const Rotation between =
        relative(m_scene.bodies[joint.bodyA].rotation, m_scene.bodies[joint.bodyB].rotation);
    return m_bodies[joint.bodyB]->GetAngle() - m_bodies[joint.bodyA]->GetAngle() -
           angleOf(relative(joint.reference, between));
}

b2Joint* Builder::addRevolute(const JointDef& joint, const std::string& path) {
    if (joint.spring.enabled) m_notes.add(path, "Box2D 2.4 has no spring on revolute joints");
    auto def = jointDef<b2RevoluteJointDef>(joint);
    def.referenceAngle = referenceAngle(joint);
    def.enableLimit = joint.limit.enabled;
    def.lowerAngle = joint.limit.lower;
    def.upperAngle = joint.limit.upper;
    def.enableMotor = joint.motor.enabled;
    def.motorSpeed = joint.motor.speed;
    def.maxMotorTorque = joint.motor.maxEffort;
    return m_world->CreateJoint(&def);
}

b2Joint* Builder::addDistance(const JointDef& joint, const std::string& path) {
    if (joint.motor.enabled) m_notes.add(path, "Box2D 2.4 has no motor on distance joints");
    auto def = jointDef<b2DistanceJointDef>(joint);
    def.length = joint.length;
    def.minLength = joint.length;
    def.maxLength = joint.length;
    if (joint.spring.enabled) {
        def.minLength = 0.0f;
        def.maxLength = caps::maxJointLength;
        b2LinearStiffness(def.stiffness, def.damping, joint.spring.hertz, joint.spring.dampingRatio,
                          def.bodyA, def.bodyB);
    }
    if (joint.limit.enabled) {
        def.minLength = joint.limit.lower;
        def.maxLength = joint.limit.upper;
    }
    return m_world->CreateJoint(&def);
}

b2Joint* Builder::addWeld(const JointDef& joint) {
    auto def = jointDef<b2WeldJointDef>(joint);
    def.referenceAngle = referenceAngle(joint);
    if (joint.spring.enabled) {
        b2AngularStiffness(def.stiffness, def.damping, joint.spring.hertz,
                           joint.spring.dampingRatio, def.bodyA, def.bodyB);
    }
    return m_world->CreateJoint(&def);
}

b2Joint* Builder::addPrismatic(const JointDef& joint, const std::string& path) {
    if (joint.spring.enabled) m_notes.add(path, "Box2D 2.4 has no spring on prismatic joints");
    auto def = jointDef<b2PrismaticJointDef>(joint);
    const Rotation axis = normalized(joint.axis);
    def.localAxisA = {axis.c, axis.s};
    def.referenceAngle = referenceAngle(joint);
    def.enableLimit = joint.limit.enabled;
    if (joint.limit.enabled) {
        def.lowerTranslation = joint.limit.lower;
        def.upperTranslation = joint.limit.upper;
    }
    def.enableMotor = joint.motor.enabled;
    def.motorSpeed = joint.motor.speed;
    def.maxMotorForce = joint.motor.maxEffort;
    return m_world->CreateJoint(&def);
}

b2Joint* Builder::addMouse(const JointDef& joint) {
    if (m_ground == nullptr) {
        const b2BodyDef ground;
        m_ground = m_world->CreateBody(&ground);
    }
    b2MouseJointDef def;
    def.bodyA = m_ground;
    def.bodyB = m_bodies[joint.bodyB];
    def.collideConnected = true;
    // Box2D takes the body where the target is when the joint is made.
    def.target = def.bodyB->GetWorldPoint(toB2(joint.anchorB));
    def.maxForce = joint.maxForce;
    b2LinearStiffness(def.stiffness, def.damping, joint.spring.hertz, joint.spring.dampingRatio,
                      def.bodyA, def.bodyB);
    b2MouseJoint* created = static_cast<b2MouseJoint*>(m_world->CreateJoint(&def));
    if (m_scene.bodies[joint.bodyB].asleep) return created;  // a new target would wake the body
    created->SetTarget(toB2(joint.target));
    return created;
}

/// Bodies and joints that come and go before the scene is built. They leave traces where Box2D
/// keeps history: in the free lists of its allocator and of its dynamic tree.
void Builder::makeNoise() {
    Shuffler random(m_order.shuffleSeed + 1);
    b2World& world = *m_world;
    std::vector<b2Body*> bodies;
    for (std::size_t i = 0; i < 48; ++i) {
        b2BodyDef def;
        def.type = i % 3 == 0 ? b2_staticBody : b2_dynamicBody;
        def.position = {static_cast<float>(random.next() % 64) - 32.0f,
                        static_cast<float>(random.next() % 64)};
        b2Body* body = world.CreateBody(&def);
        b2PolygonShape box;
        box.SetAsBox(0.5f + static_cast<float>(i % 5), 0.5f);
        body->CreateFixture(&box, 1.0f);
        if (i % 4 == 3) {
            b2RevoluteJointDef hinge;
            hinge.Initialize(bodies.back(), body, def.position);
            world.CreateJoint(&hinge);
        }
        bodies.push_back(body);
    }
    for (const std::size_t i : random.order(bodies.size(), true)) world.DestroyBody(bodies[i]);
}

}  // namespace

Result<B2World> makeB2World(const Scene& scene, const BuildOrder& order) {
    Notes notes;
    return Builder(scene, order, notes).build();
}

Result<B2Spawned> spawnInB2World(b2World& world, const Spawn& spawn, Notes& notes) {
    Scene part;
    part.bodies = spawn.bodies;
    part.joints = spawn.joints;
    return Builder(part, {}, notes).spawn(world);
}

}  // namespace huestep
