#include "core/box2d/engine3.h"

#include <box2d/box2d.h>

#include <array>
#include <string>

#include "core/box2d/by_id.h"
#include "core/box2d/notes.h"
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

    Status step(std::span<const Command> commands) override;
    [[nodiscard]] std::vector<BodyMotion> motions() const override;
    [[nodiscard]] std::uint64_t hash() const override {
        const std::vector<BodyMotion> all = motions();
        return hash64Of(std::span<const BodyMotion>(all));
    }
    [[nodiscard]] std::uint32_t contactCount() const override;
    [[nodiscard]] std::string_view name() const override { return "box2d3"; }
    [[nodiscard]] std::vector<std::string> notes() const override { return m_notes.sentences(); }

 private:
    /// Bodies and joints of a scene or a spawn, place by place.
    struct Added {
        std::vector<b2BodyId> bodies;
        std::vector<b2JointId> joints;
    };
    Result<Added> add(std::span<const BodyDef> bodies, std::span<const JointDef> joints,
                      const std::string& path);
    Status addBody(const BodyDef& body, const std::string& path, std::vector<b2BodyId>& bodies);
    b2JointId addJoint(const JointDef& joint, std::span<const b2BodyId> bodies);
    Status addShape(const ShapeDef& shape, b2BodyId body, const std::string& path);
    b2JointId addRevolute(const JointDef& joint, const b2JointDef& base);
    b2JointId addDistance(const JointDef& joint, const b2JointDef& base);
    b2JointId addMouse(const JointDef& joint, b2JointDef base);
    b2JointId addWeld(const JointDef& joint, const b2JointDef& base);
    b2JointId addPrismatic(const JointDef& joint, const b2JointDef& base);
    Status apply(const Spawn& action);
    Status apply(const RemoveBody& action);
    Status apply(const RemoveJoint& action);
    Status apply(const SetMotor& action);
    Status apply(const SetVelocity& action);
    Status apply(const SetTarget& action);
    Status apply(const ApplyImpulse& action);
    Status apply(const ApplyForce& action);
    /// Players and their hands.
    template <class Other>
    Status apply(const Other&) {
        m_notes.add("commands", "players and grabs are left out on box2d3");
        return Done{};
    }

    b2WorldId m_world{};
    ById<b2BodyId> m_bodies;
    ById<b2JointId> m_joints;
    float m_stepSeconds;
    Notes m_notes;
};

/// A joint carries its id, so that it is known when it goes with a body.
void writeId(b2JointId joint, JointId id) {
    b2Joint_SetUserData(joint, reinterpret_cast<void*>(static_cast<std::uintptr_t>(id)));
}
JointId idOf(b2JointId joint) {
    return static_cast<JointId>(reinterpret_cast<std::uintptr_t>(b2Joint_GetUserData(joint)));
}

Status Box2d3Engine::build(const Scene& scene) {
    if (scene.rules) m_notes.add("rules", "box2d3 plays by none");
    const Result<Added> added = add(scene.bodies, scene.joints, "");
    if (!added) return added.error();
    m_bodies = ById<b2BodyId>(bodyIdsOf(scene), added->bodies, scene.counters.nextBody);
    m_joints = ById<b2JointId>(jointIdsOf(scene), added->joints, scene.counters.nextJoint);
    for (const auto& joint : m_joints.entries()) writeId(joint.handle, joint.id);
    return Done{};
}

Result<Box2d3Engine::Added> Box2d3Engine::add(std::span<const BodyDef> bodies,
                                              std::span<const JointDef> joints,
                                              const std::string& path) {
    Added added;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Status made = addBody(bodies[i], path + pathOf("bodies", i), added.bodies);
        if (!made) return made.error();
    }
    for (const JointDef& joint : joints) added.joints.push_back(addJoint(joint, added.bodies));
    return added;
}

