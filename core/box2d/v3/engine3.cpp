#include "core/box2d/engine3.h"

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "core/state/hash.h"

namespace huestep {

namespace {

const int substeps = 4;

b2Vec2 toB2(Vec2 v) {
    return {v.x, v.y};
}
b2Rot toB2(Rotation q) {
    return {q.c, q.s};
}

class Box2d3Engine final : public Engine {
 public:
    Box2d3Engine(const Scene& scene, int threads) : m_stepSeconds(scene.stepSeconds) {
        b2WorldDef def = b2DefaultWorldDef();
        def.gravity = toB2(scene.gravity);
        def.enableSleep = scene.sleep;
        def.workerCount = threads;
        m_world = b2CreateWorld(&def);
    }
    ~Box2d3Engine() override { b2DestroyWorld(m_world); }
    Box2d3Engine(const Box2d3Engine&) = delete;
    Box2d3Engine& operator=(const Box2d3Engine&) = delete;

    /// Fills the world; a sentence if a shape cannot be carried over.
    Status build(const Scene& scene);

    void step() override { b2World_Step(m_world, m_stepSeconds, substeps); }
    [[nodiscard]] std::vector<BodyMotion> motions() const override;
    [[nodiscard]] std::uint64_t hash() const override {
        const std::vector<BodyMotion> all = motions();
        return hash64Of(std::span<const BodyMotion>(all));
    }
    [[nodiscard]] std::uint32_t contactCount() const override;
    [[nodiscard]] std::string_view name() const override { return "box2d3"; }

 private:
    Status addBody(const BodyDef& body, const std::string& path);
    Status addShape(const ShapeDef& shape, b2BodyId body, const std::string& path);
    void addRevolute(const JointDef& joint, const b2JointDef& base);
    void addDistance(const JointDef& joint, const b2JointDef& base);
    void addMouse(const JointDef& joint, b2JointDef base);
    void addWeld(const JointDef& joint, const b2JointDef& base);
    void addPrismatic(const JointDef& joint, const b2JointDef& base);

