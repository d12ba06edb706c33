#include "core/box2d/engine.h"

#include <box2d/box2d.h>

#include "core/box2d/b2world.h"
#include "core/state/hash.h"

namespace huestep {

namespace {

class Box2dEngine final : public Engine {
 public:
    Box2dEngine(B2World world, float stepSeconds)
        : m_world(std::move(world)), m_stepSeconds(stepSeconds) {}

    void step() override { m_world.world->Step(m_stepSeconds, 8, 3); }

    [[nodiscard]] std::vector<BodyMotion> motions() const override {
        std::vector<BodyMotion> result;
        result.reserve(m_world.bodies.size());
        for (const b2Body* body : m_world.bodies) result.push_back(motionOf(*body));
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

 private:
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
        motion.rest = asleep ? BodyMotion::asleepBit : 0u;
        return motion;
    }

    B2World m_world;
    float m_stepSeconds;
};

}  // namespace

Result<std::unique_ptr<Engine>> makeBox2dEngine(const Scene& scene, const BuildOrder& order,
                                                std::vector<std::string>* notes) {
    Result<B2World> world = makeB2World(scene, order);
    if (!world) return world.error();
    if (notes != nullptr) *notes = world->notes;
    return std::unique_ptr<Engine>(
        std::make_unique<Box2dEngine>(std::move(*world), scene.stepSeconds));
}

}  // namespace huestep