b2JointId Box2d3Engine::addJoint(const JointDef& joint, std::span<const b2BodyId> bodies) {
    b2JointDef base = b2DefaultRevoluteJointDef().base;
    base.bodyIdA = bodies[joint.bodyA];
    base.bodyIdB = bodies[joint.bodyB];
    base.localFrameA = {toB2(joint.anchorA), b2Rot_identity};
    base.localFrameB = {toB2(joint.anchorB), b2Rot_identity};
    base.collideConnected = joint.collideConnected;
    switch (joint.kind) {
        case JointKind::Revolute:
            return addRevolute(joint, base);
        case JointKind::Distance:
            return addDistance(joint, base);
        case JointKind::Weld:
            return addWeld(joint, base);
        case JointKind::Prismatic:
            return addPrismatic(joint, base);
        case JointKind::Mouse:
            break;
    }
    return addMouse(joint, base);
}

Status Box2d3Engine::addBody(const BodyDef& body, const std::string& path,
                             std::vector<b2BodyId>& bodies) {
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
    bodies.push_back(created);
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
    const std::size_t first = shape.kind == ShapeKind::ChainSegment ? 1 : 0;
    if (length(shape.vertices[first + 1] - shape.vertices[first]) <= 0.005f) {
        return Error{path + ": Box2D 3 takes nothing shorter than 5 mm"};
    }
    if (shape.kind == ShapeKind::ChainSegment) {
        // An open chain of four points is one segment between two ghosts.
        b2ChainDef chain = b2DefaultChainDef();
        chain.points = points.data();
        chain.count = 4;
        chain.materials = &def.material;
        chain.materialCount = 1;
        chain.filter = def.filter;
        b2CreateChain(body, &chain);
        return Done{};
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

b2JointId Box2d3Engine::addRevolute(const JointDef& joint, const b2JointDef& base) {
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
    return b2CreateRevoluteJoint(m_world, &def);
}

b2JointId Box2d3Engine::addDistance(const JointDef& joint, const b2JointDef& base) {
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
    return b2CreateDistanceJoint(m_world, &def);
}

/// Box2D 3 has no mouse joint: a motor joint with a spring to a body of its own does the same.
b2JointId Box2d3Engine::addMouse(const JointDef& joint, b2JointDef base) {
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
    return b2CreateMotorJoint(m_world, &def);
}

Status Box2d3Engine::step(std::span<const Command> commands) {
    for (const Command& command : commands) {
        const Status applied =
            std::visit([this](const auto& action) { return apply(action); }, command.action);
        if (!applied) return applied;
    }
    m_bodies.tidy();
    m_joints.tidy();
    b2World_Step(m_world, m_stepSeconds, substeps);
    return Done{};
}

Status Box2d3Engine::apply(const Spawn& action) {
    const Result<Added> added = add(action.bodies, action.joints, "spawned ");
    if (!added) return added.error();
    for (const b2BodyId body : added->bodies) m_bodies.add(body);
    for (const b2JointId joint : added->joints) writeId(joint, m_joints.add(joint));
    return Done{};
}

Status Box2d3Engine::apply(const RemoveBody& action) {
    const auto body = m_bodies.find(action.body);
    if (!body) return Done{};
    std::vector<b2JointId> joints(static_cast<std::size_t>(b2Body_GetJointCount(*body)));
    b2Body_GetJoints(*body, joints.data(), static_cast<int>(joints.size()));
    for (const b2JointId joint : joints) m_joints.remove(idOf(joint));
    b2DestroyBody(*body);
    m_bodies.remove(action.body);
    return Done{};
}

Status Box2d3Engine::apply(const RemoveJoint& action) {
    const auto joint = m_joints.find(action.joint);
    if (!joint) return Done{};
    b2DestroyJoint(*joint);
    m_joints.remove(action.joint);
    return Done{};
}

Status Box2d3Engine::apply(const SetMotor& action) {
    const auto joint = m_joints.find(action.joint);
    if (!joint) return Done{};
    if (b2Joint_GetType(*joint) == b2_revoluteJoint) {
        b2RevoluteJoint_EnableMotor(*joint, action.enabled);
        b2RevoluteJoint_SetMotorSpeed(*joint, action.speed);
    } else if (b2Joint_GetType(*joint) == b2_distanceJoint) {
        b2DistanceJoint_EnableMotor(*joint, action.enabled);
        b2DistanceJoint_SetMotorSpeed(*joint, action.speed);
    } else if (b2Joint_GetType(*joint) == b2_prismaticJoint) {
        b2PrismaticJoint_EnableMotor(*joint, action.enabled);
        b2PrismaticJoint_SetMotorSpeed(*joint, action.speed);
    } else {
        m_notes.add(pathOf("joint", action.joint), "its motor is not set on box2d3");
    }
    b2Joint_WakeBodies(*joint);
    return Done{};
}

Status Box2d3Engine::apply(const SetVelocity& action) {
    const auto body = m_bodies.find(action.body);
    if (!body) return Done{};
    b2Body_SetLinearVelocity(*body, toB2(action.velocity));
    b2Body_SetAngularVelocity(*body, action.angularVelocity);
    return Done{};
}

Status Box2d3Engine::apply(const SetTarget& action) {
    const auto body = m_bodies.find(action.body);
    if (!body) return Done{};
    const b2WorldTransform target{{action.position.x, action.position.y}, toB2(action.rotation)};
    b2Body_SetTargetTransform(*body, target, m_stepSeconds, true);
    return Done{};
}

Status Box2d3Engine::apply(const ApplyImpulse& action) {
    const auto body = m_bodies.find(action.body);
    if (body) {
        b2Body_ApplyLinearImpulse(*body, toB2(action.impulse), {action.point.x, action.point.y},
                                  true);
    }
    return Done{};
}

Status Box2d3Engine::apply(const ApplyForce& action) {
    const auto body = m_bodies.find(action.body);
    if (body) {
        b2Body_ApplyForce(*body, toB2(action.force), {action.point.x, action.point.y}, true);
    }
    return Done{};
}

b2JointId Box2d3Engine::addWeld(const JointDef& joint, const b2JointDef& base) {
    b2WeldJointDef def = b2DefaultWeldJointDef();
    def.base = base;
    def.base.localFrameA.q = toB2(normalized(joint.reference));
    def.angularHertz = joint.spring.enabled ? joint.spring.hertz : 0.0f;  // 0 is rigid there
    def.angularDampingRatio = joint.spring.dampingRatio;
    return b2CreateWeldJoint(m_world, &def);
}

/// The axis is the x axis of A's frame there; the frames coincide where B stands at the reference.
b2JointId Box2d3Engine::addPrismatic(const JointDef& joint, const b2JointDef& base) {
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
    return b2CreatePrismaticJoint(m_world, &def);
}

std::vector<BodyMotion> Box2d3Engine::motions() const {
    std::vector<BodyMotion> result;
    result.reserve(m_bodies.entries().size());
    for (const auto& entry : m_bodies.entries()) {
        const b2BodyId body = entry.handle;
        const b2Pos center = b2Body_GetWorldCenter(body);
        const b2Rot q = b2Body_GetRotation(body);
        const b2Vec2 velocity = b2Body_GetLinearVelocity(body);
        const bool asleep = b2Body_GetType(body) == b2_dynamicBody && !b2Body_IsAwake(body);
        BodyMotion motion{};
        motion.position = {canonicalZero(center.x), canonicalZero(center.y)};
        motion.rotation = {canonicalZero(q.c), canonicalZero(q.s)};
        motion.velocity = {canonicalZero(velocity.x), canonicalZero(velocity.y)};
        motion.angularVelocity = canonicalZero(b2Body_GetAngularVelocity(body));
        motion.rest = asleep ? BodyMotion::asleepBit : std::uint16_t{0};
        result.push_back(motion);
    }
    return result;
}

std::uint32_t Box2d3Engine::contactCount() const {
    std::uint32_t ends = 0;  // every touching contact is listed by both of its bodies
    std::vector<b2ContactData> contacts;
    for (const auto& entry : m_bodies.entries()) {
        const b2BodyId body = entry.handle;
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