    b2WorldId m_world{};
    std::vector<b2BodyId> m_bodies;  ///< place i: body i by ascending id, once built
    float m_stepSeconds;
};

Status Box2d3Engine::build(const Scene& scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const std::string path = std::string("bodies[") + std::to_string(i) + "]";
        if (Status added = addBody(scene.bodies[i], path); !added) return added;
    }
    for (const JointDef& joint : scene.joints) {
        b2JointDef base = b2DefaultRevoluteJointDef().base;
        base.bodyIdA = m_bodies[joint.bodyA];
        base.bodyIdB = m_bodies[joint.bodyB];
        base.localFrameA = {toB2(joint.anchorA), b2Rot_identity};
        base.localFrameB = {toB2(joint.anchorB), b2Rot_identity};
        base.collideConnected = joint.collideConnected;
        switch (joint.kind) {
            case JointKind::Revolute:
                addRevolute(joint, base);
                break;
            case JointKind::Distance:
                addDistance(joint, base);
                break;
            case JointKind::Mouse:
                addMouse(joint, base);
                break;
            case JointKind::Weld:
                addWeld(joint, base);
                break;
            case JointKind::Prismatic:
                addPrismatic(joint, base);
                break;
        }
    }
    const std::vector<BodyId> ids = bodyIdsOf(scene);
    std::vector<std::size_t> byId(ids.size());
    std::iota(byId.begin(), byId.end(), std::size_t{0});
    std::sort(byId.begin(), byId.end(),
              [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    const std::vector<b2BodyId> inSceneOrder = m_bodies;
    for (std::size_t i = 0; i < byId.size(); ++i) m_bodies[i] = inSceneOrder[byId[i]];
    return Done{};
}

Status Box2d3Engine::addBody(const BodyDef& body, const std::string& path) {
    b2BodyDef def = b2DefaultBodyDef();
    def.type = body.type == BodyType::Static      ? b2_staticBody
               : body.type == BodyType::Kinematic ? b2_kinematicBody
                                                  : b2_dynamicBody;
    def.position = toB2(body.position);
    def.rotation = toB2(normalized(body.rotation));
    def.linearDamping = body.linearDamping;
    def.angularDamping = body.angularDamping;
    def.gravityScale = body.gravityScale;
    def.motionLocks.angularZ = body.fixedRotation;
    def.enableSleep = body.maySleep;
    def.isAwake = !body.asleep;
    const b2BodyId created = b2CreateBody(m_world, &def);
    m_bodies.push_back(created);
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
        const std::string shapePath = path + ".shapes[" + std::to_string(i) + "]";
        if (Status added = addShape(body.shapes[i], created, shapePath); !added) return added;
    }
    if (body.type != BodyType::Static && !body.asleep) {
        b2Body_SetLinearVelocity(created, toB2(body.velocity));
        b2Body_SetAngularVelocity(created, body.angularVelocity);
    }
    return Done{};
}

Status Box2d3Engine::addShape(const ShapeDef& shape, b2BodyId body, const std::string& path) {
    b2ShapeDef def = b2DefaultShapeDef();
    def.density = shape.density;
    def.material.friction = shape.material.friction;
    def.material.restitution = shape.material.restitution;
    def.material.rollingResistance = shape.material.rollingResistance;
    def.material.tangentSpeed = -shape.material.tangentSpeed;  // there the belt runs clockwise
    def.filter = {shape.filter.category, shape.filter.mask, shape.filter.group};
    std::array<b2Vec2, maxPolygonVertices> points;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = toB2(shape.vertices[i]);
    if (shape.kind == ShapeKind::Circle) {
        const b2Circle circle{points[0], shape.radius};
        b2CreateCircleShape(body, &def, &circle);
        return Done{};
    }
    if (shape.kind == ShapeKind::Polygon) {
        const b2Hull hull = b2ComputeHull(points.data(), shape.vertexCount);
        if (hull.count != shape.vertexCount) {
            return Error{path + ": Box2D 3 welds vertices that are so near or nearly in line"};
        }
        const b2Polygon polygon = b2MakePolygon(&hull, shape.radius);
        b2CreatePolygonShape(body, &def, &polygon);
        return Done{};
    }
    if (length(shape.vertices[1] - shape.vertices[0]) <= 0.005f) {
        return Error{path + ": Box2D 3 takes nothing shorter than 5 mm"};
    }
    if (shape.kind == ShapeKind::Capsule) {
        const b2Capsule capsule{points[0], points[1], shape.radius};
        b2CreateCapsuleShape(body, &def, &capsule);
        return Done{};
    }
    const b2Segment segment{points[0], points[1]};
    b2CreateSegmentShape(body, &def, &segment);
    return Done{};
}

void Box2d3Engine::addRevolute(const JointDef& joint, const b2JointDef& base) {
    b2RevoluteJointDef def = b2DefaultRevoluteJointDef();
    def.base = base;
    def.base.localFrameA.q = toB2(normalized(joint.reference));
    def.enableSpring = joint.spring.enabled;
    def.hertz = joint.spring.hertz;
    def.dampingRatio = joint.spring.dampingRatio;
    def.enableLimit = joint.limit.enabled;
    def.lowerAngle = joint.limit.lower;
    def.upperAngle = joint.limit.upper;
    def.enableMotor = joint.motor.enabled;
    def.motorSpeed = joint.motor.speed;
    def.maxMotorTorque = joint.motor.maxEffort;
    b2CreateRevoluteJoint(m_world, &def);
}

void Box2d3Engine::addDistance(const JointDef& joint, const b2JointDef& base) {
    b2DistanceJointDef def = b2DefaultDistanceJointDef();
    def.base = base;
    def.length = joint.length;
    // Without a spring Box2D 3 is rigid whatever the limit says; one of 0 Hz pulls at nothing.
    def.enableSpring = joint.spring.enabled || joint.limit.enabled;
    def.hertz = joint.spring.enabled ? joint.spring.hertz : 0.0f;
    def.dampingRatio = joint.spring.dampingRatio;
    def.enableLimit = joint.limit.enabled;
    if (joint.limit.enabled) {
        def.minLength = joint.limit.lower;
        def.maxLength = joint.limit.upper;
    }
    def.enableMotor = joint.motor.enabled;
    def.motorSpeed = joint.motor.speed;
    def.maxMotorForce = joint.motor.maxEffort;
    b2CreateDistanceJoint(m_world, &def);
}

/// Box2D 3 has no mouse joint: a motor joint with a spring to a body of its own does the same.
void Box2d3Engine::addMouse(const JointDef& joint, b2JointDef base) {
    b2BodyDef hand = b2DefaultBodyDef();
    hand.position = toB2(joint.target);
    base.bodyIdA = b2CreateBody(m_world, &hand);
    base.localFrameA = b2Transform_identity;
    base.collideConnected = true;
    b2MotorJointDef def = b2DefaultMotorJointDef();
    def.base = base;
    def.linearHertz = joint.spring.hertz;
    def.linearDampingRatio = joint.spring.dampingRatio;
    def.maxSpringForce = joint.maxForce;
    b2CreateMotorJoint(m_world, &def);
}

void Box2d3Engine::addWeld(const JointDef& joint, const b2JointDef& base) {
    b2WeldJointDef def = b2DefaultWeldJointDef();
    def.base = base;
    def.base.localFrameA.q = toB2(normalized(joint.reference));
    def.angularHertz = joint.spring.enabled ? joint.spring.hertz : 0.0f;  // 0 is rigid there
    def.angularDampingRatio = joint.spring.dampingRatio;
    b2CreateWeldJoint(m_world, &def);
}

/// The axis is the x axis of A's frame there; the frames coincide where B stands at the reference.
void Box2d3Engine::addPrismatic(const JointDef& joint, const b2JointDef& base) {
    b2PrismaticJointDef def = b2DefaultPrismaticJointDef();
    def.base = base;
    const Rotation axis = normalized(joint.axis);
    def.base.localFrameA.q = toB2(axis);
    def.base.localFrameB.q = toB2(relative(normalized(joint.reference), axis));
    def.enableSpring = joint.spring.enabled;
    def.hertz = joint.spring.hertz;
    def.dampingRatio = joint.spring.dampingRatio;
    def.enableLimit = joint.limit.enabled;
    if (joint.limit.enabled) {
        def.lowerTranslation = joint.limit.lower;
        def.upperTranslation = joint.limit.upper;
    }
    def.enableMotor = joint.motor.enabled;
    def.motorSpeed = joint.motor.speed;
    def.maxMotorForce = joint.motor.maxEffort;
    b2CreatePrismaticJoint(m_world, &def);
}

std::vector<BodyMotion> Box2d3Engine::motions() const {
    std::vector<BodyMotion> result;
    result.reserve(m_bodies.size());
    for (const b2BodyId body : m_bodies) {
        const b2Pos center = b2Body_GetWorldCenter(body);
        const b2Rot q = b2Body_GetRotation(body);
        const b2Vec2 velocity = b2Body_GetLinearVelocity(body);
        const bool asleep = b2Body_GetType(body) == b2_dynamicBody && !b2Body_IsAwake(body);
        BodyMotion motion{};
        motion.position = {canonicalZero(center.x), canonicalZero(center.y)};
        motion.rotation = {canonicalZero(q.c), canonicalZero(q.s)};
        motion.velocity = {canonicalZero(velocity.x), canonicalZero(velocity.y)};
        motion.angularVelocity = canonicalZero(b2Body_GetAngularVelocity(body));
        motion.rest = asleep ? BodyMotion::asleepBit : 0u;
        result.push_back(motion);
    }
    return result;
}

std::uint32_t Box2d3Engine::contactCount() const {
    std::uint32_t ends = 0;  // every touching contact is listed by both of its bodies
    std::vector<b2ContactData> contacts;
    for (const b2BodyId body : m_bodies) {
        contacts.resize(static_cast<std::size_t>(b2Body_GetContactCapacity(body)));
        const int count =
            b2Body_GetContactData(body, contacts.data(), static_cast<int>(contacts.size()));
        ends += static_cast<std::uint32_t>(count);
    }
    return ends / 2;
}

}  // namespace

Result<std::unique_ptr<Engine>> makeBox2d3Engine(const Scene& scene, int threads) {
    auto engine = std::make_unique<Box2d3Engine>(scene, threads);
    if (Status built = engine->build(scene); !built) return built.error();
    return std::unique_ptr<Engine>(std::move(engine));
}

}  // namespace huestep
