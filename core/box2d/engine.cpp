#include "core/box2d/engine.h"

#include <box2d/box2d.h>

#include <algorithm>

#include "core/box2d/b2world.h"
#include "core/box2d/by_id.h"
#include "core/box2d/notes.h"
#include "core/math/trig.h"
#include "core/state/hash.h"

namespace huestep {

namespace {

b2Vec2 toB2(Vec2 v) {
    return {v.x, v.y};
}

class Box2dEngine final : public Engine {
 public:
    Box2dEngine(B2World world, const Scene& scene)
        : m_world(std::move(world)),
          m_stepSeconds(scene.stepSeconds),
          m_bodies(sorted(bodyIdsOf(scene)), m_world.bodies, scene.counters.nextBody),
          m_joints(jointIdsOf(scene), m_world.joints, scene.counters.nextJoint) {
        for (const auto& joint : m_joints.entries()) {
            joint.handle->GetUserData().pointer = joint.id;
        }
    }

    Status step(std::span<const Command> commands) override {
        for (const Command& command : commands) {
            const Status applied =
                std::visit([this](const auto& action) { return apply(action); }, command.action);
            if (!applied) return applied;
        }
        m_bodies.tidy();
        m_joints.tidy();
        m_world.world->Step(m_stepSeconds, 8, 3);
        return Done{};
    }

    [[nodiscard]] std::vector<BodyMotion> motions() const override {
        std::vector<BodyMotion> result;
        result.reserve(m_bodies.entries().size());
        for (const auto& body : m_bodies.entries()) result.push_back(motionOf(*body.handle));
        return result;
    }

    [[nodiscard]] std::uint64_t hash() const override {
        const std::vector<BodyMotion> all = motions();
        return hash64Of(std::span<const BodyMotion>(all));
    }

    [[nodiscard]] std::uint32_t contactCount() const override {
        std::uint32_t touching = 0;
        for (const b2Contact* c = m_world.world->GetContactList(); c != nullptr; c = c->GetNext()) {
            if (c->IsTouching()) ++touching;
        }
        return touching;
    }

    [[nodiscard]] std::string_view name() const override { return "box2d"; }
    [[nodiscard]] std::vector<std::string> notes() const override { return m_notes.sentences(); }

 private:
    static std::vector<BodyId> sorted(std::vector<BodyId> ids) {
        std::sort(ids.begin(), ids.end());
        return ids;
    }

    Status apply(const Spawn& action) {
        const Result<B2Spawned> spawned = spawnInB2World(*m_world.world, action, m_notes);
        if (!spawned) return spawned.error();
        for (b2Body* body : spawned->bodies) m_bodies.add(body);
        for (b2Joint* joint : spawned->joints) {
            joint->GetUserData().pointer = m_joints.add(joint);
        }
        return Done{};
    }

    Status apply(const RemoveBody& action) {
        const auto body = m_bodies.find(action.body);
        if (!body) return Done{};
        for (const b2JointEdge* e = (*body)->GetJointList(); e != nullptr; e = e->next) {
            m_joints.remove(static_cast<JointId>(e->joint->GetUserData().pointer));
        }
        m_world.world->DestroyBody(*body);
        m_bodies.remove(action.body);
        return Done{};
    }

    Status apply(const RemoveJoint& action) {
        const auto joint = m_joints.find(action.joint);
        if (!joint) return Done{};
        m_world.world->DestroyJoint(*joint);
        m_joints.remove(action.joint);
        return Done{};
    }

    Status apply(const SetMotor& action) {
        const auto joint = m_joints.find(action.joint);
        if (!joint) return Done{};
        const auto set = [&action](auto& motorised) {
            motorised.EnableMotor(action.enabled);
            motorised.SetMotorSpeed(action.speed);
        };
        if ((*joint)->GetType() == e_revoluteJoint) {
            set(static_cast<b2RevoluteJoint&>(**joint));
        } else if ((*joint)->GetType() == e_prismaticJoint) {
            set(static_cast<b2PrismaticJoint&>(**joint));
        } else {
            m_notes.add(pathOf("joint", action.joint), "its motor cannot be set in Box2D 2.4");
        }
        return Done{};
    }

    Status apply(const SetVelocity& action) {
        const auto body = m_bodies.find(action.body);
        if (!body) return Done{};
        (*body)->SetLinearVelocity(toB2(action.velocity));
        (*body)->SetAngularVelocity(action.angularVelocity);
        return Done{};
    }

    Status apply(const SetTarget& action) {
        const auto body = m_bodies.find(action.body);
        if (!body) return Done{};
        const float perSecond = 1.0f / m_stepSeconds;
        const b2Vec2 way = toB2(action.position) - (*body)->GetPosition();
        const Rotation turn = relative(rotationOf((*body)->GetAngle()), action.rotation);
        (*body)->SetLinearVelocity(perSecond * way);
        (*body)->SetAngularVelocity(perSecond * angleOf(turn));
        return Done{};
    }

    Status apply(const ApplyImpulse& action) {
        const auto body = m_bodies.find(action.body);
        if (body) (*body)->ApplyLinearImpulse(toB2(action.impulse), toB2(action.point), true);
        return Done{};
    }

    Status apply(const ApplyForce& action) {
        const auto body = m_bodies.find(action.body);
        if (body) (*body)->ApplyForce(toB2(action.force), toB2(action.point), true);
        return Done{};
    }

    /// Players and their hands.
    template <class Other>
    Status apply(const Other&) {
        m_notes.add("commands", "players and grabs are left out on box2d");
        return Done{};
    }

    static BodyMotion motionOf(const b2Body& body) {
        const b2Vec2 center = body.GetWorldCenter();
        const b2Rot q = body.GetTransform().q;
        const b2Vec2 velocity = body.GetLinearVelocity();
        const bool asleep = body.GetType() == b2_dynamicBody && !body.IsAwake();
        BodyMotion motion{};
        motion.position = {canonicalZero(center.x), canonicalZero(center.y)};
        motion.rotation = {canonicalZero(q.c), canonicalZero(q.s)};
        motion.velocity = {canonicalZero(velocity.x), canonicalZero(velocity.y)};
        motion.angularVelocity = canonicalZero(body.GetAngularVelocity());
        motion.rest = asleep ? BodyMotion::asleepBit : std::uint16_t{0};
        return motion;
    }

    B2World m_world;
    float m_stepSeconds;
    ById<b2Body*> m_bodies;
    ById<b2Joint*> m_joints;
    Notes m_notes;
};

}  // namespace

Result<std::unique_ptr<Engine>> makeBox2dEngine(const Scene& scene, const BuildOrder& order,
                                                std::vector<std::string>* notes) {
    Result<B2World> world = makeB2World(scene, order);
    if (!world) return world.error();
    if (notes != nullptr) *notes = world->notes;
    return std::unique_ptr<Engine>(std::make_unique<Box2dEngine>(std::move(*world), scene));
}

}  // namespace huestep
